// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames with things in view, described by a few bytes.
#pragma once

#include "tests/fuzz/bytes.hpp"
#include "tests/support/harness.hpp"

#include <array>
#include <cstdint>

namespace rg::fuzz {

/// Textured squares that move over a textured ground, which may move as well.
class MovingScene {
 public:
  /// Without bytes: two things on a still ground.
  static MovingScene from(Bytes& bytes);

  /// Another frame later.
  void advance() { ++time_; }
  /// The level of a channel (0 … 2) at a place of a frame of some size.
  [[nodiscard]] uint8_t levelAt(int x, int y, int channel, int width, int height) const;

 private:
  struct Thing {
    int32_t x = 0, y = 0;    ///< In 1/256 of the frame.
    int32_t dx = 0, dy = 0;  ///< A frame, in 1/64 px.
    int32_t side = 40;       ///< In 1/256 of the frame's height.
    uint8_t level = 220, hue = 0;
    uint8_t texture = 15;
  };
  static constexpr size_t kMostThings = 12;

  std::array<Thing, kMostThings> things_{};
  size_t count_ = 2;
  uint8_t ground_ = 60, groundTexture_ = 7;
  uint8_t noise_ = 0;
  int8_t panX_ = 0, panY_ = 0;
  int time_ = 0;
};

/// A frame of the scene. No PTS is set.
[[nodiscard]] testing::BufferPtr paintScene(const MovingScene& scene, const GstVideoInfo& info);

}  // namespace rg::fuzz
