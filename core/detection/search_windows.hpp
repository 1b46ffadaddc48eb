// SPDX-License-Identifier: LGPL-2.1-or-later
// Search windows by number: which scale, column and row a window's id stands for, and back (paper,
// section 3, equations (3) to (12), with the errors that README.md lists put right).
//
// Ids count through the scales, in each scale through the areas that are searched, in each area
// through the rows, in each row through the columns, without gaps. What stands in one area and one
// scale is a range (the paper's W_range). The mapping is exact and takes integers only; all threads
// of a warp take the same steps, whatever their ids.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/result.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::detection {

/// One size of windows. Columns and rows of windows are multiples of the step from the frame's
/// corner, so that those inside of an area are some of those of the whole frame.
struct Scale {
  double factor = 1;  ///< Of the window that the cascade was trained with.
  Size window;        ///< That window times the factor, rounded, halves upwards.
  int stepPx = 1;     ///< Between neighbours, in both directions.
  friend bool operator==(const Scale&, const Scale&) = default;
};

/// Which windows a frame is searched with.
struct ScaleParams {
  Size frame;
  Size window;  ///< That the cascade was trained with.
  double scaleFactor = 1.1;
  double firstScale = 1;
  /// Between neighbours, in pixels of the unscaled window: below scale 2, and from there on. The
  /// step in the frame is this times the scale, rounded, halves upwards, and at least a pixel.
  double fineStep = 2, coarseStep = 1;
  Size least = {}, most = {};  ///< Of windows in the frame; a side of 0 = any.
};

/// From the smallest scale to the largest window that fits into the frame. Errors: a window or
/// frame without pixels, a factor that does not grow or needs more than 1024 scales, steps or a
/// first scale that are not above 0. Windows of more than kMostWindowPx pixels are left out.
[[nodiscard]] Result<std::vector<Scale>> scalesOf(const ScaleParams& params);

/// So that sums of a window's pixels fit into 31 bits.
inline constexpr int64_t kMostWindowPx = int64_t{1} << 23;

/// The windows of one scale in one area.
struct WindowRange {
  uint32_t firstId = 0;
  int scale = 0;  ///< Its index.
  int area = 0;   ///< Its index.
  Point origin;   ///< Of the first window.
  int stepPx = 1;
  int columns = 0, rows = 0;
};

/// A window: its range, and its place in the frame.
struct WindowPlace {
  int range = 0;
  Point at;
  friend constexpr bool operator==(const WindowPlace&, const WindowPlace&) = default;
};

/// What a kernel is given. `firstIds` and `ranges` have a power of two of entries, of which those
/// behind the last range begin behind every id.
struct WindowTable {
  const uint32_t* firstIds = nullptr;
  const WindowRange* ranges = nullptr;
  int entries = 1;
  uint32_t count = 0;  ///< Of windows.
};

/// The last range that begins at or before the id, and has windows. In place of the paper's
/// equations (7) to (9), which take a product for each range: as many steps as the number of
/// entries has bits, each a comparison and a choice.
[[nodiscard]] constexpr int rangeOf(const WindowTable& table, uint32_t id) {
  int range = 0;
  for (int half = table.entries / 2; half > 0; half /= 2)
    range += table.firstIds[range + half] <= id ? half : 0;
  return range;
}

/// The window of an id below the table's count.
[[nodiscard]] constexpr WindowPlace placeOf(const WindowTable& table, uint32_t id) {
  const int index = rangeOf(table, id);
  const WindowRange& range = table.ranges[index];
  const uint32_t within = id - range.firstId;
  const auto columns = static_cast<uint32_t>(range.columns);
  const uint32_t row = within / columns;
  const uint32_t column = within - row * columns;
  return {index,
          {range.origin.x + static_cast<int>(column) * range.stepPx,
           range.origin.y + static_cast<int>(row) * range.stepPx}};
}

/// The way back. The place must be one of the range's.
[[nodiscard]] constexpr uint32_t idOf(const WindowTable& table, const WindowPlace& place) {
  const WindowRange& range = table.ranges[place.range];
  const int column = (place.at.x - range.origin.x) / range.stepPx;
  const int row = (place.at.y - range.origin.y) / range.stepPx;
  return range.firstId + static_cast<uint32_t>(row) * static_cast<uint32_t>(range.columns) +
         static_cast<uint32_t>(column);
}

/// The table and its memory.
class SearchWindows {
 public:
  /// Lays windows of these scales over areas; windows lie inside of one area each. Areas must lie
  /// in the first quadrant. Keeps its memory from call to call. Error: more windows than ids.
  [[nodiscard]] Result<bool> lay(std::span<const Scale> scales, std::span<const Box> areas);

  [[nodiscard]] WindowTable table() const;
  /// As many as there are scales times areas; some may be without windows.
  [[nodiscard]] std::span<const WindowRange> ranges() const {
    return std::span(ranges_).first(used_);
  }

 private:
  std::vector<uint32_t> firstIds_;
  std::vector<WindowRange> ranges_;
  size_t used_ = 0;
  uint32_t count_ = 0;
};

}  // namespace rg::detection
