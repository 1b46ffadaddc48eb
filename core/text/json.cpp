// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/json.hpp"

#include "core/mapping.hpp"
#include "core/text/names.hpp"

#include <array>
#include <span>

namespace rg::text {
namespace {

constexpr int kDecimals = 2;  // A hundredth of a pixel: finer than any position is known.

void appendKey(std::string& out, std::string_view key) {
  out += '"';
  out += key;
  out += "\":";
}

/// Only for words that need no escape.
void appendWord(std::string& out, std::string_view key, std::string_view word) {
  appendKey(out, key);
  out += '"';
  out += word;
  out += '"';
}

void appendNumber(std::string& out, std::string_view key, int64_t value) {
  appendKey(out, key);
  appendInteger(out, value);
}

void appendIds(std::string& out, std::string_view key, std::span<const uint64_t> ids) {
  appendKey(out, key);
  out += '[';
  for (const uint64_t id : ids) {
    if (out.back() != '[') out += ',';
    appendUnsigned(out, id);
  }
  out += ']';
}

/// {"x":…,"y":…} from values in 1/16 px.
void appendPair(std::string& out, std::string_view key, int64_t x, int64_t y) {
  appendKey(out, key);
  out += "{\"x\":";
  appendFixed(out, x, kPositionUnit, kDecimals);
  out += ",\"y\":";
  appendFixed(out, y, kPositionUnit, kDecimals);
  out += '}';
}

void appendColour(std::string& out, const Colour& colour) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out += "\"colour\":\"#";
  for (const uint8_t channel : {colour.red, colour.green, colour.blue}) {
    out += kHex[channel >> 4];
    out += kHex[channel & 15];
  }
  out += '"';
}

void appendContour(std::string& out, std::span<const Point> contour, const FrameMap& map) {
  out += "\"contour\":[";
  for (const Point& point : contour) {
    const Point p = map.point(point);
    if (out.back() != '[') out += ',';
    out += '[';
    appendInteger(out, p.x);
    out += ',';
    appendInteger(out, p.y);
    out += ']';
  }
  out += ']';
}

void appendBox(std::string& out, const Box& box) {
  appendNumber(out, "x", box.x);
  out += ',';
  appendNumber(out, "y", box.y);
  out += ',';
  appendNumber(out, "w", box.width);
  out += ',';
  appendNumber(out, "h", box.height);
}

void appendObject(std::string& out, const Object& object, const FrameMap& map, Contours contours) {
  out += "{\"id\":";
  appendUnsigned(out, object.id);
  out += ',';
  appendWord(out, "state", name(object.state));
  out += ',';
  appendBox(out, map.box(object.box));
  out += ',';
  appendPair(out, "centroid", map.x(object.centroidX), map.y(object.centroidY));
  out += ',';
  appendNumber(out, "area", map.area(object.areaPx));
  out += ',';
  if (object.hasSpeed)
    appendPair(out, "velocity", map.x(object.speedX), map.y(object.speedY));
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

void appendEvent(std::string& out, const Event& event) {
  out += '{';
  appendWord(out, "type", name(event.kind));
  out += ',';
  appendIds(out, "ids", event.ids);
  out += '}';
}

void appendHead(std::string& out, const Objects& objects, const FrameStamp& stamp) {
  out += '{';
  appendWord(out, "schema", kJsonSchemaVersion);
  out += ",\"frame\":";
  appendUnsigned(out, stamp.number);
  out += ",\"pts\":";
  if (stamp.ptsNs)
    appendUnsigned(out, *stamp.ptsNs);
  else
    out += "null";
  if (stamp.utcNs) {
    out += ",\"utc\":\"";
    appendUtc(out, *stamp.utcNs);
    out += '"';
  }
  out += ',';
  appendWord(out, "status", name(objects.status));
  out += ",\"resolution\":{";
  appendNumber(out, "width", stamp.size.width);
  out += ',';
  appendNumber(out, "height", stamp.size.height);
  out += '}';
}

}  // namespace

void appendJson(std::string& out, const Objects& objects, const FrameStamp& stamp,
                Contours contours) {
  const FrameMap map = mapBetween(objects.size, stamp.size);
  appendHead(out, objects, stamp);
  out += ',';
  appendPair(out, "camera", map.x(objects.cameraDx), map.y(objects.cameraDy));
  out += ",\"objects\":[";
  for (const Object& object : objects.objects) {
    if (!isListed(object.state)) continue;
    if (out.back() != '[') out += ',';
    appendObject(out, object, map, contours);
  }
  out += "],\"events\":[";
  for (const Event& event : objects.events) {
    if (out.back() != '[') out += ',';
    appendEvent(out, event);
  }
  out += "]}\n";
}

}  // namespace rg::text
