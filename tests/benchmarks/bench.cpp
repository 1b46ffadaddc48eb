// SPDX-License-Identifier: LGPL-2.1-or-later
// Times of the five core stages, without GStreamer; on the whole frame as in the paper's figures,
// unless the scope is the foreground.
#include "core/background/background.hpp"
#include "core/base/memory/pool.hpp"
#include "core/graph/graph.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/objects.hpp"
#include "core/segmentation/segmentation.hpp"
#include "kernels/backend/open_device.hpp"
#include "tests/benchmarks/scene.hpp"
#include "tests/benchmarks/timing.hpp"
#include "tests/support/value_of.hpp"

#include <thread>

namespace rg::bench {
namespace {

constexpr char kLoadRow[] = "load", kBackgroundRow[] = "bgremove";
const std::vector<std::string> kStages = {"hsvsegment", "srg", "prmmotion", "mrfmerge"};
// The paper's milliseconds for 640x480 and 160 regions.
constexpr double kPaperCpuMs = 1460, kPaperGpuMs = 22.81;

/// Where the stages of a pipeline run: a device serves one stage, and those of one pipeline share
/// its memory.
class Contexts {
 public:
  explicit Contexts(const Options& options)
      : cpu_(std::make_shared<Executor>(options.threads)),
        usesDevice_(options.backend == "cuda"),
        device_(options.device) {}

  Context next() {
    if (!usesDevice_) return {cpu_, {}};
    last_ = valueOf(gpu::openDevice(device_, last_));
    return {cpu_, last_};
  }
  /// What is said of a device that they run on.
  [[nodiscard]] std::string name() const { return last_ ? ", on " + last_->name() : ""; }
  [[nodiscard]] const Executor& cpu() const { return *cpu_; }

 private:
  std::shared_ptr<const Executor> cpu_;
  bool usesDevice_;
  int device_;
  std::shared_ptr<Device> last_;
};

class Pipeline {
 public:
  explicit Pipeline(const Options& options) : contexts_(options) {
    background_ = background::makeStage(contexts_.next());
    segmentation_ = segmentation::makeStage(contexts_.next());
    graph_ = graph::makeStage(contexts_.next());
    motion_ = motion::makeStage(contexts_.next());
    objects_ = objects::makeStage(contexts_.next());
    segmentationParams_.scope = options.scope;
    segmentationParams_.maxRegions = options.regions;
    segmentationParams_.minAreaPx = options.minAreaPx;
    segmentationParams_.similarity = options.similarity;
    graphParams_.connectivity = static_cast<Connectivity>(options.connectivity);
    motionParams_.maxShiftPx = options.shiftPx;
    if (!options.isLiteral) return;
    backgroundParams_.method = background::Method::Paper;
    segmentationParams_.space = segmentation::ColourSpace::Hsv;
    motionParams_.method = motion::Method::Literal;
    objectParams_.method = objects::Method::Literal;
  }

  void process(const RawFrame& raw, Timings& timings) {
    const Frame frame = raw.view();
    const auto picture = pictures_.take();
    const FrameTime time{frames_++ * 40'000'000, true};
    timings.measure(kLoadRow, [&] { picture->load(frame, contexts_.cpu()); });
    auto foreground = timings.measure(kBackgroundRow, [&] {
      return valueOf(background_->process(picture, backgroundParams_, time));
    });
    if (segmentationParams_.scope == segmentation::Scope::Frame) foreground.reset();
    const auto labels = timings.measure(kStages[0], [&] {
      return valueOf(segmentation_->process(picture, foreground, segmentationParams_));
    });
    const auto graph =
        timings.measure(kStages[1], [&] { return valueOf(graph_->process(labels, graphParams_)); });
    const auto motion = timings.measure(
        kStages[2], [&] { return valueOf(motion_->process(graph, motionParams_, {})); });
    const auto objects = timings.measure(
        kStages[3], [&] { return valueOf(objects_->process(motion, objectParams_, time)); });
    note(*motion, *objects);
  }

  /// Forgets what was noted so far.
  void clear() { notes_ = {}; }
  struct Notes {
    size_t fewestRegions = SIZE_MAX, mostRegions = 0, objects = 0;
    uint64_t matchedBlocks = 0, stillBlocks = 0;
  };
  [[nodiscard]] const Notes& notes() const { return notes_; }

  [[nodiscard]] int threads() const { return contexts_.cpu().threads(); }
  [[nodiscard]] std::string backend() const { return contexts_.name(); }

