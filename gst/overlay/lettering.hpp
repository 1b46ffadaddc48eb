// SPDX-License-Identifier: LGPL-2.1-or-later
// One line of text: by OpenCV's own strokes where it is plain ASCII, which needs no font on the
// machine, and by Pango where it is anything else.
#pragma once

#include "core/base/geometry.hpp"
#include "core/graph/graph.hpp"
#include "gst/overlay/style.hpp"

#include <opencv2/core.hpp>

#include <string>

namespace rg::overlay {

/// What the line takes up. Bytes that are no UTF-8 count as the sign for those.
[[nodiscard]] Size letteringSize(const std::string& text, const Style& style);

/// Draws the line into pixels B, G, R, A, colours multiplied by alpha; `corner` is its left upper
/// one.
void drawLettering(cv::Mat& pixels, cv::Point corner, const std::string& text, const Style& style,
                   const graph::Colour& colour);

}  // namespace rg::overlay
