// SPDX-License-Identifier: LGPL-2.1-or-later
// bgremove on every SIMD target against OpenCV's background subtractors: in one process, on the
// same scaled frames of the clip, in turn frame by frame, with the same number of threads.
#include "core/background/background.hpp"
#include "core/base/memory/pool.hpp"
#include "tests/benchmarks/scene.hpp"
#include "tests/benchmarks/timing.hpp"

#include <hwy/targets.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/video.hpp>
#include <opencv2/videoio.hpp>

#include <malloc.h>

#if __has_include(<opencv2/bgsegm.hpp>)
#include <opencv2/bgsegm.hpp>
#define REGIONGRAPH_HAS_BGSEGM 1
#endif

#include <cstdlib>
#include <iostream>

namespace rg::bench {
namespace {

constexpr size_t kClipFrames = 100;  ///< Kept decoded, shown forwards and backwards in turn.
constexpr int64_t kFrameNs = 100'000'000;

size_t bytesInUse() {
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

/// 0: all that the machine has.
void allowTargets(int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

class Subtractor {
 public:
  explicit Subtractor(std::string name) : name_(std::move(name)) {}
  virtual ~Subtractor() = default;
  Subtractor(const Subtractor&) = delete;
  Subtractor& operator=(const Subtractor&) = delete;

  void process(const cv::Mat& frame) {
    const size_t before = bytesInUse();
    const auto start = std::chrono::steady_clock::now();
    apply(frame);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    ms_.push_back(took.count());
    bytes_ += static_cast<int64_t>(bytesInUse()) - static_cast<int64_t>(before);
  }
  void forgetTimes() { ms_.clear(); }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] double medianMs() const { return median(ms_); }
  [[nodiscard]] int64_t bytes() const { return bytes_; }

 private:
  virtual void apply(const cv::Mat& frame) = 0;

  std::string name_;
  std::vector<double> ms_;
  int64_t bytes_ = 0;
};

/// The stage as the element runs it: conversion of the frame included.
class Ours final : public Subtractor {
 public:
  Ours(int64_t target, int threads)
      : Subtractor(std::string("bgremove ") + hwy::TargetName(target)),
        target_(target),
        context_{std::make_shared<Executor>(threads), {}},
        stage_(background::makeStage(context_)) {}

  [[nodiscard]] const background::Foreground& result() const { return *result_; }

 private:
  void apply(const cv::Mat& frame) override {
    allowTargets(target_);
    const PlaneMemory plane{frame.data, frame.total() * 3, frame.cols * 3};
    const auto view = Frame::make({PixelFormat::Bgr, {frame.cols, frame.rows}}, {&plane, 1});
    const auto picture = pictures_.take();
    picture->load(*view, *context_.cpu);
    result_ = *stage_->process(picture, {}, {frames_++ * kFrameNs, true});
  }

  int64_t target_;
  Context context_;
  std::unique_ptr<background::Stage> stage_;
  Pool<Picture> pictures_;
  std::shared_ptr<const background::Foreground> result_;
  int64_t frames_ = 0;
};

class Peer final : public Subtractor {
 public:
  Peer(std::string name, cv::Ptr<cv::BackgroundSubtractor> subtractor)
      : Subtractor(std::move(name)), subtractor_(std::move(subtractor)) {}

 private:
  void apply(const cv::Mat& frame) override { subtractor_->apply(frame, mask_); }

  cv::Ptr<cv::BackgroundSubtractor> subtractor_;
  cv::Mat mask_;
};

using Subtractors = std::vector<std::unique_ptr<Subtractor>>;

Subtractors makeAll(int threads) {
  Subtractors all;
  allowTargets(0);
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    all.push_back(std::make_unique<Ours>(target, threads));
  const auto add = [&](const char* name, cv::Ptr<cv::BackgroundSubtractor> subtractor) {
    all.push_back(std::make_unique<Peer>(name, std::move(subtractor)));
  };
  add("MOG2", cv::createBackgroundSubtractorMOG2());
  add("KNN", cv::createBackgroundSubtractorKNN());
#ifdef REGIONGRAPH_HAS_BGSEGM
  add("CNT", cv::bgsegm::createBackgroundSubtractorCNT());
  add("GSOC", cv::bgsegm::createBackgroundSubtractorGSOC());
#endif
  return all;
}

bool agree(const Subtractors& all) {
  const auto* first = dynamic_cast<const Ours*>(all.front().get());
  return std::all_of(all.begin(), all.end(), [&](const auto& other) {
    const auto* ours = dynamic_cast<const Ours*>(other.get());
    return !ours || ours->result().scene.foregroundPx == first->result().scene.foregroundPx;
  });
}

void print(const Subtractors& all, Size size, const Options& options) {
  const double ours = all.front()->medianMs();
  const auto pixels = static_cast<double>(size.area());
  std::printf("%dx%d, threads %d, frames %d of the clip, scaled\n", size.width, size.height,
              cv::getNumThreads(), options.frames);
  std::printf("%-18s %10s %8s %10s %12s\n", "subtractor", "median ms", "ratio", "MB",
              "bytes/pixel");
  for (const auto& one : all)
    std::printf("%-18s %10.3f %8.2f %10.1f %12.1f\n", one->name().c_str(), one->medianMs(),
                one->medianMs() / ours, static_cast<double>(one->bytes()) / 1e6,
                static_cast<double>(one->bytes()) / pixels);
}

void measure(const std::vector<cv::Mat>& clip, Size size, const Options& options) {
  const Subtractors all = makeAll(options.threads);
  const int warmUp = size.area() > 640 * 480 ? kWarmUpFrames / 3 : kWarmUpFrames;
  const auto turns = static_cast<int>(2 * clip.size() - 2);
  cv::Mat frame;
  for (int i = 0; i < warmUp + options.frames; ++i) {
    const int at = turns > 0 ? i % turns : 0;
    const int index = std::min(at, turns - at);
    cv::resize(clip[static_cast<size_t>(index)], frame, {size.width, size.height});
    for (const auto& one : all) {
      if (i == warmUp) one->forgetTimes();
      one->process(frame);
    }
  }
  print(all, size, options);
  if (!agree(all)) {
    std::cerr << "bench-background: the SIMD targets' masks differ\n";
    std::exit(1);
  }
}

std::vector<cv::Mat> readClip() {
  std::vector<cv::Mat> frames;
  const std::string clip = findClip();
  if (clip.empty()) return frames;  // OpenCV would look for cameras of every kind.
  cv::VideoCapture capture(clip);
  cv::Mat frame;
  while (frames.size() < kClipFrames && capture.read(frame)) frames.push_back(frame.clone());
  return frames;
}

int run(const Options& options) {
  const std::vector<cv::Mat> clip = readClip();
  if (clip.empty()) {
    std::cerr << "bench-background: no clip; REGIONGRAPH_CLIP may name one\n";
    return 77;
  }
  cv::setNumThreads(options.threads > 0 ? options.threads : cv::getNumberOfCPUs());
  if (!options.asksTable) {
    measure(clip, options.size, options);
    return 0;
  }
  for (const Size size : {Size{640, 480}, Size{1920, 1080}, Size{3840, 2160}})
    measure(clip, size, options);
  return 0;
}

}  // namespace
}  // namespace rg::bench

int main(int argc, char** argv) {
  return rg::bench::runProgram({argv, static_cast<size_t>(argc)}, rg::bench::run);
}
