// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/fuzz/chain_program.hpp"

#include "tests/fuzz/cost.hpp"
#include "tests/fuzz/read_metas.hpp"
#include "tests/fuzz/set_property.hpp"

#include <array>
#include <cstring>

namespace rg::fuzz {
namespace {

using testing::BufferPtr;

constexpr const char* kChains[] = {
    "bgremove threads=1 ! hsvsegment threads=1 ! srg threads=1 ! prmmotion threads=1 ! "
    "mrfmerge threads=1 ! regionwrite location=/dev/null contours=true",
    "hsvsegment threads=1 ! srg threads=1 ! prmmotion threads=1 ! mrfmerge threads=1 ! "
    "regionwrite location=/dev/null format=graph",
    "regiontrack threads=1 ! regionoverlay trails=true contours=true vectors=true grid=true",
    "bgremove threads=1 method=frame-difference ! hsvsegment threads=1 scope=areas ! "
    "srg threads=1 connectivity=8 ! prmmotion threads=1 ! mrfmerge threads=1 latency=0.2 ! "
    "regionwrite location=/dev/null format=mot",
    "bgremove threads=1 method=paper training-frames=2 ! hsvsegment threads=1 scope=frame ! "
    "srg threads=1 ! prmmotion threads=1 ! mrfmerge threads=1 ! regionoverlay graph=true "
    "background=black",
    "hsvsegment threads=1 min-area=1 similarity=0 max-regions=65535 ! srg threads=1 ! "
    "prmmotion threads=1 max-shift=64 ! mrfmerge threads=1 ! regionmask source=objects",
    "bgremove threads=1 training-frames=1 ! hsvsegment threads=1 object-hue=0-200 ! srg threads=1 "
    "! regionmask source=labels",
    "bgremove threads=1 ! regionmask source=foreground",
};
constexpr int kSides[] = {1, 2, 3, 7, 8, 16, 17, 33, 48, 64, 96, 127};
constexpr const char* kRates[] = {"25/1",         "0/1",   "1/1",       "90000/1",
                                  "2147483647/1", "1/100", "30000/1001"};
constexpr size_t kMostSteps = 64;

}  // namespace

ChainProgram::ChainProgram(Bytes& bytes)
    : bytes_(bytes), chain_(bytes.pick(kChains), caps_), scene_(MovingScene::from(bytes)) {
  listElements(chain_.harness()->element, elements_);
}

void ChainProgram::run() {
  pushFrames(3);
  for (size_t i = 0; i < kMostSteps && !bytes_.isEmpty() && isGoingOn(); ++i) step();
  gst_harness_push_event(chain_.harness(), gst_event_new_eos());
  pullAll();
}

void ChainProgram::step() {
  switch (bytes_.between(0, 15)) {
    case 0:
    case 1:
      return changeCaps();
    case 2:
      return changeScene();
    case 3:
      return changeTimes();
    case 4:
    case 5:
    case 6:
      return changeProperty();
    case 7:
      return changeState();
    case 8:
      return pushLyingFrame();
    case 9:
      return pushEvent();
    case 10:
      return ask();
    default:
      return pushFrames(bytes_.between(1, 6));
  }
}

void ChainProgram::changeCaps() {
  formatOfCaps_ = bytes_.pick(testing::kAllFormats);
  caps_.format = formatOfCaps_.c_str();
  caps_.width = bytes_.pick(kSides);
  caps_.height = bytes_.pick(kSides);
  caps_.framerate = bytes_.pick(kRates);
  offerCaps();
  pushFrames(bytes_.between(0, 4));
}

void ChainProgram::changeScene() {
  scene_ = MovingScene::from(bytes_);
}

void ChainProgram::changeTimes() {
  times_ = static_cast<Times>(bytes_.between(0, 6));
  step_ = bytes_.flip() ? 40 * GST_MSECOND : bytes_.take<uint32_t>();
  if (times_ == Times::NearTheEnd) time_ = static_cast<uint64_t>(INT64_MAX) - 3 * step_;
}

void ChainProgram::changeProperty() {
  if (!elements_.empty()) setRandomProperty(bytes_.pick(elements_), bytes_);
  emptyBus();
}

void ChainProgram::changeState() {
  GstElement* element = chain_.harness()->element;
  gst_element_set_state(element, bytes_.flip() ? GST_STATE_NULL : GST_STATE_READY);
  gst_element_set_state(element, bytes_.flip() ? GST_STATE_PLAYING : GST_STATE_PAUSED);
  offerCaps();
}

/// Properties may forbid to start, or these caps: then frames are refused, too.
void ChainProgram::offerCaps() {
  GstHarness* harness = chain_.harness();
  GstCaps* caps = gst_caps_from_string(caps_.text().c_str());
  gst_harness_push_event(harness, gst_event_new_caps(caps));
  gst_caps_unref(caps);
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(harness, gst_event_new_segment(&segment));
}

GstClockTime ChainProgram::nextTime() {
  switch (times_) {
    case Times::None:
      return GST_CLOCK_TIME_NONE;
    case Times::Constant:
      return time_;
    case Times::Backwards:
      return time_ -= std::min<uint64_t>(time_, step_);
    case Times::Jumping:
      return time_ += bytes_.take<uint64_t>() >> bytes_.between(1, 40);
    case Times::AtRandom:
      return time_ = bytes_.take<uint64_t>();
    default:
      return time_ += step_;
  }
}

void ChainProgram::pushFrames(int count) {
  const GstVideoInfo info = caps_.info();
  for (int i = 0; i < count && isGoingOn(); ++i) {
    BufferPtr buffer = paintScene(scene_, info);
    scene_.advance();
    GST_BUFFER_PTS(buffer.get()) = nextTime();
    const int64_t pixels = int64_t{caps_.width} * caps_.height;
    measured(pixels + 2000, [&] {
      push(std::move(buffer));
      return 0;
    });
  }
}

/// A frame whose flags, memory or GstVideoMeta are not what they should be.
void ChainProgram::pushLyingFrame() {
  const GstVideoInfo info = caps_.info();
  BufferPtr buffer = paintScene(scene_, info);
  GST_BUFFER_PTS(buffer.get()) = nextTime();
  const auto flags = bytes_.take();
  if (flags & 1) GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_GAP);
  if (flags & 2) GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_CORRUPTED);
  if (flags & 4) GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT);
  if (flags & 8)
    gst_buffer_set_size(buffer.get(), static_cast<gssize>(bytes_.between<gsize>(0, info.size)));
  if (flags & 16) {
    GstVideoMeta* meta = gst_buffer_add_video_meta(
        buffer.get(), GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_INFO_FORMAT(&info),
        static_cast<guint>(caps_.width), static_cast<guint>(caps_.height));
    if (meta) {
      meta->n_planes = bytes_.between(0u, 5u);
      for (size_t i = 0; i < GST_VIDEO_MAX_PLANES; ++i) {
        meta->stride[i] = bytes_.flip() ? meta->stride[i] : bytes_.take<int32_t>();
        meta->offset[i] = bytes_.flip() ? meta->offset[i] : bytes_.take<uint64_t>();
      }
      if (bytes_.flip()) meta->width = bytes_.take<uint32_t>();
      if (bytes_.flip()) meta->height = bytes_.take<uint32_t>();
    }
  }
  if (flags & 32) addRandomRois(buffer.get(), bytes_);
  push(std::move(buffer));
}

