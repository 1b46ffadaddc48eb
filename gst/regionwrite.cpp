// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-regionwrite
 * @title: regionwrite
 *
 * Writes what the elements before it found to a file, and passes the frames on untouched. Every
 * frame's lines are written as soon as the frame arrives.
 *
 * A thread of its own writes, so that live video never waits: where the pipeline is live, frames go
 * on whatever becomes of the file, and those whose lines are lost are counted (drop, dropped).
 * Elsewhere a frame waits for its lines, as it would in filesink. The end of the stream and a stop
 * wait two seconds at most for a reader that does not read.
 *
 * When another program has moved the file away, the action signal "reopen" goes on with a new one
 * of the old name. max-file-size and max-file-duration begin another file by themselves, in whole
 * lines. Where GStreamer's own sinks are to write, take regiontext.
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
#include "gst/elements.hpp"
#include "gst/support/line_filter.hpp"
#include "gst/support/line_writer.hpp"
#include "gst/support/origin.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

namespace rg {
namespace {

enum class Drop : int { Auto, True, False };

GType formatType() {
  static const GEnumValue values[] = {
      {static_cast<int>(LineFormat::JsonLines),
       "JSON lines: one object a frame with all that is known of its objects and events", "jsonl"},
      {static_cast<int>(LineFormat::Mot),
       "MOTChallenge CSV: one line for each object of each frame", "mot"},
      {static_cast<int>(LineFormat::Regions),
       "CSV with a header: one line for each region of each frame, with its motion", "regions"},
      {static_cast<int>(LineFormat::Graph),
       "JSON lines: the region graph of each frame, with the energy of each arc and why regions "
       "were merged or not",
       "graph"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionWriteFormat", values);
  return type;
}

GType dropType() {
  static const GEnumValue values[] = {
      {static_cast<int>(Drop::Auto), "as true in a live pipeline, else as false", "auto"},
      {static_cast<int>(Drop::True),
       "frames never wait: what can't be written is dropped and counted", "true"},
      {static_cast<int>(Drop::False),
       "frames wait until their lines are written; a failure ends the stream", "false"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionWriteDrop", values);
  return type;
}

struct Settings : OriginSettings {
  std::string location = "-";
  LineFormat format = LineFormat::JsonLines;
  bool hasContours = false;
  Drop drop = Drop::Auto;
  guint64 dropped = 0;
  bool isAppending = false;
  guint64 mostBytes = 0;
  guint64 mostNs = 0;
  int mostOldFiles = 10;
};

constexpr std::array kProperties{
    property<Settings, &Settings::location>(
        "location",
        "File or pipe to write. A file is made, or emptied unless append is set, when the element "
        "starts; a pipe must have a reader. Only one element or program may write to it. - is "
        "standard output (run gst-launch-1.0 with -q then)",
        0, 0, Mutable::Ready),
    enumProperty<Settings, &Settings::format>(
        "format", "What is written; jsonl, mot and graph need mrfmerge, regions needs srg",
        formatType, Mutable::Ready),
    property<Settings, &Settings::hasContours>(
        "contours",
        "format=jsonl: also write each object's outline, in pixels; the lines get much longer"),
    sourceProperty<Settings>(),
    tagsProperty<Settings>(),
    enumProperty<Settings, &Settings::drop>(
        "drop",
        "Whether frames go on when their lines can't be written in time, since more than 4 MiB "
        "wait for a slow reader, or at all, since the disk is full or the reader has gone. Lines "
        "are written again as soon as that works",
        dropType),
    property<Settings, &Settings::dropped>(
        "dropped", "Frames since the start whose lines were not written", 0, 0, Mutable::Never),
    property<Settings, &Settings::isAppending>(
        "append", "Write behind what is in the file instead of emptying it at the start", 0, 0,
        Mutable::Ready),
    property<Settings, &Settings::mostBytes>(
        "max-file-size",
        "Bytes after which another file is begun; the one before becomes LOCATION.1, that "
        "LOCATION.2 and so on. Lines are never parted. 0 = no limit",
        0, 0, Mutable::Ready),
    property<Settings, &Settings::mostNs>(
        "max-file-duration",
        "Nanoseconds of video after which another file is begun, as by max-file-size; 0 = no limit",
        0, 0, Mutable::Ready),
    property<Settings, &Settings::mostOldFiles>(
        "max-files",
        "Files that are kept beside the one that is written, where max-file-size or "
        "max-file-duration begins others; the oldest is overwritten",
        1, 1000, Mutable::Ready),
};

LineFileOptions optionsOf(const Settings& settings) {
  LineFileOptions options;
  options.location = settings.location;
  if (settings.format == LineFormat::Regions) options.header = text::kRegionsHeader;
  options.isAppending = settings.isAppending;
  options.mostBytes = settings.mostBytes;
  options.mostNs = static_cast<int64_t>(std::min<guint64>(settings.mostNs, G_MAXINT64));
  options.mostOldFiles = settings.mostOldFiles;
  return options;
}

class RegionWrite final : public LineFilter {
 public:
  explicit RegionWrite(GstBaseTransform* element) : LineFilter(element) {
    gst_base_transform_set_passthrough(element, TRUE);
  }

  void* settings() override {
    if (writer_) settings_.dropped = writer_->dropped();
    return &settings_;
  }

  bool start() override {
    const Settings settings = snapshot(settings_);
    location_ = settings.location;
    format_ = settings.format;
    hasToldCrowd_ = hasToldFailure_ = false;
    restartCount();
    auto sink = LineFile::open(optionsOf(settings));
    if (!sink) return postOpenError(sink.error());
    auto writer = LineWriter::start(*std::move(sink));
    if (!writer) return postOpenError(writer.error());
    const std::lock_guard lock(settingsMutex());
    writer_ = *std::move(writer);
    settings_.dropped = 0;
    return true;
  }

  void stop() override {
    if (!writer_) return;
    writer_->stop();
    tellLosses();
    const std::lock_guard lock(settingsMutex());
    settings_.dropped = writer_->dropped();
    writer_.reset();
  }

  /// The action signal "reopen", on any thread.
  void act() override {
    const std::lock_guard lock(settingsMutex());
    if (writer_) writer_->reopen();
  }

  void endOfStream() override {
    writer_->drain([&] { return isFlushing(); });
    tellLosses();
  }

  GstFlowReturn process(const FilterFrame& frame) override {
    if (frame.isFirst) isLive_ = isUpstreamLive();
    const Settings settings = snapshot(settings_);
    lines_.clear();
    const GstFlowReturn flow =
        appendLines(lines_, frame, {format_, settings.hasContours, settings.origin.get()});
    if (flow != GST_FLOW_OK || lines_.empty()) return flow;
    mayDrop_ = settings.drop == Drop::True || (settings.drop == Drop::Auto && isLive_);
    writer_->push(lines_, frame.time.ns, mayDrop_ ? Crowded::Drop : Crowded::Wait,
                  [&] { return isFlushing(); });
    return tellLosses();
  }

 private:
  [[nodiscard]] bool isFlushing() const { return GST_PAD_IS_FLUSHING(element()->srcpad) != FALSE; }

  [[nodiscard]] bool isUpstreamLive() const {
    GstQuery* query = gst_query_new_latency();
    gboolean isLive = FALSE;
    if (gst_pad_peer_query(GST_BASE_TRANSFORM_SINK_PAD(element()), query))
      gst_query_parse_latency(query, &isLive, nullptr, nullptr);
    gst_query_unref(query);
    return isLive != FALSE;
  }

  /// What may drop tells it once; elsewhere a line that is not written is an error.
  GstFlowReturn tellLosses() {
    if (const auto complaint = writer_->takeComplaint())
      postWriteWarning("Writing to \"" + location_ + "\": " + complaint->message + ".");
    if (const auto failure = writer_->takeFailure()) {
      if (!mayDrop_) return postWriteError(*failure);
      if (!std::exchange(hasToldFailure_, true))
        postWriteWarning("Could not write to \"" + location_ + "\": " + failure->message +
                         ". Lines are dropped until that works again; the property dropped counts "
                         "their frames.");
    }
    if (writer_->wasCrowded() && !std::exchange(hasToldCrowd_, true))
      postWriteWarning("Whoever reads \"" + location_ +
                       "\" does not keep up: lines are dropped, and the property dropped counts "
                       "their frames. Read faster, or set drop=false where frames may wait.");
    return GST_FLOW_OK;
  }

  [[nodiscard]] bool postOpenError(const Error& error) const {
    GST_ELEMENT_ERROR(
        element(), RESOURCE, OPEN_WRITE,
        ("Could not open \"%s\" for writing: %s.", location_.c_str(), error.message.c_str()),
        ("The property location must name a file that can be made or overwritten."));
    return false;
  }

  GstFlowReturn postWriteError(const Error& error) const {
    GST_ELEMENT_ERROR(element(), RESOURCE, WRITE,
                      ("Could not write to \"%s\": %s.", location_.c_str(), error.message.c_str()),
                      (nullptr));
    return GST_FLOW_ERROR;
  }

  void postWriteWarning(const std::string& text) const {
    GST_ELEMENT_WARNING(element(), RESOURCE, WRITE, ("%s", text.c_str()), (nullptr));
  }

  Settings settings_;
  std::string location_;
  LineFormat format_ = LineFormat::JsonLines;
  std::unique_ptr<LineWriter> writer_;  ///< Changes with the settings' mutex held.
  std::string lines_;
  bool isLive_ = false;
  bool mayDrop_ = false;
  bool hasToldCrowd_ = false, hasToldFailure_ = false;  ///< Since the start.
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
        "Live video never waits for the file (see drop). The action signal reopen goes on with a "
        "new file after another program has moved the old one. Needs mrfmerge, for regions srg",
    .example =
        "gst-launch-1.0 -q videotestsrc pattern=ball num-buffers=100 ! "
        "video/x-raw,format=I420 ! bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! "
        "regionwrite ! fakesink",
    .caps = kMetaCaps,
    .properties = kProperties,
    .defaults = &kDefaults,
    .create = [](GstBaseTransform* element) -> Filter* { return new RegionWrite(element); },
    .action = "reopen",
    .takesCrops = true,
};

}  // namespace
}  // namespace rg

GType gst_region_write_get_type() {
  static const GType type = rg::registerFilter(rg::kDescription);
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(regionwrite, "regionwrite", GST_RANK_NONE, gst_region_write_get_type())
