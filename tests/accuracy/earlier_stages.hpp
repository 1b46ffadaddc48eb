// SPDX-License-Identifier: LGPL-2.1-or-later
// The four stages before the objects, with default parameters, from frames to the motion of
// regions.
#pragma once

#include "core/background/background.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/reduced_frame.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/result_packer.hpp"
#include "tests/benchmarks/scene.hpp"
#include "tests/support/value_of.hpp"

#include <cmath>
#include <cstdint>
#include <memory>

namespace rg::truth {

class EarlierStages {
 public:
  /// Without a background where the camera moves.
  EarlierStages(const Context& context, bool isMoving, double fps)
      : context_(context),
        fps_(fps),
        background_(isMoving ? nullptr : background::makeStage(context)),
        segmentation_(segmentation::makeStage(context)),
        graph_(graph::makeStage(context)),
        motion_(motion::makeStage(context)) {}

  [[nodiscard]] std::shared_ptr<const motion::Motion> process(const bench::RawFrame& raw) {
    time_ = {std::llround(1e9 * static_cast<double>(frames_++) / fps_), true};
    const auto picture = pictures_.take();
    frame_ = raw.layout.size;
    const bool isDoubled = usualSize(frame_) != frame_;
    (isDoubled ? small_ : *picture).load(raw.view(), *context_.cpu);
    if (isDoubled) picture->loadDoubled(small_, *context_.cpu);
    std::shared_ptr<const background::Foreground> foreground;
    segmentation::Params segmentation;
    if (background_) {
      foreground = valueOf(background_->process(picture, {}, time_));
      segmentation.scope = segmentation::Scope::Foreground;
    }
    const auto labels = valueOf(segmentation_->process(picture, foreground, segmentation));
    const auto graph = valueOf(graph_->process(labels, {}));
    return valueOf(motion_->process(graph, {}, time_));
  }
  /// What was found in the last frame, in pixels of the frame.
  [[nodiscard]] std::shared_ptr<const objects::Objects> shown(
      std::shared_ptr<const objects::Objects> found) {
    if (found->size == frame_) return found;
    packer_.endFrame();
    packer_.showIn(frame_);
    return packer_.pack(found);
  }
  /// Of the last frame.
  [[nodiscard]] FrameTime time() const { return time_; }

 private:
  Context context_;
  double fps_;
  Size frame_;
  Picture small_;  ///< That is to be doubled.
  Pool<Picture> pictures_;
  std::unique_ptr<background::Stage> background_;
  std::unique_ptr<segmentation::Stage> segmentation_;
  std::unique_ptr<graph::Stage> graph_;
  std::unique_ptr<motion::Stage> motion_;
  int64_t frames_ = 0;
  FrameTime time_;
  objects::ResultPacker packer_;
};

}  // namespace rg::truth
