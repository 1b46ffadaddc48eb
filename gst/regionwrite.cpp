// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-regionwrite
 * @title: regionwrite
 *
 * Writes what the elements before it found to a file, and passes the frames on untouched. Every
 * frame's lines are written as soon as the frame arrives.
 *
 * format=jsonl writes one JSON object a frame; the JSON Schema is installed as
 * gst-regiongraph/regiongraph.schema.json in the data folder. format=mot writes MOTChallenge CSV
 * (frame,id,left,top,width,height,1,-1,-1,-1), format=regions CSV with a header. format=graph
 * writes a JSON object a frame that explains each merge: regions, arcs and their energies
 * (regiongraph-graph.schema.json; examples/graph.py draws one frame of it).
 *
 * Objects are listed while they are tracked, stopped or occluded. Coordinates are pixels of the
 * frame as it arrives here: where it was scaled behind mrfmerge, they are scaled too. Frames count
 * from 1; the time of day is written only for frames with a GstReferenceTimestampMeta in UNIX or
 * NTP time, so that two runs over a file write the same bytes.
 *
 * |[
 * gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert ! bgremove ! hsvsegment !
 *   srg ! prmmotion ! mrfmerge ! regionwrite location=objects.jsonl ! fakesink
 * ]|
 */
#include "core/text/text.hpp"
#include "gst/elements.hpp"
#include "gst/support/capture_time.hpp"
#include "gst/support/line_file.hpp"
#include "gst/support/stage_filter.hpp"

#include <array>
#include <string>

