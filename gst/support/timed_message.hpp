// SPDX-License-Identifier: LGPL-2.1-or-later
// Element messages that say when the frame is that they tell of.
#pragma once

#include "gst/support/origin.hpp"

#include <gst/base/gstbasetransform.h>

#include <cstdint>
#include <optional>

namespace rg {

/// When a frame is shown, when it was taken, and where.
struct FrameMoment {
  GstClockTime pts = GST_CLOCK_TIME_NONE;
  std::optional<uint64_t> utcNs;
  OriginPtr origin;
};
[[nodiscard]] FrameMoment momentOf(GstBuffer* frame, OriginPtr origin);

/// Posts in the element's name, with pts, stream-time and running-time added, and with utc where
/// the stream tells it, source and tags where they are set. Takes the structure.
void postTimedMessage(GstBaseTransform* element, GstDebugCategory* category,
                      const FrameMoment& moment, GstStructure* fields);

}  // namespace rg
