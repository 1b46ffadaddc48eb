// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/line_filter.hpp"

#include "gst/support/capture_time.hpp"
#include "gst/support/shown_result.hpp"

namespace rg {

GstFlowReturn LineFilter::appendLines(std::string& out, const FilterFrame& frame,
                                      const Lines& lines) {
  text::FrameStamp stamp = stampOf(frame);
  stamp.origin = lines.origin;
  return lines.format == LineFormat::Regions ? appendRegions(out, frame, stamp)
                                             : appendObjects(out, frame, stamp, lines);
}

text::FrameStamp LineFilter::stampOf(const FilterFrame& frame) {
  text::FrameStamp stamp;
  stamp.number = ++frames_;
  stamp.size = {GST_VIDEO_INFO_WIDTH(&frame.info), GST_VIDEO_INFO_HEIGHT(&frame.info)};
  if (GST_BUFFER_PTS_IS_VALID(frame.buffer)) stamp.ptsNs = GST_BUFFER_PTS(frame.buffer);
  stamp.utcNs = captureTimeOf(frame.buffer);
  return stamp;
}

GstFlowReturn LineFilter::appendRegions(std::string& out, const FilterFrame& frame,
                                        const text::FrameStamp& stamp) {
  const auto upstream = require<graph::Graph>(frame, "srg");
  if (!upstream.result) return upstream.flow;
  const auto graph = asShown(frame.buffer, stamp.size, upstream.result);
  const auto motion = findShown<motion::Motion>(frame.buffer, stamp.size);
  const auto objects = findShown<objects::Objects>(frame.buffer, stamp.size);
  text::appendRegions(out, {graph.get(), motion.get(), objects.get()}, stamp);
  return GST_FLOW_OK;
}

GstFlowReturn LineFilter::appendObjects(std::string& out, const FilterFrame& frame,
                                        const text::FrameStamp& stamp, const Lines& lines) {
  const auto upstream = require<objects::Objects>(frame, "mrfmerge");
  if (upstream.flow != GST_FLOW_OK) return upstream.flow;
  const auto shown = asShown(frame.buffer, stamp.size, upstream.result);
  const objects::Objects& objects = shown ? *shown : skipped_;
  if (lines.format == LineFormat::Mot)
    text::appendMot(out, objects, stamp);
  else if (lines.format == LineFormat::Graph)
    text::appendGraph(out, objects, stamp);
  else
    text::appendJson(out, objects, stamp,
                     lines.hasContours ? text::Contours::Write : text::Contours::Omit);
  return GST_FLOW_OK;
}

}  // namespace rg
