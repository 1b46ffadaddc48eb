// SPDX-License-Identifier: LGPL-2.1-or-later
// JSON lines: one object a frame, as gst/regiongraph.schema.json describes it.
#pragma once

#include "core/objects/objects.hpp"
#include "core/text/line.hpp"

#include <string>

namespace rg::text {

/// Changes with the schema: the second number when fields are added, the first when one changes.
inline constexpr SchemaVersions kJsonSchema{"1.0", "1.1"};
inline constexpr SchemaVersions kJsonSchemaWithMatrix{"1.2", "1.2"};

enum class Contours : uint8_t { Omit, Write };

/// Appends one line. Objects in the order of their ids, those of isListed() states only.
/// The camera has a matrix where the background does not move alike everywhere.
/// Keys x, y, w, h, id and resolution mean what they mean in DL Streamer's JSON.
void appendJson(std::string& out, const objects::Objects& objects, const FrameStamp& stamp,
                Contours contours);

}  // namespace rg::text
