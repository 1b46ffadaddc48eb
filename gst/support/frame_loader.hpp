// SPDX-License-Identifier: LGPL-2.1-or-later
// From a buffer to the picture that the stages look at.
#pragma once

#include "core/executor.hpp"
#include "core/picture.hpp"
#include "core/pool.hpp"
#include "core/result.hpp"
#include "gst/support/mapped_frame.hpp"

#include <memory>

namespace rg {

/// Maps, checks and converts frames; the pictures' memory is used again.
class FrameLoader {
 public:
  [[nodiscard]] Result<std::shared_ptr<const Picture>> load(GstBuffer* buffer,
                                                            const GstVideoInfo& info,
                                                            const Executor& executor) {
    const MappedFrame mapped(buffer, info);
    if (!mapped.frame()) return mapped.frame().error();
    auto picture = pool_.take();
    picture->load(*mapped.frame(), executor);
    return std::shared_ptr<const Picture>(std::move(picture));
  }

 private:
  Pool<Picture> pool_;
};

}  // namespace rg
