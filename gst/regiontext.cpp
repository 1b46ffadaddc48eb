// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-regiontext
 * @title: regiontext
 *
 * Frames in, text out: one buffer of application/x-json for each frame, which is one line of JSON
 * with its line feed, as regionwrite writes it. For GStreamer's own sinks: filesink, multifilesink,
 * tcpserversink, or an application's appsink. Each line has the time stamp and the capture time of
 * its frame, so that a sink with sync=true gives it out when the frame is shown.
 *
 * A sink that waits holds up the frames as well, and those of a tee's other branches: put a queue
 * in front of regiontext, with leaky=downstream where video is live. regionwrite needs none.
 *
 * |[
 * gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert ! regiontrack ! tee name=t !
 *   queue ! regionoverlay ! videoconvert ! autovideosink
 *   t. ! queue ! regiontext ! tcpserversink port=5000 sync=true
 * ]|
 */
#include "gst/elements.hpp"
#include "gst/support/line_filter.hpp"
#include "gst/support/origin.hpp"

#include <array>
#include <string>
#include <string_view>

namespace rg {
namespace {

constexpr const char* kTextCaps = "application/x-json";

GType formatType() {
  static const GEnumValue values[] = {
      {static_cast<int>(LineFormat::JsonLines),
       "One object a frame with all that is known of its objects and events", "jsonl"},
      {static_cast<int>(LineFormat::Graph),
       "The region graph of each frame, with the energy of each arc and why regions were merged or "
       "not",
       "graph"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionTextFormat", values);
  return type;
}

struct Settings : OriginSettings {
  LineFormat format = LineFormat::JsonLines;
  bool hasContours = false;
};

constexpr std::array kProperties{
    enumProperty<Settings, &Settings::format>("format", "What is told; needs mrfmerge", formatType),
    property<Settings, &Settings::hasContours>(
        "contours",
        "format=jsonl: also tell each object's outline, in pixels; the lines get much longer"),
    sourceProperty<Settings>(),
    tagsProperty<Settings>(),
};

/// A buffer with a copy of the text.
GstBuffer* bufferOf(std::string_view text) {
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, text.size(), nullptr);
  gst_buffer_fill(buffer, 0, text.data(), text.size());
  return buffer;
}

/// When the frame is shown, and when it was taken; the rest of it is about pixels.
void copyTimes(GstBuffer* to, GstBuffer* from) {
  GST_BUFFER_PTS(to) = GST_BUFFER_PTS(from);
  GST_BUFFER_DURATION(to) = GST_BUFFER_DURATION(from);
  if (GST_BUFFER_FLAG_IS_SET(from, GST_BUFFER_FLAG_DISCONT))
    GST_BUFFER_FLAG_SET(to, GST_BUFFER_FLAG_DISCONT);
  gpointer state = nullptr;
  while (GstMeta* found = gst_buffer_iterate_meta_filtered(from, &state,
                                                           GST_REFERENCE_TIMESTAMP_META_API_TYPE)) {
    const auto* meta = reinterpret_cast<GstReferenceTimestampMeta*>(found);
    gst_buffer_add_reference_timestamp_meta(to, meta->reference, meta->timestamp, meta->duration);
  }
}

class RegionText final : public LineFilter {
 public:
  using LineFilter::LineFilter;

  void* settings() override { return &settings_; }

  bool start() override {
    restartCount();
    return true;
  }

  GstFlowReturn process(const FilterFrame& frame) override {
    const Settings settings = snapshot(settings_);
    line_.clear();
    return appendLines(line_, frame,
                       {settings.format, settings.hasContours, settings.origin.get()});
  }

  GstBuffer* render(GstBuffer* frame) override {
    GstBuffer* text = bufferOf(line_);
    copyTimes(text, frame);
    gst_buffer_unref(frame);
    return text;
  }

 private:
  Settings settings_;
  std::string line_;
};

const Settings kDefaults;
const FilterDescription kDescription{
    .elementName = "regiontext",
    .typeName = "GstRegionText",
    .longName = "Regions and objects as text",
    .klass = "Filter/Analyzer/Video",
    .description =
        "Turns what the elements before it found into text, one buffer with a line of JSON for "
        "each frame (schema: gst-regiongraph/regiongraph.schema.json in the data folder), for "
        "filesink, multifilesink, tcpserversink or appsink. Behind a tee, put a queue in front. "
        "Needs mrfmerge",
    .example =
        "gst-launch-1.0 -q videotestsrc pattern=ball num-buffers=100 ! "
        "video/x-raw,format=I420 ! bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! "
        "regiontext ! filesink location=objects.jsonl",
    .caps = kMetaCaps,
    .properties = kProperties,
    .defaults = &kDefaults,
    .create = [](GstBaseTransform* element) -> Filter* { return new RegionText(element); },
    .srcCaps = kTextCaps,
    .takesCrops = true,
};

}  // namespace
}  // namespace rg

GType gst_region_text_get_type() {
  static const GType type = rg::registerFilter(rg::kDescription);
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(regiontext, "regiontext", GST_RANK_NONE, gst_region_text_get_type())
