// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-mrfmerge
 * @title: mrfmerge
 *
 * Merges regions that move alike into objects and follows these from frame to frame. Objects are
 * attached as a meta of this plugin and as GstVideoRegionOfInterestMeta of type "object", whose id
 * is the object's number and whose params hold DL Streamer's "detection" and "object_id".
 *
 * What happens is told by element messages, each with the fields pts, stream-time and running-time,
 * utc (text, RFC 3339) where the frames have a capture time, and source and tags (a structure of
 * texts) where these properties are set: regiongraph-object-new and regiongraph-object-end (id,
 * state, and the box as x, y, w, h in pixels; the last known ones at the end), regiongraph-merge
 * and regiongraph-split (ids, states, and the box round all of them), regiongraph-background-motion
 * (moving, dx, dy: pixels since the previous frame in the middle of the frame; matrix: nine numbers
 * as gst_region_objects_meta_get_camera_matrix() tells them) and regiongraph-scene-changed. Things
 * that touch and part several times a second are told once: a merge or split that follows another
 * one of the same objects within two seconds is told when it has lasted as long. The events in the
 * objects' meta and in regionwrite's lines are all of them.
 *
 * Where tens of thousands of regions are asked for and one touches most of the others, the search
 * for the best groups is ended early, so that a frame's time stays in proportion to its regions;
 * the first such frame causes a warning. Where more than half a million pixels of a frame seem to
 * move otherwise than the camera, some rows of each region tell whether it does.
 *
 * From here on the results of all five stages are packed: a frame that waits in a queue holds less
 * than two bytes a pixel of them. Readers see no difference; stages can't work on them again.
 *
 * |[
 * gst-launch-1.0 -m filesrc location=clip.avi ! decodebin ! videoconvert ! bgremove ! hsvsegment !
 *   srg ! prmmotion ! mrfmerge ! regionwrite location=objects.jsonl ! fakesink
 * ]|
 */
#include "core/objects/objects.hpp"
#include "core/text/text.hpp"
#include "gst/elements.hpp"
#include "gst/support/frame_hold.hpp"
#include "gst/support/object_messages.hpp"
#include "gst/support/origin.hpp"
#include "gst/support/roi_metas.hpp"
#include "gst/support/stage_filter.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <deque>
#include <new>
#include <utility>

