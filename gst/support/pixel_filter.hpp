// SPDX-License-Identifier: LGPL-2.1-or-later
// What the stage elements share that look at pixels.
#pragma once

#include "core/base/memory/frame_reader.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/picture.hpp"
#include "core/base/reduced_frame.hpp"
#include "core/base/result.hpp"
#include "gst/support/cuda_memory.hpp"
#include "gst/support/mapped_frame.hpp"
#include "gst/support/stage_filter.hpp"

#include <memory>
#include <mutex>
#include <utility>

namespace rg {

/// Of analysis-height: as usualSize() says, and frames as they are.
inline constexpr int kUsualHeight = -1, kHeightOfFrame = 0;

struct PixelSettings : StageSettings {
  guint64 badBuffers = 0;
  int analysisHeight = kUsualHeight;
};

template <class Settings>
constexpr Property badBuffersProperty() {
  return property<Settings, &Settings::badBuffers>("bad-buffers",
                                                   "Frames passed on unread, because their memory "
                                                   "is not what their caps or GstVideoMeta promise",
                                                   0, 0, Mutable::Never);
}

template <class Settings>
constexpr Property analysisHeightProperty() {
  return property<Settings, &Settings::analysisHeight>(
      "analysis-height",
      "Rows of the picture that the stages look at; frames with more are scaled down for them, in "
      "their shape, which makes cameras of many pixels cheap. All that is told of objects, and all "
      "properties in pixels, as max-shift, are still in pixels of the frame. At least 1/128 of the "
      "frame's. 0 = the frame as it is. -1 = the same, but frames of 96 to 299 rows "
      "are looked at twice as large, where things are found that are too small otherwise, unless "
      "bgremove starts with another method than hybrid. Behind bgremove it is as there",
      kUsualHeight, 16384, Mutable::Ready);
}

/// A stage element that reads frames itself.
template <class Settings, class Stage>
class PixelFilter : public StageOwner<Settings, Stage> {
 public:
  using StageOwner<Settings, Stage>::StageOwner;

  bool start() override { return startAt(kUsualHeight); }
  /// Pictures may have a copy on the device that goes now.
  void stop() override {
    StageOwner<Settings, Stage>::stop();
    pool_.drop();
  }
  void reset(Reset what) override {
    if (what == Reset::Stream) pool_.drop();
    StageOwner<Settings, Stage>::reset(what);
  }

 protected:
  /// `usual` is the height where nothing is asked for.
  bool startAt(int usual) {
    const Settings settings = this->currentSettings();
    analysisHeight_ = settings.analysisHeight == kUsualHeight ? usual : settings.analysisHeight;
    if constexpr (kHasBackend<Settings>) deviceId_ = settings.deviceId;
    hasToldInterlaced_ = false;
    return StageOwner<Settings, Stage>::start();
  }
  [[nodiscard]] Size analysedSize(const FilterFrame& frame) const override {
    const Size size = sizeOf(frame);
    return analysisHeight_ == kUsualHeight ? usualSize(size) : reducedSize(size, analysisHeight_);
  }
  /// Maps, checks and converts a frame; counts those whose memory can't be believed.
  [[nodiscard]] Result<std::shared_ptr<const Picture>> load(const FilterFrame& frame) {
    auto picture = pool_.take();
    if (loadOnDevice(frame, *picture)) return std::shared_ptr<const Picture>(std::move(picture));
    const MappedFrame mapped(frame.buffer, frame.info);
    if (!mapped.frame()) {
      const std::lock_guard lock(this->settingsMutex());
      ++this->settings_.badBuffers;
      return mapped.frame().error();
    }
    tellInterlaced(*mapped.frame());
    const Size size = PixelFilter::analysedSize(frame);
    if (size == mapped.frame()->size()) {
      picture->load(*mapped.frame(), this->executor());
    } else if (size == doubled(mapped.frame()->size())) {
      small_.load(*mapped.frame(), this->executor());
      picture->loadDoubled(small_, this->executor());
    } else {
      reduced_.load(*mapped.frame(), size, this->executor());
      picture->load(reduced_.view(), this->executor());
    }
    return std::shared_ptr<const Picture>(std::move(picture));
  }

 private:
  /// Whether the frame lies on the stage's device, and was read there. The host reads what can't be
  /// read there.
  bool loadOnDevice(const FilterFrame& frame, Picture& picture) {
    Device* device = this->device();
    auto* reader = dynamic_cast<FrameReader*>(device);
    if (reader == nullptr || PixelFilter::analysedSize(frame) != sizeOf(frame)) return false;
    const auto flags = cudaMapOf(frame.buffer, deviceId_);
    if (!flags) return false;
    const MappedFrame mapped(frame.buffer, frame.info, *flags);
    if (!mapped.frame()) return false;
    tellInterlaced(*mapped.frame());
    try {
      reader->load(*mapped.frame(), picture);
      return true;
    } catch (const DeviceError& error) {
      device->fail(error);
      return false;
    }
  }
  void tellInterlaced(const Frame& frame) {
    if (frame.layout().isInterlaced && !std::exchange(hasToldInterlaced_, true))
      this->postWarning(
          "The video is interlaced: of each frame only the lines of the field with the top line "
          "are looked at, so that what moves is no comb. Put deinterlace in front of this element "
          "for all lines.");
  }

  int analysisHeight_ = kUsualHeight;  ///< As at the start.
  int deviceId_ = 0;                   ///< The same.
  bool hasToldInterlaced_ = false;     ///< Since the start.
  ReducedFrame reduced_;
  Picture small_;  ///< That is to be doubled.
  Pool<Picture> pool_;
};

}  // namespace rg
