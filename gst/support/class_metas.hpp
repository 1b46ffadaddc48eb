// SPDX-License-Identifier: LGPL-2.1-or-later
// What a detector says objects are, for readers that don't know this plugin.
#pragma once

#include "core/detection/detection.hpp"

#include <gst/video/video.h>

#include <string>

namespace rg {

/// Who says it.
struct DetectorNames {
  std::string label;  ///< The class.
  std::string model;
};

/// What becomes of detections that are none of the objects.
enum class Unmatched { Dropped, Added };

/// A detection belongs to the object (a region of interest of type "object") in which its centre
/// lies, of several to the one that has the greatest share of it; of several detections of an
/// object the one with the most windows counts. Adds to that object's meta a structure
/// "classification" as DL Streamer writes them, with the box as shares of the frame, and to its
/// GstAnalytics detection, where there is one, a classification. Others get a region of their own,
/// of the class's type. Returns how many objects have the class.
size_t addClasses(GstBuffer* buffer, const GstVideoInfo& info,
                  const detection::Detections& detections, const DetectorNames& names,
                  Unmatched unmatched);

}  // namespace rg
