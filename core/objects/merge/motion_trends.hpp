// SPDX-License-Identifier: LGPL-2.1-or-later
// How regions have moved over the last frames, told apart from how they move in this one.
//
// A region takes over what the previous frame knew of the pixels that it came from, as far as they
// moved as it does now. So a body that walks on becomes ever more certain of its speed, what was
// uncovered does not inherit the speed of what stood before it, and a leg, which stops and swings,
// says little.
//
// Determinism: integer sums over pixels.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/numbers.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace rg::objects {

struct MotionTrend {
  int32_t dx = 0;  ///< In 1/16 px per frame.
  int32_t dy = 0;
  int32_t weight = 0;  ///< Of the frames that it rests on; a frame that tells all has kFrameWeight.
};

inline constexpr int32_t kFrameWeight = 256;

struct MotionTrends {
  std::shared_ptr<const segmentation::Labels> labels;  ///< That `ofRegion` is of.
  std::vector<MotionTrend> ofRegion;
  std::vector<MotionTrend> before;  ///< Scratch.

  void reset() { labels.reset(); }
};

/// Goes on to the next frame and tells its trends as a motion: the vectors are trends, and their
/// reliability is half of kFullReliability after one frame that told all.
void followTrends(const motion::Motion& motion, const Executor& executor, MotionTrends& memory,
                  motion::Motion& trends, const Numbers::Layers& numbers = {});

}  // namespace rg::objects
