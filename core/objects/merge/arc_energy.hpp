// SPDX-License-Identifier: LGPL-2.1-or-later
// What an arc of the region graph adds to the energy U (paper, section 2.3 phase 2.2).
#pragma once

#include <cstdint>

namespace rg::objects {

/// In 1/256. U1 counts while both ends of the arc are in one group, the others while they are not.
struct ArcEnergy {
  int64_t motion = 0;      ///< U1: the ends move apart.
  int64_t border = 0;      ///< U2: their border is long.
  int64_t arc = 0;         ///< U3: an arc is broken.
  int64_t prediction = 0;  ///< They were expected to be one object.

  /// What U gains when the ends are in one group.
  [[nodiscard]] constexpr int64_t weight() const { return border + arc + prediction - motion; }
  friend constexpr bool operator==(const ArcEnergy&, const ArcEnergy&) = default;
};

/// The arc between a region and the ground, where the camera moves; kept where the region is
/// background.
struct GroundEnergy {
  int64_t motion = 0;      ///< U1: it moves otherwise; below 0 where the ground's motion explains
                           ///< it better.
  int64_t prediction = 0;  ///< No object was expected there; below 0 where one is known to stand.

  [[nodiscard]] constexpr int64_t weight() const { return prediction - motion; }
  friend constexpr bool operator==(const GroundEnergy&, const GroundEnergy&) = default;
};

}  // namespace rg::objects
