// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "tests/benchmarks/scene.hpp"

#include <opencv2/videoio.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

namespace rg::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kClipFrames = 48;  // Kept decoded; they are shown forwards and backwards in turn.
constexpr double kNoiseSigma = 3;
constexpr size_t kNoiseLevels = size_t{1} << 16;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// Levels whose distribution is Gaussian: pairs of uniform numbers turned by Box and Muller.
std::vector<int8_t> gaussianNoise() {
  std::vector<int8_t> levels(kNoiseLevels);
  for (uint32_t i = 0; i < kNoiseLevels; ++i) {
    const double u = (mixHash(i, 1, 11) + 1.0) / 4294967297.0;
    const double v = mixHash(i, 2, 11) / 4294967296.0;
    const double normal = std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
    levels[i] = static_cast<int8_t>(std::lround(kNoiseSigma * normal));
  }
  return levels;
}

/// Position on a mirrored axis: 0 … length − 1 and back, again and again.
int mirrored(int at, int length) {
  const int folded = at % (2 * length);
  return folded < length ? folded : 2 * length - 1 - folded;
}

class ClipScene final : public FrameSource {
 public:
  ClipScene(std::vector<cv::Mat> frames, Size size)
      : frames_(std::move(frames)), size_(size), noise_(gaussianNoise()) {}

  Result<bool> next(RawFrame& frame) override {
    frame.layout.format = PixelFormat::Bgr;
    frame.layout.size = size_;
    frame.bytes.resize(static_cast<size_t>(size_.area()) * 3);
    const cv::Mat& picture =
        frames_[static_cast<size_t>(mirrored(time_, static_cast<int>(frames_.size())))];
    const int left = std::max(0, (picture.cols - size_.width) / 2);
    const int top = std::max(0, (picture.rows - size_.height) / 2);
    for (int y = 0; y < size_.height; ++y) {
      const uint8_t* row = picture.ptr<uint8_t>(mirrored(top + y, picture.rows));
      copyRow(row, picture.cols, left, y, frame.bytes.data() + int64_t{y} * size_.width * 3);
    }
    ++time_;
    return true;
  }
  std::string describe() const override { return "real frames with noise"; }

 private:
  void copyRow(const uint8_t* row, int columns, int left, int y, uint8_t* to) const {
    size_t at = mixHash(static_cast<uint32_t>(y), static_cast<uint32_t>(time_), 13);
    for (int x = 0; x < size_.width; ++x) {
      const uint8_t* from = row + mirrored(left + x, columns) * 3;
      for (int channel = 0; channel < 3; ++channel)
        *to++ =
            static_cast<uint8_t>(std::clamp(from[channel] + noise_[at++ % kNoiseLevels], 0, 255));
    }
  }

  std::vector<cv::Mat> frames_;
  Size size_;
  std::vector<int8_t> noise_;
  int time_ = 0;
};

class Video final : public FrameSource {
 public:
  Video(std::string path, cv::VideoCapture capture)
      : path_(std::move(path)), capture_(std::move(capture)) {}

  Result<bool> next(RawFrame& frame) override {
    if (!capture_.read(picture_) && !(capture_.open(path_) && capture_.read(picture_)))
      return Error{path_ + " can't be decoded"};
    if (picture_.type() != CV_8UC3) return Error{path_ + ": frames are not of 8-bit colour"};
    frame.layout.format = PixelFormat::Bgr;
    frame.layout.size = {picture_.cols, picture_.rows};
    frame.bytes.clear();
    for (int y = 0; y < picture_.rows; ++y)
      frame.bytes.insert(frame.bytes.end(), picture_.ptr(y), picture_.ptr(y) + 3 * picture_.cols);
    return true;
  }
  std::string describe() const override { return "file"; }

 private:
  std::string path_;
  cv::VideoCapture capture_;
  cv::Mat picture_;
};

}  // namespace

std::string findClip() {
  const std::string cache = environment("XDG_CACHE_HOME");
  const fs::path home = environment("HOME");
  const fs::path places[] = {
      environment("REGIONGRAPH_CLIP"),
      (cache.empty() ? home / ".cache" : fs::path(cache)) / "gst-regiongraph" / "vtest.avi",
      "/usr/share/doc/opencv-doc/examples/data/vtest.avi"};
  for (const fs::path& place : places) {
    std::error_code error;
    if (fs::is_regular_file(place, error)) return place.string();
  }
  return {};
}

Result<std::unique_ptr<FrameSource>> openClip(const std::string& path, Size size) {
  cv::VideoCapture capture(path);
  std::vector<cv::Mat> frames;
  cv::Mat frame;
  while (frames.size() < kClipFrames && capture.read(frame)) {
    if (frame.type() != CV_8UC3) return Error{path + ": frames are not of 8-bit colour"};
    frames.push_back(frame.clone());
  }
  if (frames.empty()) return Error{path + " can't be decoded"};
  std::unique_ptr<FrameSource> source = std::make_unique<ClipScene>(std::move(frames), size);
  return source;
}

Result<std::unique_ptr<FrameSource>> openVideo(const std::string& path) {
  cv::VideoCapture capture(path);
  if (!capture.isOpened()) return Error{path + " can't be decoded"};
  std::unique_ptr<FrameSource> source = std::make_unique<Video>(path, std::move(capture));
  return source;
}

}  // namespace rg::bench