 private:
  void note(const motion::Motion& motion, const objects::Objects& objects) {
    notes_.fewestRegions = std::min(notes_.fewestRegions, motion.regions.size());
    notes_.mostRegions = std::max(notes_.mostRegions, motion.regions.size());
    notes_.objects = objects.objects.size();
    notes_.matchedBlocks += motion.matchedBlocks;
    notes_.stillBlocks += motion.stillBlocks;
  }

  Contexts contexts_;
  Pool<Picture> pictures_;
  std::unique_ptr<background::Stage> background_;
  std::unique_ptr<segmentation::Stage> segmentation_;
  std::unique_ptr<graph::Stage> graph_;
  std::unique_ptr<motion::Stage> motion_;
  std::unique_ptr<objects::Stage> objects_;
  background::Params backgroundParams_;
  segmentation::Params segmentationParams_;
  graph::Params graphParams_;
  motion::Params motionParams_;
  objects::Params objectParams_;
  int64_t frames_ = 0;
  Notes notes_;
};

struct Measured {
  std::string scene;
  Size size;
  int threads = 0;
  std::string backend;
  Pipeline::Notes notes;
  Timings timings;

  [[nodiscard]] double total() const { return timings.total({kLoadRow, kBackgroundRow}); }
};

Measured measure(const Options& options, Clock clock = Clock::Wall) {
  const auto source = valueOf(openSource(options));
  Pipeline pipeline(options);
  Measured measured{source->describe(), {}, pipeline.threads(),
                    pipeline.backend(), {}, Timings(clock)};
  RawFrame frame;
  for (int i = 0; i < options.warmUp + options.frames; ++i) {
    valueOf(source->next(frame));
    if (i == options.warmUp) measured.timings.clear();
    if (i == options.warmUp) pipeline.clear();
    pipeline.process(frame, measured.timings);
  }
  measured.size = frame.layout.size;
  measured.notes = pipeline.notes();
  return measured;
}

int runOnce(const Options& options) {
  const Measured measured = measure(options, options.asksCpu ? Clock::Cpu : Clock::Wall);
  const Pipeline::Notes& notes = measured.notes;
  std::printf("%dx%d, threads %d, frames %d, %s%s\n", measured.size.width, measured.size.height,
              measured.threads, options.frames, measured.scene.c_str(), measured.backend.c_str());
  std::printf("%zu to %zu regions in a frame, %zu objects in the last one\n", notes.fewestRegions,
              notes.mostRegions, notes.objects);
  std::printf("%.2f %% of the cells took the shortcut for what stands still\n",
              100.0 * static_cast<double>(notes.stillBlocks) /
                  static_cast<double>(std::max<uint64_t>(notes.matchedBlocks, 1)));
  measured.timings.printRows();
  std::printf("total_ms=%.3f\npipeline_ms=%.3f\n", measured.total(), measured.timings.total());
  std::printf(
      "(total: the last four; 640x480 with 160 regions took the paper %.0f ms on a CPU, "
      "%.2f ms on a GPU)\n",
      kPaperCpuMs, kPaperGpuMs);
  return 0;
}

/// Pipelines that all get the same frames, as fast as they take them.
int runStreams(Options options) {
  options.threads = 1;
  const auto source = valueOf(openSource(options));
  std::vector<RawFrame> frames(static_cast<size_t>(options.warmUp + options.frames));
  for (RawFrame& frame : frames) valueOf(source->next(frame));
  std::vector<std::unique_ptr<Pipeline>> pipelines;
  for (int i = 0; i < options.streams; ++i)
    pipelines.push_back(std::make_unique<Pipeline>(options));
  const auto showAll = [&](std::span<const RawFrame> shown) {
    std::vector<std::thread> threads;
    for (const auto& pipeline : pipelines)
      threads.emplace_back([&pipeline = *pipeline, shown] {
        Timings timings;
        for (const RawFrame& frame : shown) pipeline.process(frame, timings);
      });
    for (std::thread& thread : threads) thread.join();
  };
  const auto warmUp = static_cast<size_t>(options.warmUp);
  showAll(std::span(frames).first(warmUp));
  const double startMs = nowMs(Clock::Wall);
  showAll(std::span(frames).subspan(warmUp));
  const double seconds = (nowMs(Clock::Wall) - startMs) / 1000;
  const double perSecond = options.streams * options.frames / seconds;
  const Size size = frames.front().layout.size;
  std::printf("%dx%d, streams %d, frames %d each, %s%s\n", size.width, size.height, options.streams,
              options.frames, source->describe().c_str(), pipelines.front()->backend().c_str());
  std::printf("frames_per_s=%.1f\nstreams_of_30=%.1f\n", perSecond, perSecond / 30);
  return 0;
}

void printLine(const Measured& measured, const Options& options) {
  std::printf("%5dx%-5d %7d", options.size.width, options.size.height, options.regions);
  for (const std::string& stage : kStages) std::printf(" %10.3f", measured.timings.of(stage));
  std::printf(" %10.3f %8.1f", measured.total(), 1000 / measured.total());
  if (options.size == Size{640, 480} && options.regions == 160)
    std::printf("   %.0f on a CPU, %.2f on a GPU", kPaperCpuMs, kPaperGpuMs);
  std::printf("\n");
}

/// The paper's sizes, and those of today; then its numbers of regions (Figs. 14 and 20).
int runTable(Options options) {
  struct Line {
    Size size;
    int regions;
  };
  std::vector<Line> lines;
  for (const Size size : {Size{100, 100}, Size{120, 160}, Size{200, 200}, Size{400, 400},
                          Size{640, 480}, Size{900, 450}, Size{1024, 768}})
    lines.push_back({size, 160});
  lines.push_back({{1920, 1080}, 512});
  lines.push_back({{3840, 2160}, 1024});
  for (const Size size : {Size{200, 200}, Size{640, 480}})
    for (const int regions : {10, 20, 40, 80, 120, 160}) lines.push_back({size, regions});
  std::printf("%11s %7s", "size", "regions");
  for (const std::string& stage : kStages) std::printf(" %10s", stage.c_str());
  std::printf(" %10s %8s   %s\n", "total ms", "fps", "the paper's ms");
  for (const Line& line : lines) {
    options.size = line.size;
    options.regions = line.regions;
    printLine(measure(options), options);
  }
  return 0;
}

/// Frames of one size and number of regions are typical in more than one way: the clip has noise
/// and borders of all kinds and few things, the scene has twenty that move. mrfmerge works for each
/// object and each of its pixels, too, hsvsegment and srg for each change along a row. So what a
/// stage takes is compared with the typical frame that has more of its work, and the sum, which has
/// to keep up with a camera, with the one that takes less.
class Typical {
 public:
  explicit Typical(Options options) {
    if (options.scene == SceneKind::Any && options.input.empty() && !findClip().empty()) {
      options.scene = SceneKind::Clip;
      frames_.push_back(measure(options, Clock::Cpu));
      options.scene = SceneKind::Synthetic;
    }
    frames_.push_back(measure(options, Clock::Cpu));
  }

