// SPDX-License-Identifier: LGPL-2.1-or-later
// Parallax: how far what stands still slides beyond the plane that the camera's motion is of, as
// the camera travels past it (part of stage 5).
//
// What stands before that plane moves as the plane does there, but further, by as much as it is
// nearer (R. Hartley and A. Zisserman, Multiple View Geometry, section 13.3, for a camera that
// travels more than it turns). A thing that moves against the camera looks the same. But parallax
// is of many things, and a thing that moves by itself is one connected piece: motions count as
// parallax while a share of the picture beyond the heaviest such piece goes along with the plane.
//
// Determinism: integers.
#pragma once

#include "core/base/geometry.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/numbers.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

class Parallax {
 public:
  /// Whether the camera travels past anything. motion: its camera is that of the plane. stepNs:
  /// since the previous frame. isKnown: of each region, whether it is of a thing that has been
  /// followed, which says nothing then; may be empty.
  void look(const motion::Motion& motion, std::span<const uint8_t> isKnown, int64_t stepNs,
            const Numbers::Parallax& numbers);
  /// No frame is like those before.
  void reset() { seen_ = 0; }
  /// Whether what moves so beyond the plane stands still before it. plane: by how much the plane
  /// moves there; both in 1/16 px.
  [[nodiscard]] bool explains(Point beyond, Point plane) const;

 private:
  [[nodiscard]] bool goesAlong(Point beyond, Point plane) const;

  Numbers::Parallax numbers_;
  int64_t seen_ = 0;               ///< Share of what can be relied on, in 1/2^16, over time.
  std::vector<uint8_t> slides_;    ///< Of each region,
  std::vector<uint32_t> pieceOf_;  ///< and of which piece it is.
  std::vector<int64_t> pieceWeight_;
};

}  // namespace rg::objects
