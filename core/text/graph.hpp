// SPDX-License-Identifier: LGPL-2.1-or-later
// The region graph as JSON lines: why regions were merged. One object a frame, as
// gst/regiongraph-graph.schema.json describes it.
#pragma once

#include "core/objects/objects.hpp"
#include "core/text/line.hpp"

#include <string>

namespace rg::text {

inline constexpr SchemaVersions kGraphSchema{"1.1", "1.2"};

/// Appends one line: the frame's energy, its regions in the order of their labels with what they
/// were expected to be and became, and its arcs with what each adds to the energy and whether it
/// was kept. Reads the result's sources: a result without them has no regions and no arcs.
/// Positions and motions are mapped to the frame of `stamp`; areas of regions too. Borders and
/// energies are those of the frame that was looked at.
void appendGraph(std::string& out, const objects::Objects& objects, const FrameStamp& stamp);

}  // namespace rg::text
