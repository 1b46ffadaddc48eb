// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "tests/benchmarks/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rg::bench {
namespace {

struct Place {
  int x, y, time;
  Size size;
};

uint32_t hashOf(const Place& at, uint32_t what) {
  return mixHash(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.y),
                 static_cast<uint32_t>(at.time) * 8 + what);
}

/// A spiral of bands three pixels wide.
bool isOnSpiral(const Place& at) {
  const double x = at.x - at.size.width / 2.0, y = at.y - at.size.height / 2.0;
  const double turn = std::hypot(x, y) / 6 - std::atan2(y, x) / (2 * std::numbers::pi);
  return turn - std::floor(turn) < 0.5;
}

/// A fixed texture of spots of 6x6 pixels in blocks of 48x48, of levels around 120.
int texture(int x, int y, uint32_t what) {
  const auto level = [&](int side, uint32_t seed, uint32_t levels) {
    const auto cell = [&](int v) { return static_cast<uint32_t>((v + 65536) / side); };
    return static_cast<int>(mixHash(cell(x), cell(y), seed) % levels);
  };
  return 60 + level(48, what, 80) + level(6, what + 1, 40);
}

/// The texture moves by a thirtieth of the frame's width in each frame, and down by half as much.
int panLevel(const Place& at) {
  const int step = std::max(1, at.size.width / 30);
  return texture(at.x + step * at.time % 32768, at.y - step / 2 * at.time % 32768, 5);
}

/// Ten things in each of six rows, which move along them at speeds of their own and cover a
/// quarter of the texture behind them.
int crowdLevel(const Place& at) {
  constexpr int kRows = 6, kColumns = 10;
  const int row = at.y * kRows / at.size.height;
  const int pitchX = std::max(4, at.size.width / kColumns);
  const int pitchY = std::max(4, at.size.height / kRows);
  const int step = (row % 2 == 0 ? 1 : -1) * (2 + row);
  const int around = pitchX * kColumns;
  const int x = ((at.x - step * at.time) % around + around) % around;
  const int y = at.y - (row * at.size.height + kRows - 1) / kRows;
  const bool isThing = 2 * (x % pitchX) < pitchX && 2 * y < pitchY;
  const auto thing = static_cast<uint32_t>(100 + 2 * (row * kColumns + x / pitchX));
  return isThing ? 255 - texture(x, y, thing) : texture(at.x, at.y, 7) / 2;
}

/// What is seen at a place, from 0 to 255, before noise.
struct Pattern {
  std::string_view name;
  int (*levelAt)(const Place& at);
};
constexpr std::array kPatterns = {
    Pattern{"flat", [](const Place&) { return 120; }},
    Pattern{"checkerboard",
            [](const Place& at) { return (at.x + at.y + at.time) % 2 == 0 ? 60 : 180; }},
    Pattern{"noise", [](const Place& at) { return static_cast<int>(hashOf(at, 1) & 255); }},
    Pattern{"comb",
            [](const Place& at) { return at.y > 4 && (at.x + at.time) % 4 < 2 ? 60 : 180; }},
    Pattern{"spiral", [](const Place& at) { return isOnSpiral(at) ? 60 : 180; }},
    Pattern{"dots",
            [](const Place& at) { return at.x % 2 == 0 && (at.y + at.time) % 2 == 0 ? 200 : 60; }},
    Pattern{"pan", panLevel},
    Pattern{"60-objects", crowdLevel}};

class PatternScene final : public FrameSource {
 public:
  PatternScene(const Pattern& pattern, Size size) : pattern_(pattern), size_(size) {}

  Result<bool> next(RawFrame& frame) override {
    frame.layout.format = PixelFormat::Bgr;
    frame.layout.size = size_;
    frame.bytes.resize(static_cast<size_t>(size_.area()) * 3);
    uint8_t* to = frame.bytes.data();
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x) {
        const Place at{x, y, time_, size_};
        const int level = pattern_.levelAt(at);
        for (uint32_t channel = 0; channel < 3; ++channel)
          *to++ = static_cast<uint8_t>(
              std::clamp(level + static_cast<int>(hashOf(at, 2 + channel) % 5) - 2, 0, 255));
      }
    ++time_;
    return true;
  }
  std::string describe() const override { return std::string(pattern_.name); }

 private:
  const Pattern& pattern_;
  Size size_;
  int time_ = 0;
};

}  // namespace

std::vector<std::string> patternNames() {
  std::vector<std::string> names;
  for (const Pattern& pattern : kPatterns) names.emplace_back(pattern.name);
  return names;
}

std::unique_ptr<FrameSource> makePattern(const std::string& name, Size size) {
  for (const Pattern& pattern : kPatterns)
    if (pattern.name == name) return std::make_unique<PatternScene>(pattern, size);
  return nullptr;
}

}  // namespace rg::bench
