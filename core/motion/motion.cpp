// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/motion.hpp"

#include "core/base/camera/camera_search.hpp"
#include "core/base/memory/operations_source.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/renewed_stage.hpp"
#include "core/base/time/time.hpp"
#include "core/motion/camera/camera_view.hpp"
#include "core/motion/matched_blocks.hpp"
#include "core/motion/operations.hpp"

#include <algorithm>
#include <utility>

namespace rg::motion {
namespace {

constexpr int kLeastUsualShift = 20;  // px, of what is searched where nothing is asked for: at a
                                      // high rate sampling and shake still move by pixels.
constexpr int kMostShift = kMostReach - 1;

constexpr int64_t stepBetween(FrameTime earlier, FrameTime later) {
  const int64_t step = timeBetween(earlier.ns, later.ns);
  return earlier.isKnown && later.isKnown && step > 0 ? step : kNominalStepNs;
}

constexpr int furthestShift(const Params& params, Size size, int64_t stepNs) {
  if (params.maxShiftPx > 0) return std::min(params.maxShiftPx, kMostShift);
  // Of which the cost grows with the square of it.
  if (params.method == Method::Literal) return kLeastUsualShift;
  constexpr int64_t kSecondNs = 1'000'000'000;
  const int64_t inStep = size.height * std::min(stepNs, kSecondNs) / kSecondNs;
  return static_cast<int>(std::clamp<int64_t>(inStep, kLeastUsualShift, kMostShift));
}

class MotionStage final : public Stage {
 public:
  explicit MotionStage(Context context)
      : context_(std::move(context)), operations_(makeOperations<Operations>(context_)) {}

  Result<std::shared_ptr<const Motion>> process(std::shared_ptr<const graph::Graph> graph,
                                                const Params& params, FrameTime time) override;
  void reset(Reset) override {
    previous_.reset();
    camera_.reset();
  }

 private:
  [[nodiscard]] CameraMotion cameraOf(const graph::Graph& graph);
  void match(const graph::Graph& graph, const Params& params, Motion& motion);
  void search(const graph::Graph& graph, const Picture& before, const Params& params,
              const WholeShifts& out);
  void searchBeyondCamera(const graph::Graph& graph, const Params& params, Motion& motion);
  void matchLiterally(const graph::Graph& graph, int maxShift, Motion& motion);

  Context context_;
  std::unique_ptr<Operations> operations_;
  std::shared_ptr<const Picture> previous_;
  FrameTime previousTime_;
  MatchedBlocks blocks_;
  std::vector<uint8_t> isStill_;  ///< By region: none of its matched pixels has changed.
  CameraSearch camera_;
  CameraView view_;
  std::vector<RegionMotion> inFrame_;  ///< Of each region, as if the camera stood still.
  Pool<Motion> pool_;
};

Result<std::shared_ptr<const Motion>> MotionStage::process(
    std::shared_ptr<const graph::Graph> graph, const Params& params, FrameTime time) {
  const auto motion = pool_.take();
  motion->size = graph->size;
  motion->status = Status::Skipped;
  motion->regions.assign(graph->regions.size(), {});
  motion->matchedBlocks = motion->stillBlocks = 0;
  motion->camera = {};
  if (graph->status != Status::Skipped) {
    std::shared_ptr<const Picture> picture = graph->picture;
    if (previous_ && previous_->size() == picture->size()) {
      Params inForce = params;
      inForce.maxShiftPx = furthestShift(params, picture->size(), stepBetween(previousTime_, time));
      match(*graph, inForce, *motion);
      motion->status = graph->status;
    }
    previous_ = std::move(picture);
    previousTime_ = time;
  }
  motion->graph = std::move(graph);
  return std::shared_ptr<const Motion>(motion);
}

/// As bgremove has found it, where it has looked.
CameraMotion MotionStage::cameraOf(const graph::Graph& graph) {
  const background::Foreground* found = graph.labels->foreground.get();
  const bool isKnown = found && found->cameraSince == previous_ && found->picture == graph.picture;
  if (!isKnown) return camera_.find(graph.picture, previous_, *context_.cpu);
  camera_.reset();
  return found->camera;
}

void MotionStage::match(const graph::Graph& graph, const Params& params, Motion& motion) {
  if (graph.labels->scope == segmentation::Scope::Frame) motion.camera = cameraOf(graph);
  if (params.method == Method::Literal) return matchLiterally(graph, params.maxShiftPx, motion);
  blocks_.find(graph, *context_.cpu);
  if (blocks_.parts().empty()) return;
  isStill_.assign(motion.regions.size(), 0);
  // What moves so far that a thing which the camera follows may still be found is searched as it
  // was: without a trace of interpolation.
  if (2 * furthestMotion(motion.camera, motion.size) <= params.maxShiftPx * kMotionUnit)
    search(graph, *previous_, params, {motion.regions, isStill_});
  else
    searchBeyondCamera(graph, params, motion);
  for (const MatchedPart& part : blocks_.parts()) {
    motion.matchedBlocks += part.pixels() / kBlockWidth;
    if (isStill_[part.label.index()] != 0) motion.stillBlocks += part.pixels() / kBlockWidth;
  }
}

void MotionStage::search(const graph::Graph& graph, const Picture& before, const Params& params,
                         const WholeShifts& out) {
  const MatchedFrames frames{*graph.picture, before, blocks_, params.maxShiftPx};
  operations_->searchShifts(frames, out);
  if (params.isSubpixel) operations_->refine(graph, frames, out.motion);
}

/// In the previous frame as a fast camera makes it look now, and as it was, where what the camera
/// follows is found: that is what matches better there.
void MotionStage::searchBeyondCamera(const graph::Graph& graph, const Params& params,
                                     Motion& motion) {
  view_.show(previous_->luma(), motion.camera, *context_.cpu);
  search(graph, view_.picture(), params, {motion.regions, isStill_});
  view_.addCamera(graph, blocks_, motion.regions);
  inFrame_.assign(motion.regions.size(), {.sad = kNotMatched});
  search(graph, *previous_, params, {inFrame_, isStill_, motion.regions});
  for (size_t i = 0; i < inFrame_.size(); ++i)
    if (inFrame_[i].sad != kNotMatched) motion.regions[i] = inFrame_[i];
}

void MotionStage::matchLiterally(const graph::Graph& graph, int maxShift, Motion& motion) {
  operations_->matchAllPixels(graph, *previous_, maxShift, motion.regions);
  for (const graph::Region& region : graph.regions)
    motion.matchedBlocks += region.areaPx / kBlockWidth;
}

}  // namespace

std::unique_ptr<Stage> makeStage(Context context) {
  return std::make_unique<RenewedStage<Stage, MotionStage>>(std::move(context));
}

}  // namespace rg::motion
