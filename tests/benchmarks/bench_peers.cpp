// SPDX-License-Identifier: LGPL-2.1-or-later
// Times of what OpenCV offers for the same work, on the same frames and options as bench.
#include "tests/benchmarks/scene.hpp"
#include "tests/benchmarks/timing.hpp"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video.hpp>

#include <iostream>

namespace rg::bench {
namespace {

constexpr char kLoadRow[] = "load";
constexpr int kSlowFrames = 3;

class Peers {
 public:
  void process(const RawFrame& raw, Timings& timings) {
    const cv::Mat frame = timings.measure(kLoadRow, [&] { return bgrOf(raw); });
    timings.measure("MOG2", [&] { subtractor_->apply(frame, mask_); });
    timings.measure("HSV", [&] { cv::cvtColor(frame, hsv_, cv::COLOR_BGR2HSV); });
    timings.measure("components", [&] {
      return cv::connectedComponentsWithStats(mask_, labels_, statistics_, centroids_);
    });
    timings.measure("DIS flow", [&] {
      cv::swap(luma_, previousLuma_);
      cv::cvtColor(frame, luma_, cv::COLOR_BGR2GRAY);
      if (!previousLuma_.empty()) flow_->calc(previousLuma_, luma_, vectors_);
    });
    last_ = frame;
  }

  /// What takes much longer than all of these: not in the sum.
  void processSlowly(Timings& timings) {
    timings.measure("Farneback", [&] {
      cv::calcOpticalFlowFarneback(previousLuma_, luma_, vectors_, 0.5, 3, 15, 3, 5, 1.2, 0);
    });
    timings.measure("mean shift", [&] { cv::pyrMeanShiftFiltering(last_, shifted_, 10, 20); });
  }

 private:
  /// OpenCV's algorithms take BGR; packed frames need no conversion and no copy.
  cv::Mat bgrOf(const RawFrame& raw) {
    const int width = raw.layout.size.width;
    const int height = raw.layout.size.height;
    auto* bytes = const_cast<uint8_t*>(raw.bytes.data());  // cv::Mat has no const view.
    if (raw.layout.format == PixelFormat::Bgr) return {height, width, CV_8UC3, bytes};
    const bool isGrey = raw.layout.format == PixelFormat::Gray8;
    const cv::Mat planes(isGrey ? height : height * 3 / 2, width, CV_8UC1, bytes);
    cv::cvtColor(planes, bgr_, isGrey ? cv::COLOR_GRAY2BGR : cv::COLOR_YUV2BGR_I420);
    return bgr_;
  }

  cv::Ptr<cv::BackgroundSubtractorMOG2> subtractor_ = cv::createBackgroundSubtractorMOG2();
  cv::Ptr<cv::DISOpticalFlow> flow_ = cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_FAST);
  cv::Mat bgr_, mask_, hsv_, labels_, statistics_, centroids_, luma_, previousLuma_, vectors_,
      last_, shifted_;
};

int run(const Options& options) {
  const auto source = openSource(options);
  if (!source) {
    std::cerr << "bench-peers: " << source.error().message << '\n';
    return 1;
  }
  cv::setNumThreads(options.threads > 0 ? options.threads : cv::getNumberOfCPUs());
  Peers peers;
  Timings timings;
  RawFrame frame;
  for (int i = 0; i < kWarmUpFrames + options.frames; ++i) {
    if (const auto read = (*source)->next(frame); !read) {
      std::cerr << "bench-peers: " << read.error().message << '\n';
      return 1;
    }
    if (i == kWarmUpFrames) timings.clear();
    peers.process(frame, timings);
  }
  std::printf("%dx%d, threads %d, frames %d, %s\n", frame.layout.size.width,
              frame.layout.size.height, cv::getNumThreads(), options.frames,
              (*source)->describe().c_str());
  timings.printRows();
  Timings slow;
  for (int i = 0; i < std::min(kSlowFrames, options.frames); ++i) peers.processSlowly(slow);
  std::printf("not in the sum: Farneback %.1f ms, pyrMeanShiftFiltering %.1f ms\n",
              slow.of("Farneback"), slow.of("mean shift"));
  std::printf("peers_ms=%.3f\n", timings.total({kLoadRow}));
  return 0;
}

}  // namespace
}  // namespace rg::bench

int main(int argc, char** argv) {
  return rg::bench::runProgram({argv, static_cast<size_t>(argc)}, rg::bench::run);
}
