// SPDX-License-Identifier: LGPL-2.1-or-later
// When a frame was taken, as its source says.
#pragma once

#include <gst/gst.h>

#include <cstdint>
#include <optional>

namespace rg {

/// Nanoseconds since 1970, from a GstReferenceTimestampMeta in UNIX or NTP time (as rtspsrc's
/// add-reference-timestamp-meta attaches it); none without one. The clock of this machine is never
/// asked.
[[nodiscard]] std::optional<uint64_t> captureTimeOf(GstBuffer* buffer);

}  // namespace rg
