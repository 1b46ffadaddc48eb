// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/json_parts.hpp"

#include "core/text/names.hpp"

namespace rg::text {

void appendKey(std::string& out, std::string_view key) {
  out += '"';
  out += key;
  out += "\":";
}

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

void appendReal(std::string& out, std::string_view key, int64_t value, int64_t unit) {
  appendKey(out, key);
  appendFixed(out, value, unit, kJsonDecimals);
}

void appendPair(std::string& out, std::string_view key, int64_t x, int64_t y, int64_t unit) {
  appendKey(out, key);
  out += '{';
  appendReal(out, "x", x, unit);
  out += ',';
  appendReal(out, "y", y, unit);
  out += '}';
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

void appendColour(std::string& out, const graph::Colour& colour) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out += "\"colour\":\"#";
  for (const uint8_t channel : {colour.red, colour.green, colour.blue}) {
    out += kHex[channel >> 4];
    out += kHex[channel & 15];
  }
  out += '"';
}

void appendComma(std::string& out) {
  if (out.back() != '[') out += ',';
}

void appendHead(std::string& out, Status status, const FrameStamp& stamp, std::string_view schema) {
  out += '{';
  appendWord(out, "schema", schema);
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
  appendWord(out, "status", name(status));
  out += ",\"resolution\":{";
  appendNumber(out, "width", stamp.size.width);
  out += ',';
  appendNumber(out, "height", stamp.size.height);
  out += '}';
}

}  // namespace rg::text
