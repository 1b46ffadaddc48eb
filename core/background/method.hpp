// SPDX-License-Identifier: LGPL-2.1-or-later
// What the methods of bgremove have in common inside the stage. Not for other stages.
#pragma once

#include "core/background/background.hpp"
#include "core/background/operations.hpp"
#include "core/base/time/frame_clock.hpp"
#include "core/base/time/frame_count.hpp"

namespace rg::background {

/// One frame's work order. The stage has checked that the size is the model's.
struct MethodJob {
  std::shared_ptr<const Picture> picture;
  const Params& params;
  const FrameClock& clock;
  const Executor& executor;
  Operations& on;  ///< Of method hybrid; the others have their own.
};

/// While the camera moves nothing of the picture stands still.
inline void tellMoving(Foreground& out) {
  out.extent = boundsOf(out.size);
  out.mask.fill(kBackgroundPixel);
  out.scene.isCameraMoving = true;
}

class MethodModel {
 public:
  virtual ~MethodModel() = default;
  /// Allocates whatever segment() needs for such pictures. May throw; changes no model.
  virtual void prepare(const Picture& picture) = 0;
  /// Writes status, mask, extent and scene; then learns the frame. The mask has the picture's size
  /// and is background outside of the extent, which is that of an earlier frame.
  virtual void segment(const MethodJob& job, Foreground& out) = 0;
  /// The next frame does not follow the last one.
  virtual void breakOff() = 0;
};

[[nodiscard]] std::unique_ptr<MethodModel> makePaperMethod(const Context& context);
[[nodiscard]] std::unique_ptr<MethodModel> makeConsensusMethod();
[[nodiscard]] std::unique_ptr<MethodModel> makeDifferenceMethod(const Context& context);

}  // namespace rg::background
