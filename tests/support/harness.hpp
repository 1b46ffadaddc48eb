// SPDX-License-Identifier: LGPL-2.1-or-later
// GstHarness and what it gives back, owned.
#pragma once

#include <gst/check/gstharness.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace rg::testing {

struct Free {
  void operator()(GstHarness* harness) const { gst_harness_teardown(harness); }
  void operator()(GstBuffer* buffer) const { gst_buffer_unref(buffer); }
  void operator()(GstMessage* message) const { gst_message_unref(message); }
  void operator()(GstBus* bus) const { gst_object_unref(bus); }
};
using HarnessPtr = std::unique_ptr<GstHarness, Free>;
using BufferPtr = std::unique_ptr<GstBuffer, Free>;
using MessagePtr = std::unique_ptr<GstMessage, Free>;
using BusPtr = std::unique_ptr<GstBus, Free>;

inline constexpr const char* kAllFormats[] = {
    "BGRx",  "RGBx", "BGRA", "RGBA", "BGR",  "RGB", "NV12",      "I420",
    "GRAY8", "NV21", "YUY2", "UYVY", "Y42B", "GBR", "I420_10LE", "P010_10LE"};

struct Caps {
  const char* format = "BGRx";
  int width = 64;
  int height = 48;
  std::string framerate = "25/1";

  [[nodiscard]] std::string text() const {
    return std::string("video/x-raw,format=") + format + ",width=" + std::to_string(width) +
           ",height=" + std::to_string(height) + ",framerate=" + framerate;
  }
  [[nodiscard]] GstVideoInfo info() const {
    GstVideoInfo info;
    GstCaps* caps = gst_caps_from_string(text().c_str());
    gst_video_info_from_caps(&info, caps);
    gst_caps_unref(caps);
    return info;
  }
};

/// A chain of elements in a harness, a bus to listen to, and caps already sent.
class Chain {
 public:
  explicit Chain(const std::string& launchLine, const Caps& caps = {});
  ~Chain();
  Chain(const Chain&) = delete;
  Chain& operator=(const Chain&) = delete;

  [[nodiscard]] GstHarness* harness() const { return harness_.get(); }
  /// An element of the chain by its factory's name.
  [[nodiscard]] GstElement* element(const char* factory) const;
  void setCaps(const Caps& caps);
  [[nodiscard]] const Caps& caps() const { return caps_; }

  /// Pushes a frame; takes the reference.
  GstFlowReturn push(BufferPtr buffer);
  /// Pushes and pulls; null when nothing came out.
  [[nodiscard]] BufferPtr pass(BufferPtr buffer);
  /// The next message of a type on the bus, null when there is none.
  [[nodiscard]] MessagePtr message(GstMessageType type);
  /// Text and debug text of the next error or warning, empty when there is none.
  [[nodiscard]] std::string complaint(GstMessageType type);

 private:
  HarnessPtr harness_;
  BusPtr bus_;
  Caps caps_;
};

/// Grey level, or rather luma, of pixel (x, y).
using Painter = std::function<uint8_t(int x, int y)>;

/// A frame of one brightness per pixel (chroma neutral) and a PTS of `index` frames at 25 Hz.
[[nodiscard]] BufferPtr paint(const Caps& caps, int index, const Painter& painter);

/// The first sample of a component. Words lie at even bytes: GStreamer 1.22 says 1 for the Cr of
/// P010.
[[nodiscard]] inline uint8_t* firstSample(const GstVideoFrame& frame, guint component) {
  const bool isWord = GST_VIDEO_FORMAT_INFO_DEPTH(frame.info.finfo, component) > 8;
  const guint offset = GST_VIDEO_FORMAT_INFO_POFFSET(frame.info.finfo, component);
  return static_cast<uint8_t*>(
             frame.data[GST_VIDEO_FORMAT_INFO_PLANE(frame.info.finfo, component)]) +
         (isWord ? (offset + 1) / 2 * 2 : offset);
}

/// Writes a sample of 8 bits, or the upper 8 of a word's ten and the rest of these.
void putSample(GstVideoFrame& frame, guint component, int x, int y, uint8_t value, guint rest = 0);

/// A flat background with a bright square whose left upper corner is at (x, y).
[[nodiscard]] Painter square(int x, int y, int side);

/// The bytes of a buffer's whole memory.
[[nodiscard]] std::vector<uint8_t> bytesOf(GstBuffer* buffer);

/// Makes the plugin's elements available by name, without a registry. Call once, after gst_init.
void registerElements();

}  // namespace rg::testing