void ChainProgram::pushEvent() {
  GstHarness* harness = chain_.harness();
  switch (bytes_.between(0, 7)) {
    case 0: {
      gst_harness_push_event(harness, gst_event_new_flush_start());
      gst_harness_push_event(harness, gst_event_new_flush_stop(bytes_.flip()));
      GstSegment segment;
      gst_segment_init(&segment, GST_FORMAT_TIME);
      gst_harness_push_event(harness, gst_event_new_segment(&segment));
      break;
    }
    case 1: {
      constexpr GstFormat kFormats[] = {GST_FORMAT_TIME, GST_FORMAT_BYTES, GST_FORMAT_DEFAULT};
      GstSegment segment;
      gst_segment_init(&segment, bytes_.pick(kFormats));
      segment.rate = bytes_.flip() ? 1 : -2;
      segment.start = bytes_.take<uint32_t>();
      segment.position = segment.time = segment.start;
      segment.base = bytes_.flip() ? 0 : bytes_.take<uint64_t>();
      gst_harness_push_event(harness, gst_event_new_segment(&segment));
      break;
    }
    case 2:
      gst_harness_push_event(harness, gst_event_new_eos());
      break;
    case 3:
      gst_harness_push_event(harness,
                             gst_event_new_stream_start(bytes_.flip() ? "one" : "another"));
      chain_.setCaps(caps_);
      break;
    case 4: {
      const GstClockTime time = nextTime(), duration = bytes_.take<uint64_t>();
      if (GST_CLOCK_TIME_IS_VALID(time))
        gst_harness_push_event(harness, gst_event_new_gap(time, duration));
      break;
    }
    case 5:
      gst_harness_push_upstream_event(harness, gst_event_new_reconfigure());
      break;
    case 6:
      gst_harness_push_event(harness, gst_event_new_flush_start());
      pushFrames(1);
      gst_harness_push_event(harness, gst_event_new_flush_stop(TRUE));
      break;
    default:
      gst_harness_push_event(harness, gst_event_new_custom(GST_EVENT_CUSTOM_DOWNSTREAM,
                                                           gst_structure_new_empty("unknown")));
  }
}

void ChainProgram::ask() {
  GstHarness* harness = chain_.harness();
  if (bytes_.flip()) {
    gst_harness_query_latency(harness);
    return;
  }
  GstCaps* caps = gst_caps_from_string(caps_.text().c_str());
  GstQuery* query = gst_query_new_allocation(caps, bytes_.flip());
  gst_pad_peer_query(harness->srcpad, query);
  gst_query_unref(query);
  gst_caps_unref(caps);
}

void ChainProgram::push(BufferPtr buffer) {
  --framesLeft_;
  pixelsLeft_ -= caps_.width * caps_.height;
  chain_.push(std::move(buffer));
  pullAll();
  emptyBus();
}

void ChainProgram::pullAll() {
  while (const BufferPtr buffer{gst_harness_try_pull(chain_.harness())}) readMetas(buffer.get());
}

void ChainProgram::emptyBus() {
  while (chain_.message(GST_MESSAGE_ANY)) {
  }
}

}  // namespace rg::fuzz
