// SPDX-License-Identifier: LGPL-2.1-or-later
// What of each result is stored, in this order: the archive writes or reads what it is called with.
#pragma once

#include "core/objects/objects.hpp"

#include <concepts>
#include <type_traits>

namespace rg {

template <class T, class Value>
concept Like = std::same_as<std::remove_const_t<T>, Value>;

template <class Archive, Like<Point> T>
void pass(Archive& archive, T& point) {
  archive(point.x, point.y);
}
template <class Archive, Like<Size> T>
void pass(Archive& archive, T& size) {
  archive(size.width, size.height);
}
template <class Archive, Like<Box> T>
void pass(Archive& archive, T& box) {
  archive(box.x, box.y, box.width, box.height);
}
template <class Archive, Like<graph::Colour> T>
void pass(Archive& archive, T& colour) {
  archive(colour.red, colour.green, colour.blue);
}
template <class Archive, Like<CameraMotion> T>
void pass(Archive& archive, T& camera) {
  CameraMotion::Matrix matrix = camera.matrix();
  Point origin = camera.origin();
  for (int64_t& number : matrix) archive(number);
  archive(origin);
  if constexpr (!std::is_const_v<T>) camera = CameraMotion(matrix, origin);
}

template <class Archive, Like<background::Foreground> T>
void pass(Archive& archive, T& result) {
  archive(result.size, result.status, result.mask, result.extent, result.areas, result.scene.event,
          result.scene.foregroundPx, result.scene.isDark, result.scene.isCameraMoving,
          result.scene.shift);
}

template <class Archive, Like<segmentation::Labels> T>
void pass(Archive& archive, T& result) {
  archive(result.size, result.status, result.scope, result.ids, result.hue, result.count);
}

template <class Archive, Like<graph::Region> T>
void pass(Archive& archive, T& region) {
  archive(region.areaPx, region.box, region.centroidX, region.centroidY, region.colour);
}
template <class Archive, Like<graph::Arc> T>
void pass(Archive& archive, T& arc) {
  archive(arc.a, arc.b, arc.borderPx, arc.contrast);
}
template <class Archive, Like<graph::Graph> T>
void pass(Archive& archive, T& result) {
  archive(result.size, result.status, result.regions, result.arcs);
}

template <class Archive, Like<motion::RegionMotion> T>
void pass(Archive& archive, T& region) {
  archive(region.dx, region.dy, region.sad, region.reliability);
}
template <class Archive, Like<motion::Motion> T>
void pass(Archive& archive, T& result) {
  archive(result.size, result.status, result.regions, result.matchedBlocks, result.stillBlocks);
}

template <class Archive, Like<objects::Object> T>
void pass(Archive& archive, T& object) {
  archive(object.id, object.state, object.box, object.areaPx, object.centroidX, object.centroidY,
          object.speedX, object.speedY, object.hasSpeed, object.ageFrames, object.colour,
          object.parents, object.contour);
}
template <class Archive, Like<objects::Event> T>
void pass(Archive& archive, T& event) {
  archive(event.kind, event.ids);
}
template <class Archive, Like<objects::ArcEnergy> T>
void pass(Archive& archive, T& energy) {
  archive(energy.motion, energy.border, energy.arc, energy.prediction);
}
template <class Archive, Like<objects::GroundEnergy> T>
void pass(Archive& archive, T& energy) {
  archive(energy.motion, energy.prediction);
}
template <class Archive, Like<objects::Objects> T>
void pass(Archive& archive, T& result) {
  archive(result.size, result.status, result.objects, result.slots, result.regionObject,
          result.regionExpected, result.regionGroup, result.arcs, result.groundGroup, result.ground,
          result.isCutShort, result.camera, result.cameraDx, result.cameraDy, result.events);
}

/// The last value of each enum.
constexpr int lastOf(Status) {
  return static_cast<int>(Status::Skipped);
}
constexpr int lastOf(background::SceneEvent) {
  return static_cast<int>(background::SceneEvent::CameraStopped);
}
constexpr int lastOf(segmentation::Scope) {
  return static_cast<int>(segmentation::Scope::Areas);
}
constexpr int lastOf(objects::ObjectState) {
  return static_cast<int>(objects::ObjectState::Lost);
}
constexpr int lastOf(objects::EventKind) {
  return static_cast<int>(objects::EventKind::SceneChanged);
}

}  // namespace rg
