// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/mask_painter.hpp"

#include "core/base/mapping.hpp"
#include "gst/support/shown_result.hpp"

#include <cstring>
#include <vector>

namespace rg {
namespace {

constexpr uint8_t kWhite = 255;

uint8_t* rowOf(GstVideoFrame* frame, int y) {
  return static_cast<uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(frame, 0)) +
         ptrdiff_t{y} * GST_VIDEO_FRAME_PLANE_STRIDE(frame, 0);
}

int bytesOfRow(const GstVideoFrame* to) {
  return GST_VIDEO_FRAME_WIDTH(to) * GST_VIDEO_FRAME_COMP_PSTRIDE(to, 0);
}

void paintBlack(GstVideoFrame* to) {
  const auto bytes = static_cast<size_t>(bytesOfRow(to));
  for (int y = 0; y < GST_VIDEO_FRAME_HEIGHT(to); ++y) std::memset(rowOf(to, y), 0, bytes);
}

/// A file of frames holds what is behind their rows, too: not what the process had there before.
/// Behind rows of another stride than the usual one there may be somebody else's pixels.
void clearPadding(GstVideoFrame* to) {
  const int bytes = bytesOfRow(to), stride = GST_VIDEO_FRAME_PLANE_STRIDE(to, 0);
  if (stride != GST_ROUND_UP_4(bytes)) return;
  for (int y = 0; y < GST_VIDEO_FRAME_HEIGHT(to); ++y)
    std::memset(rowOf(to, y) + bytes, 0, static_cast<size_t>(stride - bytes));
}

/// shade() turns a value of the result into a pixel as it lies in memory.
template <class Value, class Shade>
void paint(const ResultPlane<Value>& plane, GstVideoFrame* to, Shade shade) {
  if (plane.pixelSize().isEmpty()) return paintBlack(to);
  std::vector<Value> scratch, lower, half;
  const FrameMap map{plane.pixelSize(), {GST_VIDEO_FRAME_WIDTH(to), GST_VIDEO_FRAME_HEIGHT(to)}};
  const bool isHalved = map.from == doubled(map.to);
  const bool isScaled = !isHalved && map.from != map.to;
  if (isHalved) half.resize(static_cast<size_t>(map.to.width));
  for (int y = 0; y < map.to.height; ++y) {
    const Value* values = plane.unpackedRow(isHalved ? 2 * y : map.sourceY(y), scratch);
    if (isHalved) {
      halveRows(values, plane.unpackedRow(2 * y + 1, lower), map.to.width, half.data());
      values = half.data();
    }
    uint8_t* pixels = rowOf(to, y);
    for (int x = 0; x < map.to.width; ++x) {
      const auto pixel = shade(values[isScaled ? map.sourceX(x) : x]);
      std::memcpy(pixels + static_cast<size_t>(x) * sizeof pixel, &pixel, sizeof pixel);
    }
  }
}

void paintForeground(const background::Foreground& foreground, GstVideoFrame* to) {
  paint(foreground.mask, to, [](uint8_t value) -> uint8_t {
    return value == background::kForegroundPixel ? kWhite : 0;
  });
}

void paintLabels(const segmentation::Labels& labels, GstVideoFrame* to) {
  if (GST_VIDEO_FRAME_FORMAT(to) == GST_VIDEO_FORMAT_GRAY16_BE)
    paint(labels.ids, to, [](uint16_t label) { return GUINT16_TO_BE(label); });
  else
    paint(labels.ids, to, [](uint16_t label) { return GUINT16_TO_LE(label); });
}

void paintObjects(const objects::Objects& objects, GstVideoFrame* to) {
  paint(objects.slots, to, [&](uint16_t number) -> uint8_t {
    const auto slot = objects::Slot::ofNumber(number);
    if (!slot || slot.index() >= objects.objects.size()) return 0;
    const objects::ObjectState state = objects.objects[slot.index()].state;
    return state == objects::ObjectState::Tracked || state == objects::ObjectState::Stopped ? kWhite
                                                                                            : 0;
  });
}

template <class Payload, class Paint>
bool paintResult(GstBuffer* from, GstVideoFrame* to, Paint paintOne) {
  const auto result =
      findShown<Payload>(from, {GST_VIDEO_FRAME_WIDTH(to), GST_VIDEO_FRAME_HEIGHT(to)});
  if (result && result->status != Status::Skipped)
    paintOne(*result, to);
  else
    paintBlack(to);
  return result != nullptr;
}

/// A frame without a decision is one without a result, unless it was skipped.
bool paintHue(GstBuffer* from, GstVideoFrame* to) {
  bool isDecided = true;
  const bool wasThere = paintResult<segmentation::Labels>(
      from, to, [&](const segmentation::Labels& labels, GstVideoFrame* out) {
        isDecided = !labels.hue.pixelSize().isEmpty();
        paint(labels.hue, out, [](uint8_t value) { return value; });
      });
  return wasThere && isDecided;
}

}  // namespace

const char* producerOf(MaskSource source) {
  switch (source) {
    case MaskSource::Foreground:
      return "bgremove";
    case MaskSource::Labels:
      return "hsvsegment";
    case MaskSource::Hue:
      return "hsvsegment with background-hue or object-hue";
    case MaskSource::Objects:
      break;
  }
  return "mrfmerge";
}

void setFormats(GstStructure* caps, MaskSource source) {
  if (source != MaskSource::Labels) {
    gst_structure_set(caps, "format", G_TYPE_STRING, "GRAY8", nullptr);
    return;
  }
  GValue formats = G_VALUE_INIT;
  g_value_init(&formats, GST_TYPE_LIST);
  for (const char* name : {"GRAY16_BE", "GRAY16_LE"}) {
    GValue format = G_VALUE_INIT;
    g_value_init(&format, G_TYPE_STRING);
    g_value_set_static_string(&format, name);
    gst_value_list_append_and_take_value(&formats, &format);
  }
  gst_structure_take_value(caps, "format", &formats);
}

bool paintMask(MaskSource source, GstBuffer* from, GstVideoFrame* to) {
  clearPadding(to);
  switch (source) {
    case MaskSource::Foreground:
      return paintResult<background::Foreground>(from, to, paintForeground);
    case MaskSource::Labels:
      return paintResult<segmentation::Labels>(from, to, paintLabels);
    case MaskSource::Hue:
      return paintHue(from, to);
    case MaskSource::Objects:
      break;
  }
  return paintResult<objects::Objects>(from, to, paintObjects);
}

}  // namespace rg
