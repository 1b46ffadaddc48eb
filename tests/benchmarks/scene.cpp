// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/benchmarks/scene.hpp"

#include "core/base/pixel.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>

namespace rg::bench {
namespace {

using Bgr = std::array<uint8_t, 3>;

/// Saturated colours whose hues are spread over the circle in the order of `index`.
Bgr colourOf(uint32_t index) {
  const uint32_t hash = mixHash(index, 1, 7);
  const int sector = static_cast<int>(hash % 6);
  const int ramp = static_cast<int>(hash >> 8 & 127);
  const int strong = 200, weak = 40;
  const int between = weak + ramp;
  const int channels[6][3] = {{weak, between, strong}, {weak, strong, between},
                              {between, strong, weak}, {strong, between, weak},
                              {strong, weak, between}, {between, weak, strong}};
  const auto& chosen = channels[sector];
  return {static_cast<uint8_t>(chosen[0]), static_cast<uint8_t>(chosen[1]),
          static_cast<uint8_t>(chosen[2])};
}

/// Fixed texture of the thing `index`, in its own coordinates.
int texture(int x, int y, uint32_t index) {
  const auto cell = [](int v) { return static_cast<uint32_t>(v >> 2); };
  return static_cast<int>(mixHash(cell(x), cell(y), index) % 13) - 6;
}

struct Body {
  uint32_t index = 0;
  Size size;
  Point start;
  Point step;  ///< Pixels per frame.
};

/// Position after `time` steps on a track from 0 to `span` and back.
int bounce(int start, int step, int time, int span) {
  if (span <= 0) return 0;
  const int64_t period = 2 * int64_t{span};
  const int64_t along = ((start + int64_t{step} * time) % period + period) % period;
  return static_cast<int>(along <= span ? along : period - along);
}

class Scene final : public FrameSource {
 public:
  explicit Scene(const Options& options) : size_(options.size) {
    const int bodies = std::max(1, options.regions / 8);  // Each has two regions.
    const int tiles = std::max(1, options.regions - 2 * bodies);
    columns_ = std::max(
        1, static_cast<int>(std::lround(std::sqrt(double(tiles) * size_.width / size_.height))));
    rows_ = std::max(1, tiles / columns_);
    const Size body{std::max(2, size_.width / 24), std::max(4, size_.height / 10)};
    const int fastest = std::max(1, options.shiftPx / 2);
    for (int i = 0; i < bodies; ++i) bodies_.push_back(makeBody(i, body, fastest));
  }

  Result<bool> next(RawFrame& frame) override {
    frame.layout.format = PixelFormat::Bgr;
    frame.layout.size = size_;
    frame.bytes.resize(static_cast<size_t>(size_.area()) * 3);
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x) put(frame, x, y, tileAt(x, y), texture(x, y, 0));
    for (const Body& body : bodies_) draw(frame, body);
    ++time_;
    return true;
  }
  std::string describe() const override { return "synthetic scene"; }

 private:
  static Body makeBody(int number, Size size, int fastest) {
    const uint32_t index = 10000 + 2 * static_cast<uint32_t>(number);
    const auto draw = [&](uint32_t what, int count) {
      return static_cast<int>(mixHash(index, what, 3) % static_cast<uint32_t>(count));
    };
    const Point step{draw(1, 2 * fastest + 1) - fastest, draw(2, fastest + 1) - fastest / 2};
    return {index, size, {draw(3, 1 << 16), draw(4, 1 << 16)}, step};
  }

  [[nodiscard]] uint32_t tileAt(int x, int y) const {
    return static_cast<uint32_t>(y * rows_ / size_.height * columns_ + x * columns_ / size_.width);
  }

  void draw(RawFrame& frame, const Body& body) const {
    const Box box =
        intersect({bounce(body.start.x, body.step.x, time_, size_.width - body.size.width),
                   bounce(body.start.y, body.step.y, time_, size_.height - body.size.height),
                   body.size.width, body.size.height},
                  boundsOf(size_));
    for (int y = 0; y < box.height; ++y)
      for (int x = 0; x < box.width; ++x)
        put(frame, box.x + x, box.y + y, body.index + (y < box.height / 2 ? 0u : 1u),
            texture(x, y, body.index));
  }

  void put(RawFrame& frame, int x, int y, uint32_t colour, int shade) const {
    const uint32_t hash = mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y),
                                  17 + static_cast<uint32_t>(time_));
    const int noisy = shade + static_cast<int>(hash % 5) - 2;
    const Bgr base = colourOf(colour);
    uint8_t* to = frame.bytes.data() + (int64_t{y} * size_.width + x) * 3;
    for (size_t channel = 0; channel < 3; ++channel)
      to[channel] = static_cast<uint8_t>(base[channel] + noisy);
  }

  Size size_;
  int columns_ = 1;
  int rows_ = 1;
  int time_ = 0;
  std::vector<Body> bodies_;
};

}  // namespace

Frame RawFrame::view() const {
  std::array<PlaneMemory, Frame::kMaxPlanes> planes;
  const int count = planeCount(layout.format);
  const uint8_t* start = bytes.data();
  for (int i = 0; i < count; ++i) {
    const Size plane = planeBytes(layout.format, layout.size, i);
    planes[static_cast<size_t>(i)] = {start, static_cast<uint64_t>(plane.area()), plane.width};
    start += plane.area();
  }
  auto frame = Frame::make(layout, std::span(planes).first(static_cast<size_t>(count)));
  if (!frame) std::abort();  // The planes were laid out by the very functions that check them.
  return *frame;
}

std::unique_ptr<FrameSource> makeScene(const Options& options) {
  return std::make_unique<Scene>(options);
}

Result<std::unique_ptr<FrameSource>> openSource(const Options& options) {
  if (options.input.ends_with(".y4m")) return openY4m(options.input);
  if (!options.input.empty()) return openVideo(options.input);
  if (!options.pattern.empty()) return makePattern(options.pattern, options.size);
  if (options.scene == SceneKind::Synthetic) return makeScene(options);
  const std::string clip = findClip();
  if (!clip.empty()) return openClip(clip, options.size);
  constexpr char kMissing[] =
      "vtest.avi is not there: run examples/demo.sh once, install opencv-doc, or name a video by "
      "REGIONGRAPH_CLIP";
  if (options.scene == SceneKind::Clip) return Error{kMissing};
  std::cerr << kMissing << ".\nMeasuring on the synthetic scene instead.\n";
  return makeScene(options);
}

}  // namespace rg::bench
