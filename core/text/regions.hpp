// SPDX-License-Identifier: LGPL-2.1-or-later
// CSV of regions: a header, then a line for each region of each frame.
#pragma once

#include "core/graph/graph.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/objects.hpp"
#include "core/text/line.hpp"

#include <string>
#include <string_view>

namespace rg::text {

inline constexpr std::string_view kRegionsHeader =
    "frame,id,area,x,y,w,h,cx,cy,dx,dy,reliability,object\n";

/// What is known of a frame's regions. Without motion the vectors are 0 with reliability 0; without
/// objects the last column is 0.
struct RegionSources {
  const graph::Graph* graph = nullptr;  ///< Never null.
  const motion::Motion* motion = nullptr;
  const objects::Objects* objects = nullptr;
};

/// Appends one line for each region in the order of their labels. id is the label, dx and dy are
/// pixels since the previous frame, reliability 0 … 1, object 0 means none.
void appendRegions(std::string& out, const RegionSources& sources, const FrameStamp& stamp);

}  // namespace rg::text
