// SPDX-License-Identifier: LGPL-2.1-or-later
// A synthetic scene for tests of bgremove: a textured wall, a walker, light, noise, and a camera
// that may be pushed.
#pragma once

#include "core/background/background.hpp"
#include "core/base/pixel.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <ostream>

namespace rg::test {

enum class Texture : uint8_t { Tiles, Stone, Ramp, Stripes };

struct Stage {
  Texture texture = Texture::Tiles;
  int noise = 3;  ///< Largest deviation of a channel.
  uint32_t seed = 1;
};
inline std::ostream& operator<<(std::ostream& out, const Stage& stage) {
  return out << "texture " << static_cast<int>(stage.texture) << ", noise " << stage.noise
             << ", seed " << stage.seed;
}

/// What one frame shows.
struct Take {
  std::optional<Box> walker;
  int gainPercent = 100;
  Point push;           ///< Pixels that the camera has moved; the walker moves with the scene.
  bool isGrey = false;  ///< No colour, as a camera's picture by infra-red light.
  int fogPercent = 0;   ///< Of the scene's light that fog takes and replaces by its own.
};

class StagedScene {
 public:
  static constexpr Size kSize{160, 120};
  static constexpr int64_t kFrameNs = 40'000'000;

  explicit StagedScene(const Stage& stage, background::Params params = {},
                       std::shared_ptr<Device> device = nullptr)
      : scene_(stage),
        stage_(background::makeStage({std::make_shared<const Executor>(1), std::move(device)})),
        params_(std::move(params)) {}

  std::shared_ptr<const background::Foreground> show(const Take& take) {
    const auto picture = makePicture(kSize, [&](int x, int y) { return pixel(take, x, y); });
    auto result = stage_->process(picture, params_, {frame_ * kFrameNs, true});
    ++frame_;
    EXPECT_TRUE(result);
    return *result;
  }
  background::Params& params() { return params_; }
  void breakOff() { stage_->reset(Reset::Gap); }
  /// As at the start, but time goes on.
  void forget() { stage_->reset(Reset::Stream); }
  std::shared_ptr<const background::Foreground> showFor(int frames, const Take& take) {
    for (int i = 1; i < frames; ++i) show(take);
    return show(take);
  }

 private:
  [[nodiscard]] uint32_t dice(int x, int y, uint32_t salt) const {
    const uint64_t place = uint64_t{static_cast<uint32_t>(y)} << 32 | static_cast<uint32_t>(x);
    return static_cast<uint32_t>(mixHash64(place * 31 + salt + (uint64_t{scene_.seed} << 48)) >>
                                 32);
  }

  [[nodiscard]] int wall(int x, int y) const {
    switch (scene_.texture) {
      case Texture::Tiles:
        return 90 + static_cast<int>(dice(x / 16 + 1000, y / 12 + 1000, 1) % 90);
      case Texture::Stone:
        return 110 + static_cast<int>(dice(x / 3 + 1000, y / 3 + 1000, 2) % 50);
      case Texture::Ramp:
        return 70 + (x + y) * 110 / (kSize.width + kSize.height);
      case Texture::Stripes:
        return (x + 1000) / 10 % 2 == 0 ? 100 : 165;
    }
    return 0;
  }

  [[nodiscard]] Rgb pixel(const Take& take, int x, int y) const {
    const int u = x + take.push.x, v = y + take.push.y;
    const bool isWalker = take.walker && take.walker->contains({u, v});
    const int level = isWalker ? 45 + static_cast<int>(dice(u / 5, v / 7, 3) % 20) : wall(u, v);
    std::array colour{level, level, isWalker ? 3 * level : level * 3 / 5};
    if (take.isGrey) colour.fill(level);
    const uint32_t grain = dice(x, y, 1000 + static_cast<uint32_t>(frame_));
    for (size_t c = 0; c < colour.size(); ++c) {
      const auto off = static_cast<int>((take.isGrey ? grain : grain >> 8 * c) & 0xFF);
      const int noise = off * (2 * scene_.noise + 1) / 256 - scene_.noise;
      constexpr int kFog = 200;  // Grey level.
      const int lit = colour[c] * take.gainPercent / 100;
      colour[c] = std::clamp(lit + (kFog - lit) * take.fogPercent / 100 + noise, 0, 255);
    }
    return {static_cast<uint8_t>(colour[0]), static_cast<uint8_t>(colour[1]),
            static_cast<uint8_t>(colour[2])};
  }

  Stage scene_;
  std::unique_ptr<background::Stage> stage_;
  background::Params params_;
  int frame_ = 0;
};

struct Marks {
  int foundPercent = 0;     ///< Of the walker.
  double falsePercent = 0;  ///< Foreground farther than two pixels from it, of the frame.
};
inline Marks marksOf(const background::Foreground& foreground, std::optional<Box> walker) {
  const Box near =
      walker ? Box{walker->x - 2, walker->y - 2, walker->width + 4, walker->height + 4} : Box{};
  int found = 0, wrong = 0;
  for (int y = 0; y < foreground.size.height; ++y)
    for (int x = 0; x < foreground.size.width; ++x) {
      if (foreground.mask.at(x, y) != background::kForegroundPixel) continue;
      found += walker && walker->contains({x, y});
      wrong += !walker || !near.contains({x, y});
    }
  const auto area = static_cast<int>(walker ? walker->area() : 1);
  return {100 * found / area, 100.0 * wrong / static_cast<double>(foreground.size.area())};
}

/// From the left to the right in 60 frames.
inline Box walkerAt(int step) {
  return {8 + 2 * step, 40, 16, 44};
}

}  // namespace rg::test
