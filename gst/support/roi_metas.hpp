// SPDX-License-Identifier: LGPL-2.1-or-later
// Objects as GstVideoRegionOfInterestMeta, for readers that don't know this plugin.
#pragma once

#include "core/objects/objects.hpp"

#include <gst/video/video.h>

namespace rg {

/// Adds one meta of type "object" for each object that is tracked, stopped or occluded, clipped to
/// the frame. Its id and its param "object_id" are the object's number, its param "detection" the
/// box in shares of the frame, as DL Streamer writes them.
void addRoiMetas(GstBuffer* buffer, const GstVideoInfo& info, const objects::Objects& objects);

}  // namespace rg
