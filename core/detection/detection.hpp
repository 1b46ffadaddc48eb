// SPDX-License-Identifier: LGPL-2.1-or-later
// Element haardetect: finds what a cascade of Haar features was trained for, in windows of all
// scales over a frame or areas of it (paper, section 3).
//
// Determinism: a window's number and place are integers; its decision takes floating-point
// operations that round by themselves, in one order (cascade_window.hpp). The same detections on
// every SIMD target, for any number of threads. Windows of an area are some of those of the whole
// frame, and are judged alike.
#pragma once

#include "core/base/memory/image.hpp"
#include "core/base/result.hpp"
#include "core/base/stage.hpp"
#include "core/detection/cascade.hpp"
#include "core/detection/grouping.hpp"
#include "core/detection/scale_model.hpp"
#include "core/detection/search_area.hpp"
#include "core/detection/search_windows.hpp"

#include <memory>
#include <span>
#include <vector>

namespace rg::detection {

struct Params {
  double scaleFactor = 1.1;  ///< From one size of windows to the next; at least 1.01.
  int minNeighbours = 3;     ///< That a window must have; 0 tells each window.
  int minHeightPx = 0;       ///< Of windows; 0 = as small as the cascade was trained with.
  int maxHeightPx = 0;       ///< 0 = as large as the frame.
};

/// What haardetect says of one frame.
struct Detections {
  std::vector<Detection> found;  ///< Sorted by row, then column.
  bool isCutShort = false;       ///< More windows agreed than are grouped (kMostGrouped).
};

class Stage {
 public:
  virtual ~Stage() = default;
  /// Looks in areas of a picture; those that touch are searched as the box round both. Errors: the
  /// cascade is null, a frame without pixels, numbers out of range.
  [[nodiscard]] virtual Result<Detections> process(ImageView<const uint8_t> luma,
                                                   std::span<const Box> areas,
                                                   const std::shared_ptr<const Cascade>& cascade,
                                                   const Params& params) = 0;
  /// Gives memory back.
  virtual void reset(Reset what) = 0;
};

[[nodiscard]] std::unique_ptr<Stage> makeStage(Context context);

}  // namespace rg::detection
