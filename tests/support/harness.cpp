// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/harness.hpp"

#include "gst/elements.hpp"

#include <cstring>

namespace rg::testing {

Chain::Chain(const std::string& launchLine, const Caps& caps)
    : harness_(gst_harness_new_parse(launchLine.c_str())), bus_(gst_bus_new()), caps_(caps) {
  gst_element_set_bus(harness_->element, bus_.get());
  setCaps(caps);
}

/// Messages that nobody took hold their element, which holds the bus: both would stay for ever.
Chain::~Chain() {
  gst_element_set_bus(harness_->element, nullptr);
  gst_bus_set_flushing(bus_.get(), TRUE);
}

GstElement* Chain::element(const char* factory) const {
  return gst_harness_find_element(harness_.get(), factory);
}

void Chain::setCaps(const Caps& caps) {
  caps_ = caps;
  gst_harness_set_src_caps_str(harness_.get(), caps.text().c_str());
}

GstFlowReturn Chain::push(BufferPtr buffer) {
  return gst_harness_push(harness_.get(), buffer.release());
}

BufferPtr Chain::pass(BufferPtr buffer) {
  return push(std::move(buffer)) == GST_FLOW_OK ? BufferPtr(gst_harness_try_pull(harness_.get()))
                                                : nullptr;
}

MessagePtr Chain::message(GstMessageType type) {
  return MessagePtr(gst_bus_pop_filtered(bus_.get(), type));
}

std::string Chain::complaint(GstMessageType type) {
  const MessagePtr message = this->message(type);
  if (!message) return {};
  GError* error = nullptr;
  gchar* debug = nullptr;
  if (type == GST_MESSAGE_ERROR)
    gst_message_parse_error(message.get(), &error, &debug);
  else
    gst_message_parse_warning(message.get(), &error, &debug);
  std::string text = std::string(error->message) + " " + (debug ? debug : "");
  g_error_free(error);
  g_free(debug);
  return text;
}

void putSample(GstVideoFrame& frame, guint component, int x, int y, uint8_t value, guint rest) {
  const GstVideoFormatInfo* format = frame.info.finfo;
  auto* at = firstSample(frame, component) + y * GST_VIDEO_FRAME_COMP_STRIDE(&frame, component) +
             x * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, component);
  const guint depth = GST_VIDEO_FORMAT_INFO_DEPTH(format, component);
  if (depth == 8) {
    *at = value;
  } else {
    const guint word = (guint{value} << (depth - 8) | rest)
                       << GST_VIDEO_FORMAT_INFO_SHIFT(format, component);
    at[0] = static_cast<uint8_t>(word);
    at[1] = static_cast<uint8_t>(word >> 8);
  }
}

BufferPtr paint(const Caps& caps, int index, const Painter& painter) {
  const GstVideoInfo info = caps.info();
  BufferPtr buffer(gst_buffer_new_allocate(nullptr, info.size, nullptr));
  gst_buffer_memset(buffer.get(), 0, 128, info.size);
  GstVideoFrame frame;
  gst_video_frame_map(&frame, &info, buffer.get(), GST_MAP_WRITE);
  for (guint i = 0; i < GST_VIDEO_FRAME_N_COMPONENTS(&frame); ++i) {
    const bool isPainted = GST_VIDEO_INFO_IS_RGB(&info) || i == 0;
    for (int y = 0; y < GST_VIDEO_FRAME_COMP_HEIGHT(&frame, i); ++y)
      for (int x = 0; x < GST_VIDEO_FRAME_COMP_WIDTH(&frame, i); ++x)
        putSample(frame, i, x, y, isPainted ? painter(x, y) : uint8_t{128});
  }
  gst_video_frame_unmap(&frame);
  GST_BUFFER_PTS(buffer.get()) = static_cast<GstClockTime>(index) * 40 * GST_MSECOND;
  GST_BUFFER_DURATION(buffer.get()) = 40 * GST_MSECOND;
  return buffer;
}

Painter square(int x, int y, int side) {
  return [=](int px, int py) -> uint8_t {
    const bool isInside = px >= x && px < x + side && py >= y && py < y + side;
    return isInside ? static_cast<uint8_t>(200 + (px - x + 2 * (py - y)) % 16) : uint8_t{60};
  };
}

std::vector<uint8_t> bytesOf(GstBuffer* buffer) {
  std::vector<uint8_t> bytes(gst_buffer_get_size(buffer));
  gst_buffer_extract(buffer, 0, bytes.data(), bytes.size());
  return bytes;
}

void registerElements() {
  GST_ELEMENT_REGISTER(bgremove, nullptr);
  GST_ELEMENT_REGISTER(hsvsegment, nullptr);
  GST_ELEMENT_REGISTER(srg, nullptr);
  GST_ELEMENT_REGISTER(prmmotion, nullptr);
  GST_ELEMENT_REGISTER(mrfmerge, nullptr);
  GST_ELEMENT_REGISTER(haardetect, nullptr);
  GST_ELEMENT_REGISTER(regionmask, nullptr);
  GST_ELEMENT_REGISTER(regiontext, nullptr);
  GST_ELEMENT_REGISTER(regiontrack, nullptr);
  GST_ELEMENT_REGISTER(regionwrite, nullptr);
#ifdef REGIONGRAPH_HAS_OVERLAY
  GST_ELEMENT_REGISTER(regionoverlay, nullptr);
#endif
}

}  // namespace rg::testing
