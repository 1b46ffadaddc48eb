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

/// The samples of one component, of a byte or of a word whose low byte comes first.
class Samples {
 public:
  Samples(GstVideoFrame* frame, int component)
      : first_(firstOf(frame, component)),
        stride_(GST_VIDEO_FRAME_COMP_STRIDE(frame, component)),
        step_(GST_VIDEO_FRAME_COMP_PSTRIDE(frame, component)),
        bits_(static_cast<int>(GST_VIDEO_FORMAT_INFO_DEPTH(frame->info.finfo, component))),
        shift_(static_cast<int>(GST_VIDEO_FORMAT_INFO_SHIFT(frame->info.finfo, component))) {}

  /// Writes a level of 8 bits into the samples of a row that are not kept.
  template <class IsKept>
  void fill(int row, int columns, uint8_t level, IsKept isKept) const {
    uint8_t* at = first_ + ptrdiff_t{row} * stride_;
    const int word = bits_ > 8 ? level << (bits_ - 8) << shift_ : level;
    for (int x = 0; x < columns; ++x, at += step_) {
      const bool keeps = isKept(x);
      at[0] = keeps ? at[0] : static_cast<uint8_t>(word);
      if (bits_ > 8) at[1] = keeps ? at[1] : static_cast<uint8_t>(word >> 8);
    }
  }

 private:
  /// Words lie at even bytes: GStreamer 1.22 says 1 for the Cr of P010.
  static uint8_t* firstOf(GstVideoFrame* frame, int component) {
    const GstVideoFormatInfo* format = frame->info.finfo;
    const guint offset = GST_VIDEO_FORMAT_INFO_POFFSET(format, component);
    return static_cast<uint8_t*>(frame->data[GST_VIDEO_FORMAT_INFO_PLANE(format, component)]) +
           (GST_VIDEO_FORMAT_INFO_DEPTH(format, component) > 8 ? (offset + 1) / 2 * 2 : offset);
  }

  uint8_t* first_;
  ptrdiff_t stride_, step_;
  int bits_, shift_;
};

/// One component: red, green, blue or luma; `black` is its darkest value.
void blackenFull(GstVideoFrame* frame, int component, const Image<uint8_t>& keep, uint8_t black) {
  const Samples samples(frame, component);
  for (int y = 0; y < keep.height(); ++y) {
    const uint8_t* kept = keep.row(y);
    samples.fill(y, keep.width(), black, [&](int x) { return kept[x] != 0; });
  }
}

/// A sample stays where one of its pixels does.
void blackenChroma(GstVideoFrame* frame, int component, const Image<uint8_t>& keep) {
  const Samples samples(frame, component);
  const int rowsEach = 1 << GST_VIDEO_FORMAT_INFO_H_SUB(frame->info.finfo, component);
  for (int y = 0; y < keep.height(); y += rowsEach) {
    const uint8_t* upper = keep.row(y);
    const uint8_t* lower = keep.row(std::min(y + rowsEach - 1, keep.height() - 1));
    samples.fill(y / rowsEach, (keep.width() + 1) / 2, kNeutralChroma, [&](int x) {
      const int left = 2 * x, right = std::min(left + 1, keep.width() - 1);
      return (upper[left] | upper[right] | lower[left] | lower[right]) != 0;
    });
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
