// SPDX-License-Identifier: LGPL-2.1-or-later
// Times of the five core stages, without GStreamer, on the whole frame as in the paper's table.
#include "core/background.hpp"
#include "core/objects.hpp"
#include "core/pool.hpp"
#include "core/region_graph.hpp"
#include "core/region_motion.hpp"
#include "core/segmentation.hpp"
#include "tests/benchmarks/scene.hpp"
#include "tests/benchmarks/timing.hpp"

#include <cstdlib>
#include <iostream>

namespace rg::bench {
namespace {

constexpr char kBackgroundRow[] = "bgremove";

template <class T>
T valueOf(Result<T> result) {
  if (result) return *std::move(result);
  std::cerr << "bench: " << result.error().message << '\n';
  std::exit(1);
}

class Pipeline {
 public:
  explicit Pipeline(const Options& options)
      : context_{std::make_shared<Executor>(options.threads), {}} {
    background_ = makeBackgroundStage(context_);
    segmentation_ = makeSegmentationStage(context_);
    graph_ = makeGraphStage(context_);
    motion_ = makeMotionStage(context_);
    objects_ = makeObjectStage(context_);
    segmentationParams_.maxRegions = options.regions;
    motionParams_.maxShiftPx = options.shiftPx;
  }

  void process(const RawFrame& raw, Timings& timings) {
    const Frame frame = raw.view();
    const auto picture = pictures_.take();
    const FrameTime time{frames_++ * 40'000'000, true};
    timings.measure("load", [&] { picture->load(frame, *context_.cpu); });
    timings.measure(kBackgroundRow, [&] {
      return valueOf(background_->process(picture, BackgroundParams{}, time));
    });
    const auto labels = timings.measure("hsvsegment", [&] {
      return valueOf(segmentation_->process(picture, nullptr, segmentationParams_));
    });
    const auto graph =
        timings.measure("srg", [&] { return valueOf(graph_->process(labels, GraphParams{})); });
    const auto motion = timings.measure(
        "prmmotion", [&] { return valueOf(motion_->process(graph, motionParams_)); });
    const auto objects = timings.measure(
        "mrfmerge", [&] { return valueOf(objects_->process(motion, ObjectParams{}, time)); });
    regions_ = graph->regions.size();
    groups_ = objects->objects.size();
  }

  [[nodiscard]] int threads() const { return context_.cpu->threads(); }
  [[nodiscard]] size_t regions() const { return regions_; }
  [[nodiscard]] size_t objects() const { return groups_; }

 private:
  Context context_;
  Pool<Picture> pictures_;
  std::unique_ptr<BackgroundStage> background_;
  std::unique_ptr<SegmentationStage> segmentation_;
  std::unique_ptr<GraphStage> graph_;
  std::unique_ptr<MotionStage> motion_;
  std::unique_ptr<ObjectStage> objects_;
  SegmentationParams segmentationParams_;
  MotionParams motionParams_;
  int64_t frames_ = 0;
  size_t regions_ = 0;
  size_t groups_ = 0;
};

int run(const Options& options) {
  const auto source = valueOf(openSource(options));
  Pipeline pipeline(options);
  Timings timings;
  RawFrame frame;
  for (int i = 0; i < kWarmUpFrames + options.frames; ++i) {
    valueOf(source->next(frame));
    if (i == kWarmUpFrames) timings.clear();
    pipeline.process(frame, timings);
  }
  std::printf("%dx%d, threads %d, frames %d; in the last one %zu regions, %zu objects\n",
              frame.layout.size.width, frame.layout.size.height, pipeline.threads(), options.frames,
              pipeline.regions(), pipeline.objects());
  timings.printRows();
  std::printf("total_ms=%.3f\npipeline_ms=%.3f\n", timings.total(kBackgroundRow), timings.total());
  return 0;
}

}  // namespace
}  // namespace rg::bench

int main(int argc, char** argv) {
  const auto options = rg::bench::parseOptions({argv + 1, argv + argc});
  if (!options) {
    std::cerr << "bench: " << options.error().message << '\n' << rg::bench::usage("bench");
    return 2;
  }
  if (options->asksHelp) {
    std::cout << rg::bench::usage("bench");
    return 0;
  }
  return rg::bench::run(*options);
}
