// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/json_parts.hpp"

#include "core/text/names.hpp"

namespace rg::text {
namespace {

constexpr std::string_view kHexDigits = "0123456789abcdef";

void appendOrigin(std::string& out, const Origin& origin) {
  if (!origin.source.empty()) {
    out += ',';
    appendText(out, "source", origin.source);
  }
  if (origin.tags.empty()) return;
  out += ",\"tags\":{";
  for (const auto& [key, value] : origin.tags) {
    appendText(out, key, value);
    out += ',';
  }
  out.back() = '}';
}

}  // namespace

void appendKey(std::string& out, std::string_view key) {
  out += '"';
  out += key;
  out += "\":";
}

void appendText(std::string& out, std::string_view key, std::string_view text) {
  appendKey(out, key);
  out += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += "\\u00";
      out += kHexDigits[static_cast<size_t>(c) >> 4];
      out += kHexDigits[static_cast<size_t>(c) & 15];
    } else {
      out += c;
    }
  }
  out += '"';
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
  out += "\"colour\":\"#";
  for (const uint8_t channel : {colour.red, colour.green, colour.blue}) {
    out += kHexDigits[channel >> 4];
    out += kHexDigits[channel & 15];
  }
  out += '"';
}

void appendComma(std::string& out) {
  if (out.back() != '[') out += ',';
}

void appendHead(std::string& out, Status status, const FrameStamp& stamp,
                const SchemaVersions& schema) {
  out += '{';
  appendWord(out, "schema", stamp.origin ? schema.withOrigin : schema.usual);
  if (stamp.origin) appendOrigin(out, *stamp.origin);
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
