// SPDX-License-Identifier: LGPL-2.1-or-later
// What all JSON lines share: the head of a line, and pairs, boxes and colours as JSON.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/stage.hpp"
#include "core/graph/graph.hpp"
#include "core/text/line.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace rg::text {

inline constexpr int kJsonDecimals = 2;  ///< A hundredth of a pixel: finer than any is known.

void appendKey(std::string& out, std::string_view key);
/// Any UTF-8, escaped.
void appendText(std::string& out, std::string_view key, std::string_view text);
/// Only for words that need no escape.
void appendWord(std::string& out, std::string_view key, std::string_view word);
void appendNumber(std::string& out, std::string_view key, int64_t value);
/// value / unit with kJsonDecimals digits.
void appendReal(std::string& out, std::string_view key, int64_t value, int64_t unit);
/// {"x":…,"y":…} from values in 1/unit px.
void appendPair(std::string& out, std::string_view key, int64_t x, int64_t y, int64_t unit);
/// "x":…,"y":…,"w":…,"h":…
void appendBox(std::string& out, const Box& box);
/// "colour":"#rrggbb"
void appendColour(std::string& out, const graph::Colour& colour);
/// A comma, unless the list that `out` ends with has just been opened.
void appendComma(std::string& out);

/// The opened line up to "resolution".
void appendHead(std::string& out, Status status, const FrameStamp& stamp,
                const SchemaVersions& schema);

}  // namespace rg::text
