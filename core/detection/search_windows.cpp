// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/search_windows.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace rg::detection {
namespace {

constexpr int kMostScales = 1024;

/// Nearest integer, halves upwards, of what fits into an int.
int nearest(double value) {
  return static_cast<int>(std::floor(value + .5));
}

/// 0 = any.
bool isWithin(Size window, Size least, Size most) {
  return window.width >= least.width && window.height >= least.height &&
         (most.width == 0 || window.width <= most.width) &&
         (most.height == 0 || window.height <= most.height);
}

/// The first multiple of the step that is not before `from`.
int firstAt(int from, int step) {
  return (from + step - 1) / step * step;
}

/// How many windows of a length fit between two places.
int countIn(int from, int to, int length, int step) {
  return to - from < length ? 0 : (to - from - length) / step + 1;
}

Result<bool> check(const ScaleParams& p) {
  if (p.frame.isEmpty() || p.window.isEmpty()) return Error{"the window or the frame is empty"};
  if (!(p.scaleFactor > 1)) return Error{"the scale factor must be above 1"};
  if (!(p.firstScale > 0) || !(p.fineStep > 0) || !(p.coarseStep > 0))
    return Error{"the first scale and the steps must be above 0"};
  return true;
}

}  // namespace

Result<std::vector<Scale>> scalesOf(const ScaleParams& params) {
  if (const auto checked = check(params); !checked) return checked.error();
  std::vector<Scale> scales;
  int tried = 0;
  double next = params.firstScale;
  while (true) {
    const double factor = std::exchange(next, next * params.scaleFactor);
    const double width = params.window.width * factor, height = params.window.height * factor;
    // Compared as they are: what is far beyond the frame fits into no int.
    if (width > params.frame.width + 1.0 || height > params.frame.height + 1.0) break;
    const Size window{nearest(width), nearest(height)};
    if (window.width > params.frame.width || window.height > params.frame.height) break;
    if (++tried > kMostScales) return Error{"there are too many scales: use a larger scale factor"};
    if (window.isEmpty() || window.area() > kMostWindowPx) continue;
    if (!isWithin(window, params.least, params.most)) continue;
    const double step = (factor < 2 ? params.fineStep : params.coarseStep) * factor;
    const double side = std::max(params.frame.width, params.frame.height);
    scales.push_back({factor, window, std::max(1, nearest(std::min(step, side)))});
  }
  return scales;
}

Result<bool> SearchWindows::lay(std::span<const Scale> scales, std::span<const Box> areas) {
  used_ = scales.size() * areas.size();
  const size_t entries = std::bit_ceil(std::max<size_t>(used_, 1));
  ranges_.assign(entries, {});
  firstIds_.assign(entries, UINT32_MAX);
  uint64_t count = 0;
  size_t at = 0;
  for (size_t s = 0; s < scales.size(); ++s)
    for (size_t a = 0; a < areas.size(); ++a, ++at) {
      const Scale& scale = scales[s];
      const Box& area = areas[a];
      const int step = scale.stepPx;
      const Point origin{firstAt(area.x, step), firstAt(area.y, step)};
      const int columns = countIn(origin.x, area.right(), scale.window.width, step);
      const int rows = countIn(origin.y, area.bottom(), scale.window.height, step);
      const bool isEmpty = columns == 0 || rows == 0;
      ranges_[at] = {
          static_cast<uint32_t>(count), static_cast<int>(s), static_cast<int>(a), origin, step,
          isEmpty ? 0 : columns,        isEmpty ? 0 : rows};
      firstIds_[at] = static_cast<uint32_t>(count);
      count += isEmpty ? 0 : static_cast<uint64_t>(columns) * static_cast<uint64_t>(rows);
      if (count >= UINT32_MAX) {
        used_ = 0;
        count_ = 0;
        return Error{"there are more windows than numbers for them: use a larger step or factor"};
      }
    }
  count_ = static_cast<uint32_t>(count);
  return true;
}

WindowTable SearchWindows::table() const {
  return {firstIds_.data(), ranges_.data(), static_cast<int>(firstIds_.size()), count_};
}

}  // namespace rg::detection
