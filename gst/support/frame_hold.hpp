// SPDX-License-Identifier: LGPL-2.1-or-later
// How many frames an element may hold back.
#pragma once

#include <gst/video/video.h>

namespace rg {

/// Held frames are bounded whatever latency and framerate say. The bytes are those of the frames
/// and of what the stages attach to them.
inline constexpr guint64 kMostHeldFrames = 600;
inline constexpr guint64 kMostHeldBytes = guint64{2} << 30;

/// What each region adds to bytesOfFrame(), measured at 65535 regions.
inline constexpr guint64 kResultBytesPerRegion = 200;

/// A frame with what the stages attach to it, but for its regions.
[[nodiscard]] guint64 bytesOfFrame(const GstVideoInfo& info);

/// Frames that come in a time, rounded up; 0 where the caps don't tell their rate.
[[nodiscard]] guint64 framesIn(GstClockTime time, const GstVideoInfo& info);

/// How many frames of these caps may be held at once: 1 at least.
[[nodiscard]] guint64 mostHeldFrames(const GstVideoInfo& info);

/// A frame leaves when the first one comes that is later by the latency.
[[nodiscard]] GstClockTime latencyInFrames(GstClockTime latency, const GstVideoInfo& info);

/// Asks the pools that downstream offers for `frames` more buffers each.
void raisePools(GstQuery* allocation, guint frames);

}  // namespace rg
