// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/pixel.hpp"
#include "tests/benchmarks/scene.hpp"

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
            [](const Place& at) { return at.x % 2 == 0 && (at.y + at.time) % 2 == 0 ? 200 : 60; }}};

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
