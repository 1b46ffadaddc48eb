// SPDX-License-Identifier: LGPL-2.1-or-later
// Objects as GstVideoRegionOfInterestMeta, for readers that don't know this plugin.
#pragma once

#include "core/objects/objects.hpp"
#include "gst/support/detections.hpp"

#include <gst/video/video.h>

namespace rg {

class RoiMetas {
 public:
  /// Adds one meta of type "object" for each object that is tracked, stopped or occluded, clipped
  /// to the frame, as DL Streamer writes them. Its param "object_id" is the object's number, its
  /// param "detection" the box in shares of the frame; its id is Detections::idOf().
  void add(GstBuffer* buffer, const GstVideoInfo& info, const objects::Objects& objects);

 private:
  Detections detections_;
};

}  // namespace rg
