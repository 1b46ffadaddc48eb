// SPDX-License-Identifier: LGPL-2.1-or-later
// Evidence that things move otherwise than a moving camera adds up from frame to frame (part of
// stage 5; U1 of the arcs between regions and the ground, core/objects/merge/mrf_merge.hpp).
//
// One frame says little: a limb pauses, a wall looks alike a step further, a match is wrong. What
// own_motion found is kept on a grid of samples, and goes along with what it was found of: a sample
// takes over what lay where its region came from, if the previous frame shows the same there. What
// a thing uncovers was not to be seen before, so that it has nothing to take over. Evidence fades
// with time, and is taken back where pixels follow the ground; it never speaks for the ground.
//
// Determinism: integers, each sample for itself.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/merge/own_motion.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

class MotionEvidence {
 public:
  /// What was known is carried to this frame's regions. previous: the luma that `motion` was
  /// measured against, stepNs before; none where nothing can be carried.
  void carry(const motion::Motion& motion, ImageView<const uint8_t> previous, int64_t stepNs,
             const Executor& executor);
  /// No frame is like those before.
  void reset();
  /// What a region's pixels have shown in earlier frames, as OwnMotion's gain.
  [[nodiscard]] int64_t gainOf(size_t region) const { return carried_[region]; }
  /// And what they show in this one is added. own: one entry per region.
  void add(const motion::Motion& motion, std::span<const OwnMotion> own, const Executor& executor);

 private:
  Size frame_;
  Image<int16_t> now_, before_;    ///< Gain of a pixel, by samples.
  bool hasAny_ = false;            ///< Not all of now_ is 0.
  std::vector<int64_t> carried_;   ///< Of each region.
  std::vector<int64_t> sums_;      ///< Of each region's samples,
  std::vector<uint32_t> samples_;  ///< and how many there are.
  std::vector<int16_t> density_;   ///< Of each region in this frame.
};

}  // namespace rg::objects
