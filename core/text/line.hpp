// SPDX-License-Identifier: LGPL-2.1-or-later
// What the text formats share: the frame that a line is about, and numbers as text.
//
// Determinism: integers only, no locale: the same result gives the same bytes everywhere. All
// functions append; a string that is cleared and used again soon stops allocating.
#pragma once

#include "core/base/geometry.hpp"
#include "core/text/origin.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rg::text {

/// The frame that a result is written for.
struct FrameStamp {
  uint64_t number = 1;             ///< Counts from 1.
  Size size;                       ///< Of the frame now; coordinates are mapped to it.
  std::optional<uint64_t> ptsNs;   ///< Presentation time, nanoseconds.
  std::optional<uint64_t> utcNs;   ///< When it was taken, nanoseconds since 1970, if known.
  const Origin* origin = nullptr;  ///< Where it comes from, if that is to be told; not empty.
};

/// The versions of a schema that JSON lines name: the oldest one that describes the line.
struct SchemaVersions {
  std::string_view usual, withOrigin;
};

void appendInteger(std::string& out, int64_t value);
void appendUnsigned(std::string& out, uint64_t value);

/// numerator / denominator with `decimals` digits after the point (1 … 6), rounded to the nearest,
/// halves away from zero; zero has no sign. denominator > 0; |numerator| · 10^decimals < 2^63.
void appendFixed(std::string& out, int64_t numerator, int64_t denominator, int decimals);

/// value / 10^decimals, with `decimals` digits after the point (1 … 18); zero has no sign.
void appendDecimal(std::string& out, int64_t value, int decimals);

/// RFC 3339, in UTC with nanoseconds: 2026-11-21T11:25:00.000000000Z.
void appendUtc(std::string& out, uint64_t nsSince1970);

}  // namespace rg::text
