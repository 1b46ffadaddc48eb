// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames of rectangles for stage 5.
#pragma once

#include "core/objects/objects.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace rg {

constexpr int64_t kStepNs = 40'000'000;

struct Body {
  Box box;
  graph::Colour colour;
};

/// Frames of rectangles on an empty background, as the stages before hand them on: each colour that
/// is seen is a region, later bodies cover earlier ones.
class BodyScene {
 public:
  explicit BodyScene(Size size = {320, 240},
                     segmentation::Scope scope = segmentation::Scope::Foreground)
      : size_(size), scope_(scope) {}

  std::shared_ptr<const objects::Objects> show(
      const std::vector<Body>& bodies, const std::vector<motion::RegionMotion>& motions = {}) {
    auto picture = std::make_shared<Picture>();
    auto labels = std::make_shared<segmentation::Labels>();
    labels->size = size_;
    labels->status = Status::Ok;
    labels->scope = scope_;
    labels->ids.resize(size_);
    labels->ids.fill(0);
    std::vector<uint8_t> pixels(static_cast<size_t>(size_.area()) * 3, 90);
    for (size_t i = 0; i < bodies.size(); ++i)
      paint(bodies[i], static_cast<uint16_t>(i + 1), labels->ids, pixels);
    const PlaneMemory plane{pixels.data(), pixels.size(), size_.width * 3};
    picture->load(*Frame::make({PixelFormat::Rgb, size_}, std::span(&plane, 1)), Executor(1));
    labels->picture = picture;
    // Labels count without gaps: a body that can't be seen has none.
    std::vector<uint16_t> labelOf(bodies.size() + 1, 0);
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x) labelOf[labels->ids.at(x, y)] = 1;
    labelOf[0] = 0;
    std::vector<motion::RegionMotion> seen;
    for (size_t i = 1; i < labelOf.size(); ++i) {
      if (labelOf[i] == 0) continue;
      labelOf[i] = static_cast<uint16_t>(++labels->count);
      seen.push_back(i <= motions.size() ? motions[i - 1] : motion::RegionMotion{});
    }
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x) labels->ids.at(x, y) = labelOf[labels->ids.at(x, y)];
    const Context context{std::make_shared<const Executor>(1), nullptr};
    auto motion = std::make_shared<motion::Motion>();
    motion->size = size_;
    motion->status = Status::Ok;
    motion->graph = *graph::makeStage(context)->process(labels, {});
    motion->regions = seen;
    // The first body is the ground, where all of the frame has regions.
    if (scope_ == segmentation::Scope::Frame && !motions.empty())
      motion->camera = camera.value_or(CameraMotion(Point{motions[0].dx, motions[0].dy}));
    return process(motion);
  }
  std::shared_ptr<const objects::Objects> skip() {
    auto motion = std::make_shared<motion::Motion>();
    motion->size = size_;
    return process(motion);
  }
  objects::Stage& stage() { return *stage_; }
  void wait(int64_t ns) { time_.ns += ns; }
  void forgetTime() { time_.isKnown = false; }
  // Of the frames to come:
  objects::Params params;
  std::optional<CameraMotion> camera;  ///< None: as the ground's region moves.

 private:
  static void paint(const Body& body, uint16_t label, Image<uint16_t>& ids,
                    std::vector<uint8_t>& pixels) {
    const Box box = intersect(body.box, boundsOf(ids.size()));
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x) {
        ids.at(x, y) = label;
        uint8_t* pixel = pixels.data() + 3 * (y * ids.width() + x);
        pixel[0] = body.colour.red;
        pixel[1] = body.colour.green;
        pixel[2] = body.colour.blue;
      }
  }
  std::shared_ptr<const objects::Objects> process(std::shared_ptr<const motion::Motion> motion) {
    auto result = stage_->process(std::move(motion), params, time_);
    EXPECT_TRUE(result);
    time_.ns += kStepNs;
    return *result;
  }
  Size size_;
  segmentation::Scope scope_;
  FrameTime time_{0, true};
  std::unique_ptr<objects::Stage> stage_ =
      objects::makeStage({std::make_shared<const Executor>(1), nullptr});
};

}  // namespace rg
