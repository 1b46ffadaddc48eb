// SPDX-License-Identifier: LGPL-2.1-or-later
// Built where GStreamer has no GstAnalytics.
#include "gst/support/detections.hpp"

namespace rg {

void Detections::begin(GstBuffer*, const objects::Objects&) {}

void Detections::add(const objects::Object&, GQuark, const Box&) {}

gint Detections::idOf(uint64_t number) const {
  return static_cast<gint>(number);
}

gint addDetection(GstBuffer*, GQuark, const Box&) {
  return 0;
}

void addClassification(GstBuffer*, gint, const char*) {}

}  // namespace rg
