// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/json.hpp"

#include "core/base/camera/camera_place.hpp"
#include "core/base/mapping.hpp"
#include "core/text/json_parts.hpp"
#include "core/text/names.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace rg::text {
namespace {

void appendIds(std::string& out, std::string_view key, std::span<const uint64_t> ids) {
  appendKey(out, key);
  out += '[';
  for (const uint64_t id : ids) {
    appendComma(out);
    appendUnsigned(out, id);
  }
  out += ']';
}

void appendContour(std::string& out, std::span<const Point> contour, const FrameMap& map) {
  out += "\"contour\":[";
  for (const Point& point : contour) {
    const Point p = map.point(point);
    appendComma(out);
    out += '[';
    appendInteger(out, p.x);
    out += ',';
    appendInteger(out, p.y);
    out += ']';
  }
  out += ']';
}

void appendObject(std::string& out, const objects::Object& object, const FrameMap& map,
                  Contours contours) {
  out += "{\"id\":";
  appendUnsigned(out, object.id);
  out += ',';
  appendWord(out, "state", name(object.state));
  out += ',';
  appendBox(out, map.box(object.box));
  out += ',';
  appendPair(out, "centroid", map.x(object.centroidX), map.y(object.centroidY),
             objects::kPositionUnit);
  out += ',';
  appendNumber(out, "area", map.area(object.areaPx));
  out += ',';
  if (object.hasSpeed)
    appendPair(out, "velocity", map.x(object.speedX), map.y(object.speedY), objects::kPositionUnit);
  else
    out += "\"velocity\":null";
  out += ',';
  appendNumber(out, "age", object.ageFrames);
  out += ',';
  appendColour(out, object.colour);
  out += ',';
  appendIds(out, "parents", object.parents);
  if (contours == Contours::Write) {
    out += ',';
    appendContour(out, object.contour, map);
  }
  out += '}';
}

void appendEvent(std::string& out, const objects::Event& event) {
  out += '{';
  appendWord(out, "type", name(event.kind));
  out += ',';
  appendIds(out, "ids", event.ids);
  out += '}';
}

/// Row by row, as fine as CameraMotion's own numbers are.
void appendMatrix(std::string& out, const CameraMotion& camera) {
  constexpr int kDecimals = 9;
  constexpr double kUnit = 1e9, kLargest = 9e9;  // 9e9 · 1e9 < 2^63
  appendKey(out, "matrix");
  out += '[';
  for (const double value : matrixOf(camera)) {
    appendComma(out);
    appendDecimal(out, std::llround(std::clamp(value, -kLargest, kLargest) * kUnit), kDecimals);
  }
  out += ']';
}

void appendCamera(std::string& out, const objects::Objects& objects, const CameraMotion& camera,
                  const FrameMap& map) {
  appendPair(out, "camera", map.x(objects.cameraDx), map.y(objects.cameraDy),
             objects::kPositionUnit);
  if (camera.isUniform()) return;
  out.back() = ',';
  appendMatrix(out, camera);
  out += '}';
}

}  // namespace

void appendJson(std::string& out, const objects::Objects& objects, const FrameStamp& stamp,
                Contours contours) {
  const FrameMap map = mapBetween(objects.size, stamp.size);
  const CameraMotion camera = moved(objects.camera, wayAlong(map));
  appendHead(out, objects.status, stamp, camera.isUniform() ? kJsonSchema : kJsonSchemaWithMatrix);
  out += ',';
  appendCamera(out, objects, camera, map);
  out += ",\"objects\":[";
  for (const objects::Object& object : objects.objects) {
    if (!objects::isListed(object.state)) continue;
    appendComma(out);
    appendObject(out, object, map, contours);
  }
  out += "],\"events\":[";
  for (const objects::Event& event : objects.events) {
    appendComma(out);
    appendEvent(out, event);
  }
  out += "]}\n";
}

}  // namespace rg::text
