// SPDX-License-Identifier: LGPL-2.1-or-later
// Objects as GstAnalytics knows them, for readers that don't know this plugin; nothing before
// GStreamer 1.24 (no_detections.cpp).
#pragma once

#include "core/objects/objects.hpp"

#include <gst/gst.h>

#include <vector>

namespace rg {

/// Attaches to each frame a relation meta: for each object a detection that relates to a tracking,
/// which has the object's number and the time when it was first seen.
class Detections {
 public:
  void begin(GstBuffer* buffer, const objects::Objects& objects);
  void add(const objects::Object& object, GQuark type, const Box& box);
  /// What a region of interest that tells the same object is to have as its id: that of the
  /// detection, by which DL Streamer looks it up, or the object's number where there are none;
  /// never 0, which is: not on this frame.
  [[nodiscard]] gint idOf(uint64_t number) const;

 private:
  struct Seen {
    uint64_t number;
    GstClockTime first;
    gint detection;  ///< On this frame; 0 also where there is none.
  };

  /// By number: of all objects that live, told or not.
  std::vector<Seen> seen_, next_;
  /// That gets detections; null also where there is no memory or no GstAnalytics for them.
  [[maybe_unused]] GstBuffer* buffer_ = nullptr;
};

/// Adds a detection by itself; its number on this frame, which may be 0, or 0 where there are none.
gint addDetection(GstBuffer* buffer, GQuark type, const Box& box);

/// Adds a class to a detection of this frame, which contains it, as DL Streamer has them.
void addClassification(GstBuffer* buffer, gint detection, const char* label);

}  // namespace rg
