// SPDX-License-Identifier: LGPL-2.1-or-later
// Results by hand, for the elements that write, show and draw them.
#pragma once

#include "core/objects/objects.hpp"
#include "gst/meta/result_meta.hpp"

#include <memory>
#include <utility>

namespace rg::testing {

/// An object that fills its box and moves 16 px/s to the right.
inline objects::Object object(uint64_t id, const Box& box,
                              objects::ObjectState state = objects::ObjectState::Tracked) {
  objects::Object object;
  object.id = id;
  object.state = state;
  object.box = box;
  object.areaPx = static_cast<uint32_t>(box.area());
  object.centroidX = objects::kPositionUnit * (2 * box.x + box.width) / 2;
  object.centroidY = objects::kPositionUnit * (2 * box.y + box.height) / 2;
  object.speedX = 16 * objects::kPositionUnit;
  object.hasSpeed = true;
  object.ageFrames = 1;
  object.contour = {{box.x, box.y},
                    {box.right() - 1, box.y},
                    {box.right() - 1, box.bottom() - 1},
                    {box.x, box.bottom() - 1}};
  return object;
}

inline std::shared_ptr<objects::Objects> objects(Size size, std::vector<objects::Object> list) {
  auto result = std::make_shared<objects::Objects>();
  result->size = size;
  result->status = Status::Ok;
  result->slots.resize(size);
  result->slots.fill(0);
  for (size_t i = 0; i < list.size(); ++i) {
    const Box visible = intersect(list[i].box, boundsOf(size));
    for (int y = visible.y; y < visible.bottom(); ++y)
      for (int x = visible.x; x < visible.right(); ++x)
        result->slots.at(x, y) = objects::Slot::ofIndex(i).number();
  }
  result->objects = std::move(list);
  return result;
}

/// Two regions side by side, each half of the frame, that touch; label 1 is left and red.
inline std::shared_ptr<graph::Graph> graph(Size size) {
  const int half = size.width / 2;
  auto result = std::make_shared<graph::Graph>();
  result->size = size;
  result->status = Status::Ok;
  const auto area = static_cast<uint32_t>(half * size.height);
  result->regions = {
      {area, {0, 0, half, size.height}, 128 * (half - 1), 128 * (size.height - 1), {255, 0, 0}},
      {area,
       {half, 0, half, size.height},
       128 * (3 * half - 1),
       128 * (size.height - 1),
       {0, 0, 255}}};
  result->arcs = {{segmentation::RegionLabel::ofIndex(0), segmentation::RegionLabel::ofIndex(1),
                   static_cast<uint32_t>(size.height), 255}};
  return result;
}

inline std::shared_ptr<background::Foreground> foreground(Size size, const Box& box) {
  auto result = std::make_shared<background::Foreground>();
  result->size = size;
  result->status = Status::Ok;
  result->mask.resize(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      result->mask.at(x, y) = box.contains({x, y})                ? background::kForegroundPixel
                              : box.contains({x, y - box.height}) ? background::kShadowPixel
                                                                  : background::kBackgroundPixel;
  result->areas = {box};
  return result;
}

}  // namespace rg::testing