  [[nodiscard]] const std::vector<Measured>& frames() const { return frames_; }
  [[nodiscard]] double of(const std::string& stage) const {
    double most = 0;
    for (const Measured& frame : frames_) most = std::max(most, frame.timings.of(stage));
    return most;
  }
  [[nodiscard]] double total() const {
    double least = frames_.front().total();
    for (const Measured& frame : frames_) least = std::min(least, frame.total());
    return least;
  }

 private:
  std::vector<Measured> frames_;
};

/// What each stage and their sum take for frames made to be expensive, by what they take for
/// typical ones.
int runWorst(Options options) {
  const auto printRow = [](const std::string& name, const Measured& measured, int digits,
                           const auto& figure) {
    std::printf("%-14s", name.c_str());
    for (const std::string& stage : kStages)
      std::printf(" %10.*f", digits, figure(measured.timings.of(stage), stage));
    std::printf(" %10.*f %9zu %7zu\n", digits, figure(measured.total(), {}),
                measured.notes.mostRegions, measured.notes.objects);
  };
  const Typical typical(options);
  std::printf("%-14s", "times typical");
  for (const std::string& stage : kStages) std::printf(" %10s", stage.c_str());
  std::printf(" %10s %9s %7s\n", "sum", "regions", "objects");
  for (const Measured& frame : typical.frames())
    printRow("typical CPU ms", frame, 3, [](double ms, const std::string&) { return ms; });
  for (const std::string& pattern : patternNames()) {
    options.pattern = pattern;
    printRow(pattern, measure(options, Clock::Cpu), 2, [&](double ms, const std::string& stage) {
      return ms / (stage.empty() ? typical.total() : typical.of(stage));
    });
  }
  return 0;
}

int run(const Options& options) {
  if (options.asksTable) return runTable(options);
  if (options.streams > 0) return runStreams(options);
  return options.asksWorst ? runWorst(options) : runOnce(options);
}

}  // namespace
}  // namespace rg::bench

int main(int argc, char** argv) {
  return rg::bench::runProgram({argv, static_cast<size_t>(argc)}, rg::bench::run);
}
