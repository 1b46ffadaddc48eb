// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/accuracy/canvas.hpp"

#include "core/base/memory/executor.hpp"
#include "core/base/picture.hpp"
#include "tests/accuracy/dice.hpp"
#include "tests/benchmarks/scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rg::truth {
namespace {

/// Smooth noise of −1 … 1 with features of about `period`.
float valueNoise(double x, double y, int period, uint32_t seed) {
  const auto corner = [&](int cx, int cy) {
    const uint32_t hash = mixHash(static_cast<uint32_t>(cx), static_cast<uint32_t>(cy), seed);
    return static_cast<float>(hash % 2001) / 1000.0f - 1.0f;
  };
  const int cx = static_cast<int>(x / period), cy = static_cast<int>(y / period);
  const auto ease = [&](double v) {
    const float t = static_cast<float>(v) / static_cast<float>(period);
    return t * t * (3 - 2 * t);
  };
  const float u = ease(x - cx * period), v = ease(y - cy * period);
  const float top = corner(cx, cy) * (1 - u) + corner(cx + 1, cy) * u;
  const float low = corner(cx, cy + 1) * (1 - u) + corner(cx + 1, cy + 1) * u;
  return top * (1 - v) + low * v;
}

/// Rough at all scales, as ground and walls are; what is finer than two pixels is not seen.
float roughness(double x, double y, double pixel, uint32_t seed) {
  float sum = 0, weight = 16;
  for (const int period : {97, 41, 17, 7, 3}) {
    if (period >= 2 * pixel)
      sum += weight * valueNoise(x, y, period, seed + static_cast<uint32_t>(period));
    weight *= 0.7f;
  }
  return sum;
}

struct Patch {
  Box box;
  Rgb tint;
};

class Yard final : public CanvasSource {
 public:
  Yard(uint32_t seed, Size shown, double scale) : canvas_{shown, {}} {
    Dice dice(seed, 1);
    const Size size{static_cast<int>(std::lround(shown.width / scale)),
                    static_cast<int>(std::lround(shown.height / scale))};
    const int horizon = size.height * dice.whole(20, 35) / 100;
    const auto tint = [&](double spread) {
      const auto part = [&] { return static_cast<float>(dice.real(-spread, spread)); };
      return Rgb{part(), part(), part()};
    };
    const Rgb wall = tint(15), ground = tint(15);
    std::vector<Patch> patches;
    for (int i = 0; i < size.width * size.height / 12000; ++i) {
      const bool isWindow = i % 2 == 0;
      const int width = dice.whole(12, 60), height = dice.whole(8, isWindow ? 50 : 20);
      const int y = isWindow ? dice.whole(0, horizon) : dice.whole(horizon, size.height);
      patches.push_back({{dice.whole(0, size.width), y, width, height}, tint(45)});
    }
    canvas_.pixels.reserve(static_cast<size_t>(shown.area()));
    for (int row = 0; row < shown.height; ++row)
      for (int column = 0; column < shown.width; ++column) {
        const double x = column / scale, y = row / scale;
        Rgb colour = y < horizon ? wall : ground;
        for (const Patch& patch : patches)
          if (patch.box.contains({static_cast<int>(x), static_cast<int>(y)}))
            for (size_t c = 0; c < 3; ++c) colour[c] += patch.tint[c];
        const float shade = (y < horizon ? 135.0f : 110.0f) + roughness(x, y, 1 / scale, seed);
        for (float& part : colour) part = std::clamp(part + shade, 8.0f, 247.0f);
        canvas_.pixels.push_back(colour);
      }
  }
  const Canvas& next() override { return canvas_; }

 private:
  Canvas canvas_;
};

class Clip final : public CanvasSource {
 public:
  Clip(std::unique_ptr<bench::FrameSource> frames, Size size)
      : frames_(std::move(frames)), canvas_{size, {}} {}

  const Canvas& next() override {
    if (!frames_->next(frame_)) return canvas_;
    picture_.load(frame_.view(), executor_);
    const Size from = picture_.size();
    source_.size = from;
    source_.pixels.clear();
    for (int y = 0; y < from.height; ++y)
      for (int x = 0; x < from.width; ++x)
        source_.pixels.push_back({static_cast<float>(picture_.red().at(x, y)),
                                  static_cast<float>(picture_.green().at(x, y)),
                                  static_cast<float>(picture_.blue().at(x, y))});
    canvas_.pixels.clear();
    const auto place = [](int v, int to, int of) { return (v + 0.5) * of / to - 0.5; };
    for (int y = 0; y < canvas_.size.height; ++y)
      for (int x = 0; x < canvas_.size.width; ++x)
        canvas_.pixels.push_back(source_.sample(place(x, canvas_.size.width, from.width),
                                                place(y, canvas_.size.height, from.height)));
    return canvas_;
  }

 private:
  std::unique_ptr<bench::FrameSource> frames_;
  Executor executor_{1};
  bench::RawFrame frame_;
  Picture picture_;
  Canvas source_, canvas_;
};

}  // namespace

Rgb Canvas::sample(double x, double y) const {
  const double left = std::floor(x), top = std::floor(y);
  const auto u = static_cast<float>(x - left), v = static_cast<float>(y - top);
  const auto pixel = [&](double px, double py) -> const Rgb& {
    return at(std::clamp(static_cast<int>(px), 0, size.width - 1),
              std::clamp(static_cast<int>(py), 0, size.height - 1));
  };
  const Rgb &a = pixel(left, top), &b = pixel(left + 1, top), &c = pixel(left, top + 1),
            &d = pixel(left + 1, top + 1);
  Rgb result;
  for (size_t i = 0; i < 3; ++i)
    result[i] = (a[i] * (1 - u) + b[i] * u) * (1 - v) + (c[i] * (1 - u) + d[i] * u) * v;
  return result;
}

std::unique_ptr<CanvasSource> makeYard(uint32_t seed, Size size, double scale) {
  return std::make_unique<Yard>(seed, size, scale);
}

Result<std::unique_ptr<CanvasSource>> openClip(const std::string& path, Size size) {
  auto frames = bench::openY4m(path);
  if (!frames) return frames.error();
  return std::unique_ptr<CanvasSource>(std::make_unique<Clip>(*std::move(frames), size));
}

}  // namespace rg::truth
