// SPDX-License-Identifier: LGPL-2.1-or-later
// What the stage does with pixels, step by step: by the functions of this room, or by a device's
// counterparts of them. Which of the two did a step can't be seen in its result.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/picture.hpp"
#include "core/graph/graph.hpp"
#include "core/motion/literal_search.hpp"
#include "core/motion/matched_blocks.hpp"
#include "core/motion/motion.hpp"
#include "core/motion/padded_luma.hpp"
#include "core/motion/refinement/motion_refinement.hpp"
#include "core/motion/shift_search.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::motion {

/// Where regions are, and where they were.
struct MatchedFrames {
  const Picture& current;
  const Picture& previous;
  const MatchedBlocks& blocks;
  int maxShiftPx;
};

/// What is found of each region; those without matched blocks stay as they are.
struct WholeShifts {
  std::span<RegionMotion> motion;
  std::span<uint8_t> isStill;  ///< None of its matched pixels has changed.
  /// What has been found of them elsewhere, if they have been looked for: regions that do not match
  /// better stay as they are, too.
  std::span<const RegionMotion> elsewhere{};

  void take(size_t region, const RegionMotion& found) const {
    if (elsewhere.empty() || isBetter(found, elsewhere[region])) motion[region] = found;
  }

 private:
  [[nodiscard]] static constexpr bool isBetter(const RegionMotion& a, const RegionMotion& b) {
    return a.sad != b.sad ? a.sad < b.sad : a.reliability > 0;
  }
};

/// Each does what the function of its name does; this class does it on the CPU.
class Operations {
 public:
  explicit Operations(const Executor& executor) : executor_(executor) {}
  virtual ~Operations() = default;
  Operations(const Operations&) = delete;
  Operations& operator=(const Operations&) = delete;

  /// isUnchanged(), searchShifts() and estimateMotion() of each region that has matched blocks.
  virtual void searchShifts(const MatchedFrames& frames, const WholeShifts& out);
  /// matchAllPixels() of each region of the graph, for shifts of up to maxShiftPx.
  virtual void matchAllPixels(const graph::Graph& graph, const Picture& previous, int maxShiftPx,
                              std::span<RegionMotion> motion);
  /// MotionRefinement::run(), after searchShifts() in the same frames.
  virtual void refine(const graph::Graph& graph, const MatchedFrames& frames,
                      std::span<RegionMotion> motion);

 protected:
  [[nodiscard]] const Executor& executor() const { return executor_; }
  /// For refine(), where the CPU has not searched shifts. A ring of shifts beyond is seen, too.
  void padLuma(const MatchedFrames& frames) {
    searched_.luma.build(frames.previous.luma(), frames.maxShiftPx + 1, executor_);
  }

 private:
  const Executor& executor_;
  SearchedPicture searched_;
  MotionRefinement refinement_;
  std::vector<SearchScratch> scratch_;
  PaddedLuma literalLuma_;
  std::vector<LiteralScratch> literalScratch_;
};

}  // namespace rg::motion
