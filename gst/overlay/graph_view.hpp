// SPDX-License-Identifier: LGPL-2.1-or-later
// The region graph, and what its regions do where no object speaks for them.
#pragma once

#include "gst/overlay/canvas.hpp"

namespace rg::overlay {

struct Scene;
struct Views;

/// Whether drawGraphView() has anything to draw.
[[nodiscard]] bool hasGraphView(const Scene& scene, const Views& views);

/// views.graph: a node in its mean colour for each region, ringed in its object's colour, a line
/// for each pair that touches, in the object's colour where both belong to one. views.vectors
/// without mrfmerge: an arrow for each region, as long as the way of half a second.
void drawGraphView(const Scene& scene, const Views& views, Canvas& canvas);

}  // namespace rg::overlay
