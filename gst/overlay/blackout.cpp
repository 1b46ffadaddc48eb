// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/blackout.hpp"

#include "core/base/mapping.hpp"
#include "core/text/text.hpp"
#include "gst/support/foreign_enum.hpp"

#include <algorithm>
#include <vector>

namespace rg::overlay {
namespace {

constexpr uint8_t kNeutralChroma = 128;
constexpr uint8_t kLimitedBlack = 16;

template <class Value, class IsKept>
void mark(const ResultPlane<Value>& plane, Image<uint8_t>& keep, IsKept isKept) {
  if (plane.pixelSize().isEmpty()) return keep.fill(0);
  std::vector<Value> scratch;
  const FrameMap map{plane.pixelSize(), keep.size()};
  const bool isScaled = map.from != map.to;
  for (int y = 0; y < keep.height(); ++y) {
    const Value* values = plane.unpackedRow(map.sourceY(y), scratch);
    uint8_t* kept = keep.row(y);
    for (int x = 0; x < keep.width(); ++x)
      kept[x] = isKept(values[isScaled ? map.sourceX(x) : x]) ? 1 : 0;
  }
}

uint8_t* sampleRow(GstVideoFrame* frame, int component, int row) {
  return static_cast<uint8_t*>(GST_VIDEO_FRAME_COMP_DATA(frame, component)) +
         ptrdiff_t{row} * GST_VIDEO_FRAME_COMP_STRIDE(frame, component);
}

/// One component: red, green, blue or luma; `black` is its darkest value.
void blackenFull(GstVideoFrame* frame, int component, const Image<uint8_t>& keep, uint8_t black) {
  const int step = GST_VIDEO_FRAME_COMP_PSTRIDE(frame, component);
  for (int y = 0; y < keep.height(); ++y) {
    uint8_t* samples = sampleRow(frame, component, y);
    const uint8_t* kept = keep.row(y);
    for (int x = 0; x < keep.width(); ++x) {
      uint8_t& sample = samples[ptrdiff_t{x} * step];
      sample = kept[x] ? sample : black;
    }
  }
}

void blackenChroma(GstVideoFrame* frame, int component, const Image<uint8_t>& keep) {
  const int step = GST_VIDEO_FRAME_COMP_PSTRIDE(frame, component);
  for (int y = 0; y < keep.height(); y += 2) {
    uint8_t* samples = sampleRow(frame, component, y / 2);
    const uint8_t* upper = keep.row(y);
    const uint8_t* lower = keep.row(std::min(y + 1, keep.height() - 1));
    for (int x = 0; x < keep.width(); x += 2) {
      const int right = std::min(x + 1, keep.width() - 1);
      uint8_t& sample = samples[ptrdiff_t{x / 2} * step];
      sample = (upper[x] | upper[right] | lower[x] | lower[right]) ? sample : kNeutralChroma;
    }
  }
}

}  // namespace

void markObjects(const objects::Objects& objects, Image<uint8_t>& keep) {
  mark(objects.slots, keep, [&](uint16_t number) {
    const auto slot = objects::Slot::ofNumber(number);
    return slot && slot.index() < objects.objects.size() &&
           objects::isListed(objects.objects[slot.index()].state);
  });
}

void markForeground(const background::Foreground& foreground, Image<uint8_t>& keep) {
  mark(foreground.mask, keep, [](uint8_t value) { return value == background::kForegroundPixel; });
}

void blacken(GstVideoFrame* frame, const Image<uint8_t>& keep) {
  const GstVideoInfo& info = frame->info;
  if (GST_VIDEO_INFO_IS_RGB(&info)) {
    for (int component = 0; component < 3; ++component) blackenFull(frame, component, keep, 0);
    return;
  }
  const bool isFull = GST_VIDEO_INFO_IS_GRAY(&info) ||
                      numberIn(info.colorimetry.range) == GST_VIDEO_COLOR_RANGE_0_255;
  blackenFull(frame, 0, keep, isFull ? 0 : kLimitedBlack);
  if (!GST_VIDEO_INFO_IS_YUV(&info)) return;
  for (int component = 1; component < 3; ++component) blackenChroma(frame, component, keep);
}

}  // namespace rg::overlay
