// SPDX-License-Identifier: LGPL-2.1-or-later
// By how much the picture as a whole has moved since the previous frame (part of stage 4): where a
// camera pans, the search for each region starts from there, so that it needn't reach further than
// things move otherwise.
//
// Both frames are looked at as small pictures; the shift is that of the least mean difference of
// what both show, of up to a quarter of the frame. It is only as exact as those are: a hundredth of
// the frame. Determinism: integer sums. Tie-break: smallest (mean, |d|², dy, dx).
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace rg::motion {

/// Means of boxes of `side` x `side` pixels; what is left over at the right and below is not seen.
void shrink(ImageView<const uint8_t> luma, int side, const Executor& executor, Image<uint8_t>& to);

class FrameShift {
 public:
  /// In pixels, from the previous frame to this one. {} where another explains no more than three
  /// quarters as much difference.
  [[nodiscard]] Point find(const std::shared_ptr<const Picture>& current,
                           const std::shared_ptr<const Picture>& previous,
                           const Executor& executor);

 private:
  struct Match {
    uint32_t mean = UINT32_MAX;  ///< In 1/256 grey levels.
    int dx = 0;
  };

  Image<uint8_t> now_, before_;
  std::shared_ptr<const Picture> nowOf_;  ///< Whose small picture now_ is.
  std::vector<Match> best_;               ///< Of each row of shifts.
};

}  // namespace rg::motion
