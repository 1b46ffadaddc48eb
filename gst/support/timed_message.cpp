// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/timed_message.hpp"

#include "core/text/text.hpp"
#include "gst/support/capture_time.hpp"
#include "gst/support/foreign_enum.hpp"

#include <string>
#include <utility>

namespace rg {

FrameMoment momentOf(GstBuffer* frame, OriginPtr origin) {
  return {GST_BUFFER_PTS(frame), captureTimeOf(frame), std::move(origin)};
}

void postTimedMessage(GstBaseTransform* element, GstDebugCategory* category,
                      const FrameMoment& moment, GstStructure* fields) {
  const GstClockTime pts = moment.pts;
  const GstSegment* segment = &element->segment;
  // Backwards from nowhere is no time; GStreamer calls it critical.
  const bool hasOrigin = segment->rate > 0 || GST_CLOCK_TIME_IS_VALID(segment->stop);
  const bool hasTimes =
      numberIn(segment->format) == GST_FORMAT_TIME && hasOrigin && GST_CLOCK_TIME_IS_VALID(pts);
  const guint64 streamTime =
      hasTimes ? gst_segment_to_stream_time(segment, GST_FORMAT_TIME, pts) : GST_CLOCK_TIME_NONE;
  const guint64 runningTime =
      hasTimes ? gst_segment_to_running_time(segment, GST_FORMAT_TIME, pts) : GST_CLOCK_TIME_NONE;
  gst_structure_set(fields, "pts", G_TYPE_UINT64, static_cast<guint64>(pts), "stream-time",
                    G_TYPE_UINT64, streamTime, "running-time", G_TYPE_UINT64, runningTime, nullptr);
  if (moment.utcNs) {
    std::string utc;
    text::appendUtc(utc, *moment.utcNs);
    gst_structure_set(fields, "utc", G_TYPE_STRING, utc.c_str(), nullptr);
  }
  setOrigin(fields, moment.origin);
  GST_CAT_DEBUG_OBJECT(category, element, "%" GST_PTR_FORMAT, static_cast<gpointer>(fields));
  gst_element_post_message(GST_ELEMENT(element),
                           gst_message_new_element(GST_OBJECT(element), fields));
}

}  // namespace rg
