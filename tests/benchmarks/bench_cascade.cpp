// SPDX-License-Identifier: LGPL-2.1-or-later
// haardetect's search against OpenCV's CascadeClassifier: in one process, on the clip's frames as
// they are, in turn frame by frame, with the same number of threads, scale factor and grouping. The
// search is timed over the whole frame and over the areas round what the five stages follow.
#include "core/background/background.hpp"
#include "core/base/memory/pool.hpp"
#include "core/detection/detection.hpp"
#include "core/graph/graph.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/objects.hpp"
#include "core/segmentation/segmentation.hpp"
#include "gst/support/cascade_file.hpp"
#include "tests/benchmarks/scene.hpp"
#include "tests/benchmarks/timing.hpp"
#include "tests/support/value_of.hpp"

#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>
#include <opencv2/videoio.hpp>

#include <array>
#include <iostream>

namespace rg::bench {
namespace {

constexpr const char* kFolder = "/usr/share/opencv4/haarcascades/";
constexpr std::array kCascades{"haarcascade_fullbody.xml", "haarcascade_frontalface_default.xml"};
constexpr double kScaleFactor = 1.1, kAreaMargin = .25;
constexpr int kMinNeighbours = 3;
constexpr int64_t kFrameNs = 100'000'000;

/// The five stages, for the areas where something moves.
class Tracker {
 public:
  explicit Tracker(const Context& context)
      : context_(context),
        background_(background::makeStage(context)),
        segmentation_(segmentation::makeStage(context)),
        graph_(graph::makeStage(context)),
        motion_(motion::makeStage(context)),
        objects_(objects::makeStage(context)) {
    scope_.scope = segmentation::Scope::Foreground;
  }

  std::vector<Box> areasOf(const cv::Mat& frame) {
    const PlaneMemory plane{frame.data, frame.total() * 3, frame.cols * 3};
    const Size size{frame.cols, frame.rows};
    const auto view = Frame::make({PixelFormat::Bgr, size}, {&plane, 1});
    const auto picture = pictures_.take();
    picture->load(*view, *context_.cpu);
    const FrameTime time{frames_++ * kFrameNs, true};
    const auto foreground = valueOf(background_->process(picture, {}, time));
    const auto labels = valueOf(segmentation_->process(picture, foreground, scope_));
    const auto motion = valueOf(motion_->process(valueOf(graph_->process(labels, {})), {}, {}));
    const auto objects = valueOf(objects_->process(motion, {}, time));
    std::vector<Box> areas;
    for (const objects::Object& object : objects->objects)
      if (objects::isListed(object.state))
        areas.push_back(detection::areaAround(object.box, kAreaMargin));
    return areas;
  }

 private:
  Context context_;
  Pool<Picture> pictures_;
  std::unique_ptr<background::Stage> background_;
  std::unique_ptr<segmentation::Stage> segmentation_;
  std::unique_ptr<graph::Stage> graph_;
  std::unique_ptr<motion::Stage> motion_;
  std::unique_ptr<objects::Stage> objects_;
  segmentation::Params scope_;
  int64_t frames_ = 0;
};

/// One cascade in both detectors.
class Contest {
 public:
  Contest(const char* file, const Context& context, Clock clock)
      : name_(file),
        cascade_(valueOf(readCascade(std::string(kFolder) + file))),
        whole_(detection::makeStage(context)),
        inAreas_(detection::makeStage(context)),
        peer_(std::string(kFolder) + file),
        timings_(clock) {
    params_.scaleFactor = kScaleFactor;
    params_.minNeighbours = kMinNeighbours;
  }

  void process(const cv::Mat& grey, const std::vector<Box>& areas) {
    const ImageView<const uint8_t> luma{
        grey.data, {grey.cols, grey.rows}, static_cast<ptrdiff_t>(grey.step)};
    const std::array frame{boundsOf(luma.size)};
    timings_.measure("OpenCV, frame",
                     [&] { peer_.detectMultiScale(grey, boxes_, kScaleFactor, kMinNeighbours); });
    const auto whole = timings_.measure("haardetect, frame", [&] {
      return valueOf(whole_->process(luma, frame, cascade_, params_));
    });
    const auto some = timings_.measure("haardetect, areas", [&] {
      return valueOf(inAreas_->process(luma, areas, cascade_, params_));
    });
    peers_ += boxes_.size();
    frames_ += whole.found.size();
    areas_ += some.found.size();
  }
  void forget() {
    timings_.clear();
    peers_ = frames_ = areas_ = 0;
  }

  void print() const {
    std::printf("%s\n", name_.c_str());
    timings_.printRows();
    const double peer = timings_.of("OpenCV, frame");
    std::printf("found in all: OpenCV %zu, frame %zu, areas %zu\n", peers_, frames_, areas_);
    std::printf("frame_ratio=%.2f\nareas_ratio=%.2f\n", peer / timings_.of("haardetect, frame"),
                peer / timings_.of("haardetect, areas"));
  }

 private:
  std::string name_;
  std::shared_ptr<const detection::Cascade> cascade_;
  detection::Params params_;
  std::unique_ptr<detection::Stage> whole_, inAreas_;
  cv::CascadeClassifier peer_;
  Timings timings_;
  std::vector<cv::Rect> boxes_;
  size_t peers_ = 0, frames_ = 0, areas_ = 0;
};

int run(const Options& options) {
  const std::string clip = findClip();
  if (clip.empty()) {
    std::cerr << "bench-cascade: no clip; REGIONGRAPH_CLIP may name one\n";
    return 77;
  }
  cv::setNumThreads(options.threads > 0 ? options.threads : cv::getNumberOfCPUs());
  const Context context{std::make_shared<Executor>(options.threads), {}};
  Tracker tracker(context);
  const Clock clock = options.asksCpu ? Clock::Cpu : Clock::Wall;
  std::vector<Contest> contests;
  for (const char* file : kCascades) contests.emplace_back(file, context, clock);
  cv::VideoCapture capture(clip);
  cv::Mat frame, grey;
  double share = 0;
  int measured = 0;
  for (int i = 0; measured < options.frames && capture.read(frame); ++i) {
    const auto areas = tracker.areasOf(frame);
    if (i < options.warmUp) continue;
    cv::cvtColor(frame, grey, cv::COLOR_BGR2GRAY);
    for (Contest& contest : contests) {
      contest.process(grey, areas);
      if (measured > 0) continue;
      contest.forget();  // What the first frame took to set up.
      contest.process(grey, areas);
    }
    std::vector<Box> united;
    detection::uniteAreas(areas, {grey.cols, grey.rows}, united);
    for (const Box& area : united)
      share += static_cast<double>(area.area()) / static_cast<double>(grey.total());
    ++measured;
  }
  std::printf("%dx%d, threads %d, frames %d of the clip, areas %.1f %% of the frame\n", grey.cols,
              grey.rows, context.cpu->threads(), measured, 100 * share / std::max(measured, 1));
  for (const Contest& contest : contests) contest.print();
  return 0;
}

}  // namespace
}  // namespace rg::bench

int main(int argc, char** argv) {
  return rg::bench::runProgram({argv, static_cast<size_t>(argc)}, rg::bench::run);
}