namespace rg {
namespace {

constexpr int kManyStanding = 10;

GType methodType() {
  static const GEnumValue values[] = {
      {static_cast<int>(objects::Method::Extended),
       "By the energy, with what is known of the frames before and of the ground", "extended"},
      {static_cast<int>(objects::Method::Literal),
       "As the paper says: the energy over this frame's regions alone; the largest group, or what "
       "has no region if that is more, is the background",
       "literal"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionMergeMethod", values);
  return type;
}

struct Settings : StageSettings, objects::Params, OriginSettings, BackendSettings {
  double latencyS = 0.0;
};

constexpr std::array kProperties{
    property<Settings, &Settings::motionWeight>(
        "motion-weight",
        "Weight of U1: what it costs to keep regions together that move differently. Higher takes "
        "objects apart sooner",
        0, 1000),
    property<Settings, &Settings::borderWeight>(
        "border-weight",
        "Weight of U2: what each pixel of border between two groups costs where no edge is seen. "
        "Higher keeps touching regions together",
        0, 1000),
    property<Settings, &Settings::arcWeight>(
        "arc-weight",
        "Weight of U3: what each pair of touching regions in different groups costs, in sixteenths "
        "of the root of the frame's area, the less the more their colours differ",
        0, 1000),
    property<Settings, &Settings::predictionWeight>(
        "prediction-weight",
        "What it costs to part regions that were expected to be one object, by where that was in "
        "the previous frame and how it moved. Higher keeps objects whole",
        0, 1000),
    property<Settings, &Settings::appearanceWeight>(
        "appearance-weight",
        "Weight of how alike what is seen and an object look, against how far from its expected "
        "place that is. 0 tells objects by their places alone",
        0, 1000),
    property<Settings, &Settings::motionThreshold>(
        "motion-threshold",
        "Regions whose speeds differ by less than this move alike, and a moving camera's frame is "
        "compared with one of so long ago that this is a pixel; in percent of the root of the "
        "frame's area per second",
        0.1, 1000),
    property<Settings, &Settings::maxLostTimeS>(
        "max-lost-time",
        "Seconds for which an object that is not seen keeps its number, should it come back", 0,
        3600),
    property<Settings, &Settings::minObjectArea>("min-object-area",
                                                 "Smallest object, in percent of the frame's area; "
                                                 "0 = learnt from the sizes seen in the scene",
                                                 0, 100),
    enumProperty<Settings, &Settings::method>("method", "How regions become groups", methodType),
    property<Settings, &Settings::latencyS>(
        "latency",
        "Seconds for which frames are held back, so that an object is told from when it was first "
        "seen instead of from when it was confirmed, and is placed where it must have been while "
        "it "
        "was hidden. Reported to the pipeline. At most 600 frames are held, and 2 GiB with what is "
        "known of them",
        0, 10, Mutable::Ready),
    sourceProperty<Settings>(),
    tagsProperty<Settings>(),
    threadsProperty<Settings>(),
    backendProperty<Settings>(),
    deviceIdProperty<Settings>(),
    activeBackendProperty<Settings>(),
    statsProperty<Settings>(),
};

class MrfMerge final : public ChainedFilter<Settings, objects::Stage, motion::Motion> {
 public:
  explicit MrfMerge(GstBaseTransform* element)
      : ChainedFilter(element, objects::makeStage, "prmmotion"), messages_(element, category()) {}

  bool start() override {
    latency_ = static_cast<GstClockTime>(std::llround(currentSettings().latencyS * 1e9));
    hasToldCut_ = false;
    return ChainedFilter::start();
  }
  /// Ends of objects are told at once: after a reset or at the end there may be no next frame.
  void reset(Reset what) override {
    if (what != Reset::Gap) {
      sendHeld();
      dropHeld();
    }
    if (what == Reset::Stream) packer_.drop();
    ChainedFilter::reset(what);
    if (what != Reset::Gap) messages_.endAll();
  }
  void endOfStream() override { messages_.endAll(); }

  GstClockTime latency() override { return latency_; }
  void hold(GstBuffer* buffer) override { held_.back().reset(buffer); }
  GstBuffer* release(bool isEnd) override {
    const bool isFull = delay_.count() > mostHeld() || heldBytes_ > kMostHeldBytes;
    auto objects = delay_.pop(static_cast<int64_t>(latency()));
    if (!objects && isFull) tellFull();
    if (!objects && (isEnd || isFull)) objects = delay_.popAny();
    if (!objects) return nullptr;
    heldBytes_ -= bytesOf(*objects);
    HeldBuffer buffer = std::move(held_.front());
    held_.pop_front();
    if (buffer) publish(buffer.get(), std::move(objects));
    return buffer.release();
  }
  void dropHeld() override {
    delay_.clear();
    held_.clear();
    heldBytes_ = 0;
  }

 private:
  struct Unref {
    void operator()(GstBuffer* buffer) const { gst_buffer_unref(buffer); }
  };
  using HeldBuffer = std::unique_ptr<GstBuffer, Unref>;

  void handle(const FilterFrame& frame, std::shared_ptr<const motion::Motion> motion,
              const Settings& settings) override {
    info_ = frame.info;
    auto objects = motion
                       ? orSkipped(frame, stage().process(std::move(motion), settings, frame.time))
                       : skipped<objects::Objects>(frame);
    if (objects->isCutShort && !std::exchange(hasToldCut_, true))
      postWarning(
          "So many small regions touch a large one that groups are not searched to the end; a "
          "larger min-area or similarity of hsvsegment, or a smaller max-regions, makes fewer.");
    remember(*objects);
    packer_.showIn(sizeOf(frame));
    objects = pack(frame.buffer, objects);
    if (latency() > 0)
      delay(std::move(objects), frame.time.ns);
    else
      publish(frame.buffer, std::move(objects));
  }

  /// Of the frame that came, which may leave later.
  [[nodiscard]] Progress describe(const FilterFrame&) override {
    std::array<char, 120> text;
    std::snprintf(text.data(), text.size(), "%s, %zu regions in %zu groups, %zu objects known",
                  text::name(told_.status).data(), told_.regions, told_.groups, told_.objects);
    return {static_cast<uint64_t>(told_.status) * 65536 + told_.objects, text.data()};
  }
  void remember(const objects::Objects& objects) {
    if (!ProgressLog::isOn(category())) return;
    auto groups = objects.regionGroup;
    std::sort(groups.begin(), groups.end());
    const auto end = std::unique(groups.begin(), groups.end());
    told_ = {objects.status, groups.size(), static_cast<size_t>(end - groups.begin()),
             objects.objects.size()};
  }

  /// The frame's results in the form in which they wait for their readers; as they are where there
  /// is no memory for another form.
  std::shared_ptr<const objects::Objects> pack(
      GstBuffer* buffer, const std::shared_ptr<const objects::Objects>& objects) {
    try {
      packMeta<background::Foreground>(buffer);
      packMeta<segmentation::Labels>(buffer);
      packMeta<graph::Graph>(buffer);
      packMeta<motion::Motion>(buffer);
      auto packed = packer_.pack(objects);
      packer_.endFrame();
      return packed;
    } catch (const std::bad_alloc&) {
      packer_.drop();
      return objects;
    }
  }
  template <class Payload>
  void packMeta(GstBuffer* buffer) {
    if (const auto result = findResult<Payload>(buffer))
      attachResult<Payload>(buffer, packer_.pack(result));
  }

  /// Makes the place for hold() too: each result has one, whatever fails.
  void delay(std::shared_ptr<const objects::Objects> objects, int64_t timeNs) {
    held_.emplace_back();
    const guint64 bytes = bytesOf(*objects);
    try {
      delay_.push(std::move(objects), timeNs);
    } catch (...) {
      held_.pop_back();
      throw;
    }
    heldBytes_ += bytes;
    standing_ = delay_.count() > 1 && timeNs == lastNs_ ? standing_ + 1 : 0;
    lastNs_ = timeNs;
    if (standing_ == kManyStanding)
      warnOnce(
          "The time stamps of the frames stand still: latency counts them as 40 ms each. "
          "Put an element in front that sets them.");
  }

  /// The same from its coming to its going. However many regions there are, none takes more.
  [[nodiscard]] guint64 bytesOf(const objects::Objects& objects) const {
    return bytesOfFrame(info_) + kResultBytesPerRegion * objects.regionGroup.size();
  }

  void tellFull() {
    warnOnce("Frames leave before the latency has passed, since no more than " +
             std::to_string(held_.size()) +
             " of this size are held: lower latency, the framerate, the frames' size or their "
             "regions.");
  }

  void publish(GstBuffer* buffer, std::shared_ptr<const objects::Objects> objects) {
    roiMetas_.add(buffer, info_, *objects);
    messages_.tell(*objects, {GST_VIDEO_INFO_WIDTH(&info_), GST_VIDEO_INFO_HEIGHT(&info_)},
                   momentOf(buffer, currentSettings().origin));
    attachResult<objects::Objects>(buffer, std::move(objects));
  }

  ObjectMessages messages_;
  RoiMetas roiMetas_;
  objects::ResultPacker packer_;
  struct Told {
    Status status = Status::Skipped;
    size_t regions = 0, groups = 0, objects = 0;
  };
  Told told_;                ///< Of the latest frame, where somebody wants to know.
  bool hasToldCut_ = false;  ///< Since the element started.
  GstVideoInfo info_{};      ///< Of the frames that are held.
  std::atomic<GstClockTime> latency_ = 0;
  objects::ObjectDelay delay_;
  std::deque<HeldBuffer> held_;  ///< Each belongs to a result in `delay_`.
  guint64 heldBytes_ = 0;        ///< Of both.
  int64_t lastNs_ = 0;           ///< Of the frame before.
  int standing_ = 0;             ///< Frames in a row whose time is that of the one before.
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