namespace rg {
namespace {

enum class Format : int { JsonLines, Mot, Regions, Graph };

GType formatType() {
  static const GEnumValue values[] = {
      {static_cast<int>(Format::JsonLines),
       "JSON lines: one object a frame with all that is known of its objects and events", "jsonl"},
      {static_cast<int>(Format::Mot), "MOTChallenge CSV: one line for each object of each frame",
       "mot"},
      {static_cast<int>(Format::Regions),
       "CSV with a header: one line for each region of each frame, with its motion", "regions"},
      {static_cast<int>(Format::Graph),
       "JSON lines: the region graph of each frame, with the energy of each arc and why regions "
       "were merged or not",
       "graph"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionWriteFormat", values);
  return type;
}

struct Settings {
  std::string location = "-";
  Format format = Format::JsonLines;
  bool hasContours = false;
};

constexpr std::array kProperties{
    property<Settings, &Settings::location>(
        "location",
        "File to write; it is made or emptied when the element starts. - is standard output (run "
        "gst-launch-1.0 with -q then)",
        0, 0, Mutable::Ready),
    enumProperty<Settings, &Settings::format>(
        "format", "What is written; jsonl, mot and graph need mrfmerge, regions needs srg",
        formatType, Mutable::Ready),
    property<Settings, &Settings::hasContours>(
        "contours",
        "format=jsonl: also write each object's outline, in pixels; the lines get much longer"),
};

class RegionWrite final : public StageFilter {
 public:
  explicit RegionWrite(GstBaseTransform* element) : StageFilter(element) {
    gst_base_transform_set_passthrough(element, TRUE);
  }

  void* settings() override { return &settings_; }

  bool start() override {
    const Settings settings = snapshot(settings_);
    location_ = settings.location;
    format_ = settings.format;
    frames_ = 0;
    auto opened = LineFile::open(location_);
    if (!opened) {
      GST_ELEMENT_ERROR(
          element(), RESOURCE, OPEN_WRITE,
          ("Could not open \"%s\" for writing: %s.", location_.c_str(),
           opened.error().message.c_str()),
          ("The property location must name a file that can be made or overwritten."));
      return false;
    }
    file_ = *std::move(opened);
    return format_ != Format::Regions || write(text::kRegionsHeader) == GST_FLOW_OK;
  }

  void stop() override {
    if (const auto error = file_.close()) postWriteError(*error);
  }

  GstFlowReturn process(const FilterFrame& frame) override {
    const text::FrameStamp stamp = stampOf(frame);
    lines_.clear();
    const GstFlowReturn flow =
        format_ == Format::Regions ? appendRegions(frame, stamp) : appendObjects(frame, stamp);
    return flow == GST_FLOW_OK ? write(lines_) : flow;
  }

 private:
  [[nodiscard]] text::FrameStamp stampOf(const FilterFrame& frame) {
    text::FrameStamp stamp;
    stamp.number = ++frames_;
    stamp.size = {GST_VIDEO_INFO_WIDTH(&frame.info), GST_VIDEO_INFO_HEIGHT(&frame.info)};
    if (GST_BUFFER_PTS_IS_VALID(frame.buffer)) stamp.ptsNs = GST_BUFFER_PTS(frame.buffer);
    stamp.utcNs = captureTimeOf(frame.buffer);
    return stamp;
  }

  GstFlowReturn appendRegions(const FilterFrame& frame, const text::FrameStamp& stamp) {
    const auto upstream = require<graph::Graph>(frame, "srg");
    if (!upstream.result) return upstream.flow;
    const auto motion = findResult<motion::Motion>(frame.buffer);
    const auto objects = findResult<objects::Objects>(frame.buffer);
    text::appendRegions(lines_, {upstream.result.get(), motion.get(), objects.get()}, stamp);
    return GST_FLOW_OK;
  }

  GstFlowReturn appendObjects(const FilterFrame& frame, const text::FrameStamp& stamp) {
    const auto upstream = require<objects::Objects>(frame, "mrfmerge");
    if (upstream.flow != GST_FLOW_OK) return upstream.flow;
    const objects::Objects& objects = upstream.result ? *upstream.result : skipped_;
    if (format_ == Format::Mot) {
      text::appendMot(lines_, objects, stamp);
    } else if (format_ == Format::Graph) {
      text::appendGraph(lines_, objects, stamp);
    } else {
      const bool hasContours = snapshot(settings_.hasContours);
      text::appendJson(lines_, objects, stamp,
                       hasContours ? text::Contours::Write : text::Contours::Omit);
    }
    return GST_FLOW_OK;
  }

  GstFlowReturn write(std::string_view lines) {
    const auto isFlushing = [&] { return GST_PAD_IS_FLUSHING(element()->srcpad) != FALSE; };
    const auto error = file_.write(lines, isFlushing);
    if (!error) return GST_FLOW_OK;
    postWriteError(*error);
    return GST_FLOW_ERROR;
  }

  void postWriteError(const Error& error) const {
    GST_ELEMENT_ERROR(element(), RESOURCE, WRITE,
                      ("Could not write to \"%s\": %s.", location_.c_str(), error.message.c_str()),
                      (nullptr));
  }

  Settings settings_;
  std::string location_;
  Format format_ = Format::JsonLines;
  LineFile file_;
  uint64_t frames_ = 0;
  std::string lines_;
  const objects::Objects skipped_;  ///< Written for a frame without a result.
};

const Settings kDefaults;
const FilterDescription kDescription{
    .elementName = "regionwrite",
    .typeName = "GstRegionWrite",
    .longName = "Region and object writer",
    .klass = "Filter/Analyzer/Video",
    .description =
        "Writes what the elements before it found to a file and passes the frames on untouched: "
        "objects as JSON lines (schema: gst-regiongraph/regiongraph.schema.json in the data "
        "folder) "
        "or MOTChallenge CSV, regions with their motion as CSV, or the region graph with the "
        "energy "
        "of each arc as JSON lines. Each frame's lines are written at once; frames count from 1. "
        "Needs mrfmerge, for regions srg",
    .example =
        "gst-launch-1.0 -q videotestsrc pattern=ball num-buffers=100 ! "
        "video/x-raw,format=I420 ! bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! "
        "regionwrite ! fakesink",
    .caps = kMetaCaps,
    .properties = kProperties,
    .defaults = &kDefaults,
    .create = [](GstBaseTransform* element) -> Filter* { return new RegionWrite(element); },
};

}  // namespace
}  // namespace rg

GType gst_region_write_get_type() {
  static const GType type = rg::registerFilter(rg::kDescription);
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(regionwrite, "regionwrite", GST_RANK_NONE, gst_region_write_get_type())
