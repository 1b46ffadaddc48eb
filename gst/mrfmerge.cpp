// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-mrfmerge
 * @title: mrfmerge
 *
 * Merges regions that move alike into objects and follows these from frame to frame. Objects are
 * attached as a meta of this plugin and as GstVideoRegionOfInterestMeta of type "object", whose id
 * is the object's number and whose params hold DL Streamer's "detection" and "object_id".
 *
 * What happens is told by element messages, each with the fields pts, stream-time and running-time:
 * regiongraph-object-new and regiongraph-object-end (id), regiongraph-merge and regiongraph-split
 * (ids), regiongraph-background-motion (moving, dx, dy: pixels since the previous frame) and
 * regiongraph-scene-changed.
 *
 * |[
 * gst-launch-1.0 -m filesrc location=clip.avi ! decodebin ! videoconvert ! bgremove ! hsvsegment !
 *   srg ! prmmotion ! mrfmerge ! regionwrite location=objects.jsonl ! fakesink
 * ]|
 */
#include "core/objects.hpp"
#include "gst/elements.hpp"
#include "gst/support/object_messages.hpp"
#include "gst/support/roi_metas.hpp"
#include "gst/support/stage_filter.hpp"

#include <array>

namespace rg {
namespace {

struct Settings : StageSettings, ObjectParams {};

constexpr std::array kProperties{
    property<Settings, &Settings::motionWeight>(
        "motion-weight",
        "Weight of U1: what it costs to keep regions together that move differently. Higher takes "
        "objects apart sooner",
        0, 1000),
    property<Settings, &Settings::borderWeight>(
        "border-weight",
        "Weight of U2: what each pixel of border between two groups costs. Higher keeps touching "
        "regions together",
        0, 1000),
    property<Settings, &Settings::arcWeight>(
        "arc-weight", "Weight of U3: what each pair of touching regions in different groups costs",
        0, 1000),
    property<Settings, &Settings::predictionWeight>(
        "prediction-weight",
        "What it costs to part regions that were expected to be one object, by where that was in "
        "the previous frame and how it moved. Higher keeps objects whole",
        0, 1000),
    property<Settings, &Settings::motionThresholdPx>(
        "motion-threshold",
        "Regions whose motions differ by less than this move alike; in pixels per frame", 0.0625,
        64),
    property<Settings, &Settings::maxLostTimeS>(
        "max-lost-time",
        "Seconds for which an object that is not seen keeps its number, should it come back", 0,
        3600),
    property<Settings, &Settings::minObjectArea>("min-object-area",
                                                 "Smallest object, in percent of the frame's area; "
                                                 "0 = learnt from the sizes seen in the scene",
                                                 0, 100),
    threadsProperty<Settings>(),
};

class MrfMerge final : public ChainedFilter<Settings, ObjectStage, Motion> {
 public:
  explicit MrfMerge(GstBaseTransform* element)
      : ChainedFilter(element, makeObjectStage, "prmmotion"), messages_(element) {}

  /// Ends of objects are told at once: after a reset or at the end there may be no next frame.
  void reset(Reset what) override {
    ChainedFilter::reset(what);
    if (what != Reset::Gap) messages_.endAll();
  }
  void endOfStream() override { messages_.endAll(); }

 private:
  void handle(const FilterFrame& frame, std::shared_ptr<const Motion> motion,
              const Settings& settings) override {
    if (!motion) return attachSkipped<Objects>(frame);
    auto objects = stage().process(std::move(motion), settings, frame.time);
    if (objects) {
      addRoiMetas(frame.buffer, frame.info, **objects);
      messages_.tell(**objects, GST_BUFFER_PTS(frame.buffer));
    }
    attach<Objects>(frame, std::move(objects));
  }

  ObjectMessages messages_;
};

const Settings kDefaults;
const FilterDescription kDescription{
    .elementName = "mrfmerge",
    .typeName = "GstMrfMerge",
    .longName = "Object tracking",
    .klass = "Filter/Analyzer/Video",
    .description =
        "Merges regions that move alike into objects and follows these from frame to "
        "frame, through stops and occlusions. Attaches the objects to each buffer as a "
        "meta and as GstVideoRegionOfInterestMeta, and tells their beginning, end, merge "
        "and split by element messages; pixels pass untouched. Last of the five stages, "
        "needs prmmotion",
    .example =
        "gst-launch-1.0 videotestsrc pattern=ball num-buffers=100 ! "
        "video/x-raw,format=I420 ! bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! "
        "regionwrite ! fakesink",
    .caps = kMetaCaps,
    .properties = kProperties,
    .defaults = &kDefaults,
    .create = [](GstBaseTransform* element) -> Filter* { return new MrfMerge(element); },
};

}  // namespace
}  // namespace rg

GType gst_region_mrfmerge_get_type() {
  static const GType type = rg::registerFilter(rg::kDescription);
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(mrfmerge, "mrfmerge", GST_RANK_NONE, gst_region_mrfmerge_get_type())
