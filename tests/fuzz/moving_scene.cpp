// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/fuzz/moving_scene.hpp"

#include "core/base/pixel.hpp"

#include <cstdlib>

namespace rg::fuzz {
namespace {

constexpr int kFractions = 256, kSpeedUnit = 64;

uint32_t hashAt(int x, int y, int what) {
  return mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(what));
}

uint8_t levelOf(int value) {
  return static_cast<uint8_t>(std::clamp(value, 0, 255));
}

}  // namespace

MovingScene MovingScene::from(Bytes& bytes) {
  MovingScene scene;
  scene.things_[0] = {40, 90, 64, 0, 60, 220, 0, 15};
  scene.things_[1] = {180, 120, -48, 16, 50, 30, 1, 15};
  if (bytes.isEmpty()) return scene;
  scene.count_ = bytes.between<size_t>(0, kMostThings);
  for (size_t i = 0; i < scene.count_; ++i) {
    Thing& thing = scene.things_[i];
    thing.x = bytes.take();
    thing.y = bytes.take();
    thing.dx = bytes.take<int8_t>();
    thing.dy = bytes.take<int8_t>();
    thing.side = bytes.take();
    thing.level = bytes.take();
    thing.hue = bytes.take();
    thing.texture = bytes.take();
  }
  scene.ground_ = bytes.take();
  scene.groundTexture_ = bytes.take();
  scene.noise_ = bytes.take();
  scene.panX_ = bytes.take<int8_t>();
  scene.panY_ = bytes.take<int8_t>();
  return scene;
}

uint8_t MovingScene::levelAt(int x, int y, int channel, int width, int height) const {
  const int noise =
      noise_ == 0 ? 0 : static_cast<int>(hashAt(x, y, time_ * 3 + channel)) % (noise_ + 1);
  for (size_t i = 0; i < count_; ++i) {
    const Thing& thing = things_[i];
    const int side = std::max(1, thing.side * height / kFractions);
    const int atX = x - (thing.x * width / kFractions + thing.dx * time_ / kSpeedUnit);
    const int atY = y - (thing.y * height / kFractions + thing.dy * time_ / kSpeedUnit);
    if (atX < 0 || atY < 0 || atX >= side || atY >= side) continue;
    const int texture = static_cast<int>(hashAt(atX, atY, static_cast<int>(i)) % 256);
    const int colour = thing.hue % 3 == channel ? 40 : 0;
    return levelOf(thing.level + colour + (texture & thing.texture) + std::abs(noise));
  }
  const int groundX = x - panX_ * time_ / 8, groundY = y - panY_ * time_ / 8;
  const int texture = static_cast<int>(hashAt(groundX / 3, groundY / 3, 99) % 256);
  return levelOf(ground_ + (texture & groundTexture_) + std::abs(noise));
}

testing::BufferPtr paintScene(const MovingScene& scene, const GstVideoInfo& info) {
  testing::BufferPtr buffer(gst_buffer_new_allocate(nullptr, info.size, nullptr));
  gst_buffer_memset(buffer.get(), 0, 128, info.size);
  GstVideoFrame frame;
  if (!gst_video_frame_map(&frame, &info, buffer.get(), GST_MAP_WRITE)) std::abort();
  const int width = GST_VIDEO_INFO_WIDTH(&info), height = GST_VIDEO_INFO_HEIGHT(&info);
  for (guint c = 0; c < GST_VIDEO_INFO_N_COMPONENTS(&info); ++c) {
    const int across = std::max(1, width / GST_VIDEO_FRAME_COMP_WIDTH(&frame, c));
    const int down = std::max(1, height / GST_VIDEO_FRAME_COMP_HEIGHT(&frame, c));
    for (int y = 0; y < GST_VIDEO_FRAME_COMP_HEIGHT(&frame, c); ++y)
      for (int x = 0; x < GST_VIDEO_FRAME_COMP_WIDTH(&frame, c); ++x)
        testing::putSample(frame, c, x, y,
                           scene.levelAt(x * across, y * down, static_cast<int>(c), width, height));
  }
  gst_video_frame_unmap(&frame);
  return buffer;
}

}  // namespace rg::fuzz
