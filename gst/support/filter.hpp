// SPDX-License-Identifier: LGPL-2.1-or-later
// The shell that all in-place elements share: a GstBaseTransform that owns a C++ object, turns its
// exceptions into errors on the bus, and tells it about frames, times and resets.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/stage.hpp"
#include "gst/support/properties.hpp"
#include "gst/support/stream_clock.hpp"

#include <gst/base/gstbasetransform.h>
#include <gst/video/video.h>

#include <atomic>
#include <mutex>
#include <span>
#include <string>

namespace rg {

class Filter;

/// Everything about an element's type that is not behaviour.
struct FilterDescription {
  const char* elementName;  ///< As in gst-launch; also its debug category.
  const char* typeName;
  const char* longName;
  const char* klass;
  const char* description;
  const char* example;  ///< A launch line that runs as it stands.
  const char* caps;     ///< Of both pads, or of the sink pad.
  std::span<const Property> properties;
  const void* defaults;  ///< A fresh struct of settings.
  Filter* (*create)(GstBaseTransform* element);
  const char* action = nullptr;   ///< Name of a signal that calls act().
  const char* srcCaps = nullptr;  ///< Where what leaves is no video: of the source pad.
  bool takesCrops = false;        ///< Whether a GstVideoCropMeta on frames is followed.
};

/// The formats whose pixels the elements read, in system memory, up to 16384 pixels a side.
extern const char* const kPixelCaps;
/// Any raw video in any memory, for elements that read metas only.
extern const char* const kMetaCaps;

/// False, with an error on the bus, for frames of more pixels than labels and sums are sized for.
bool acceptsSize(gpointer element, const GstVideoInfo& info);

/// Registers the element's type; for use in a function-local static.
GType registerFilter(const FilterDescription& description);

/// Of a type that was registered so.
[[nodiscard]] const FilterDescription& descriptionOf(GType type);

/// One frame on its way through an element.
struct FilterFrame {
  GstBuffer* buffer;         ///< Metas may be added, pixels are shared.
  const GstVideoInfo& info;  ///< Of the negotiated caps.
  FrameTime time;
  bool isFirst;          ///< First since the caps: what is missing here was never there.
  bool isDownstreamNew;  ///< First since the caps, or since downstream asked to negotiate again.
  bool isUsable;  ///< False for GAP and CORRUPTED buffers: to be skipped, nothing to be learnt.
};

[[nodiscard]] inline Size sizeOf(const FilterFrame& frame) {
  return {GST_VIDEO_INFO_WIDTH(&frame.info), GST_VIDEO_INFO_HEIGHT(&frame.info)};
}

/// Base of the C++ objects behind the elements. All but the properties runs on the streaming
/// thread.
class Filter {
 public:
  explicit Filter(GstBaseTransform* element) : element_(element) {}
  virtual ~Filter() = default;
  Filter(const Filter&) = delete;
  Filter& operator=(const Filter&) = delete;

  /// The struct that the properties' table describes; guarded by settingsMutex().
  virtual void* settings() = 0;
  /// False after an error was posted.
  virtual bool start() { return true; }
  virtual void stop() {}
  virtual void reset(Reset what) { (void)what; }
  virtual void endOfStream() {}
  virtual GstFlowReturn process(const FilterFrame& frame) = 0;
  /// Behind process(): how long that took.
  virtual void finish(const FilterFrame& frame, GstClockTime took) {
    (void)frame;
    (void)took;
  }
  /// What leaves instead of a processed frame; takes the frame.
  [[nodiscard]] virtual GstBuffer* render(GstBuffer* frame) { return frame; }
  /// The action signal, on any thread.
  virtual void act() {}

  /// How long frames are held back, nanoseconds; the pipeline is told. Constant while running,
  /// asked on any thread. Where it is not 0, processed frames go through hold() and leave by
  /// release().
  [[nodiscard]] virtual GstClockTime latency() { return 0; }
  /// Takes a processed frame.
  virtual void hold(GstBuffer* buffer) { gst_buffer_unref(buffer); }
  /// The next frame to send, or null while none is due; if isEnd, all that are held are due.
  [[nodiscard]] virtual GstBuffer* release(bool isEnd) {
    (void)isEnd;
    return nullptr;
  }
  virtual void dropHeld() {}

  [[nodiscard]] std::mutex& settingsMutex() { return settingsMutex_; }
  [[nodiscard]] GstBaseTransform* element() const { return element_; }
  [[nodiscard]] GstDebugCategory* category() const;

 protected:
  /// A copy of the settings as they are now.
  template <class Settings>
  [[nodiscard]] Settings snapshot(const Settings& settings) {
    const std::lock_guard lock(settingsMutex_);
    return settings;
  }
  /// How many frames may be held, of the caps as they are; see gst/support/frame_hold.hpp.
  [[nodiscard]] guint64 mostHeld() const;
  /// Sends the frames that are held, before something that ends what they belong to.
  void sendHeld();
  void postWarning(const std::string& text) const;
  /// Posts that the stream can't be processed, with the remedy.
  GstFlowReturn postError(const std::string& text) const;

 private:
  friend struct FilterShell;

  void setRunning(bool isRunning);

  GstBaseTransform* const element_;
  std::mutex settingsMutex_;  ///< Protects the settings; held for a copy, never while calling out.
  bool isRunning_ = false;    ///< Guarded by it: what is Mutable::Ready is in force.
  GstVideoInfo info_{};
  bool hasCaps_ = false;
  bool isFirst_ = true;
  std::atomic<bool> isDownstreamNew_ = true;    ///< Set by the thread that downstream asks on.
  std::atomic<GstClockTime> wholeLatency_ = 0;  ///< As reported; asked for on any thread.
  std::string streamId_;
  StreamClock clock_;
};

}  // namespace rg
