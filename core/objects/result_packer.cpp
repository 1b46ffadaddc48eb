// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/result_packer.hpp"

#include "core/base/camera/camera_place.hpp"
#include "core/base/memory/spare.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace rg::objects {
namespace {

constexpr int kCentroidUnit = 256;  ///< Of regions.

/// Speeds may leave the range where frames are much larger than the picture.
int32_t narrowed(int64_t value) {
  using Limits = std::numeric_limits<int32_t>;
  return static_cast<int32_t>(std::clamp<int64_t>(value, Limits::min(), Limits::max()));
}
uint32_t areaIn(const FrameMap& map, uint32_t areaPx) {
  return static_cast<uint32_t>(std::clamp<int64_t>(map.area(areaPx), areaPx > 0, UINT32_MAX));
}

void moveTo(const FrameMap& map, graph::Region& region) {
  region.areaPx = areaIn(map, region.areaPx);
  region.box = map.box(region.box);
  region.centroidX = narrowed(map.centreX(region.centroidX, kCentroidUnit));
  region.centroidY = narrowed(map.centreY(region.centroidY, kCentroidUnit));
}

void moveTo(const FrameMap& map, Object& object) {
  object.areaPx = areaIn(map, object.areaPx);
  object.box = map.box(object.box);
  object.centroidX = narrowed(map.centreX(object.centroidX, kPositionUnit));
  object.centroidY = narrowed(map.centreY(object.centroidY, kPositionUnit));
  object.speedX = narrowed(map.x(object.speedX));
  object.speedY = narrowed(map.y(object.speedY));
  for (Point& point : object.contour)
    point = {static_cast<int>(map.centreX(point.x, 1)), static_cast<int>(map.centreY(point.y, 1))};
}

}  // namespace

void ResultPacker::endFrame() {
  std::apply([](auto&... shelf) { (shelf.made.clear(), ...); }, shelves_);
}

void ResultPacker::drop() {
  std::apply([](auto&... shelf) { (shelf.drop(), ...); }, shelves_);
}

void ResultPacker::fill(const background::Foreground& from, background::Foreground& to) {
  const FrameMap map = mapOf(from.size);
  to.size = map.to;
  to.status = from.status;
  to.picture = nullptr;
  planes_.pack(from.mask, to.mask, map.to);
  to.extent = map.box(from.extent);
  copyTight(from.areas, to.areas);
  to.interest = from.interest;
  to.scene = from.scene;
  if (map.from == map.to) return;
  for (Box& area : to.areas) area = map.box(area);
  to.scene.foregroundPx = areaIn(map, from.scene.foregroundPx);
  to.scene.shift = map.point(from.scene.shift);
}

void ResultPacker::fill(const segmentation::Labels& from, segmentation::Labels& to) {
  to.size = mapOf(from.size).to;
  to.status = from.status;
  to.scope = from.scope;
  to.picture = nullptr;
  to.foreground = pack(from.foreground);
  planes_.pack(from.ids, to.ids, to.size);
  planes_.pack(from.hue, to.hue, to.size);
  to.count = from.count;
}

void ResultPacker::fill(const graph::Graph& from, graph::Graph& to) {
  const FrameMap map = mapOf(from.size);
  to.size = map.to;
  to.status = from.status;
  to.labels = pack(from.labels);
  copyTight(from.regions, to.regions);
  copyTight(from.arcs, to.arcs);
  to.runs = {};
  if (map.from == map.to) return;
  for (graph::Region& region : to.regions) moveTo(map, region);
}

void ResultPacker::fill(const motion::Motion& from, motion::Motion& to) {
  const FrameMap map = mapOf(from.size);
  to.size = map.to;
  to.status = from.status;
  to.graph = pack(from.graph);
  copyTight(from.regions, to.regions);
  to.matchedBlocks = from.matchedBlocks;
  to.stillBlocks = from.stillBlocks;
  if (map.from == map.to) return;
  for (motion::RegionMotion& region : to.regions) {
    region.dx = narrowed(map.x(region.dx));
    region.dy = narrowed(map.y(region.dy));
  }
}

void ResultPacker::fill(const Objects& from, Objects& to) {
  const FrameMap map = mapOf(from.size);
  to.copyTables(from);
  to.size = map.to;
  to.motion = pack(from.motion);
  planes_.pack(from.slots, to.slots, map.to);
  if (map.from == map.to) return;
  for (Object& object : to.objects) moveTo(map, object);
  to.camera = moved(from.camera, wayAlong(map));
  to.cameraDx = narrowed(map.x(from.cameraDx));
  to.cameraDy = narrowed(map.y(from.cameraDy));
}

}  // namespace rg::objects
