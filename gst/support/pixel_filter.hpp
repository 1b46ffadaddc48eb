// SPDX-License-Identifier: LGPL-2.1-or-later
// What the stage elements share that look at pixels.
#pragma once

#include "core/base/memory/pool.hpp"
#include "core/base/picture.hpp"
#include "core/base/result.hpp"
#include "gst/support/mapped_frame.hpp"
#include "gst/support/stage_filter.hpp"

#include <memory>
#include <mutex>

namespace rg {

struct PixelSettings : StageSettings {
  guint64 badBuffers = 0;
};

template <class Settings>
constexpr Property badBuffersProperty() {
  return property<Settings, &Settings::badBuffers>("bad-buffers",
                                                   "Frames passed on unread, because their memory "
                                                   "is not what their caps or GstVideoMeta promise",
                                                   0, 0, Mutable::Never);
}

/// A stage element that reads frames itself.
template <class Settings, class Stage>
class PixelFilter : public StageOwner<Settings, Stage> {
 public:
  using StageOwner<Settings, Stage>::StageOwner;

  void reset(Reset what) override {
    if (what == Reset::Stream) pool_.drop();
    StageOwner<Settings, Stage>::reset(what);
  }

 protected:
  /// Maps, checks and converts a frame; counts those whose memory can't be believed.
  [[nodiscard]] Result<std::shared_ptr<const Picture>> load(const FilterFrame& frame) {
    const MappedFrame mapped(frame.buffer, frame.info);
    if (!mapped.frame()) {
      const std::lock_guard lock(this->settingsMutex());
      ++this->settings_.badBuffers;
      return mapped.frame().error();
    }
    auto picture = pool_.take();
    picture->load(*mapped.frame(), this->executor());
    return std::shared_ptr<const Picture>(std::move(picture));
  }

 private:
  Pool<Picture> pool_;
};

}  // namespace rg
