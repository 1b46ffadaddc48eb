// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/literal_search.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <tuple>

namespace rg::motion {
namespace {

uint32_t sumRun(const uint8_t* a, const uint8_t* b, int count) {
  uint32_t sum = 0;
  for (int i = 0; i < count; ++i) sum += static_cast<uint32_t>(std::abs(a[i] - b[i]));
  return sum;
}

/// Pixels at the frame's edge have no gradient.
GradientSums sumGradients(std::span<const Run> runs, ImageView<const uint8_t> luma) {
  GradientSums sums;
  for (const Run& run : runs) {
    sums.pixels += static_cast<uint64_t>(run.end - run.begin);
    if (run.y == 0 || run.y + 1 == luma.height()) continue;
    const uint8_t *above = luma.row(run.y - 1), *row = luma.row(run.y),
                  *below = luma.row(run.y + 1);
    for (int x = std::max<int>(run.begin, 1); x < std::min<int>(run.end, luma.width() - 1); ++x) {
      const int64_t dx = row[x + 1] - row[x - 1], dy = below[x] - above[x];
      sums.xx += dx * dx;
      sums.xy += dx * dy;
      sums.yy += dy * dy;
    }
  }
  return sums;
}

/// What estimateMotion() reads, in units of 2^scale.
FoundShift describeBest(const std::vector<uint64_t>& sums, const ShiftRange& range, int scale) {
  const int reach = range.reach, side = 2 * reach + 1;
  std::tuple<uint64_t, int, int, int> best{UINT64_MAX, 0, 0, 0};
  const auto forShifts = [&](auto&& visit) {
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx)
        visit(dx, dy, sums[static_cast<size_t>((reach - dy) * side + reach - dx)]);
  };
  forShifts([&](int dx, int dy, uint64_t sum) {
    if (range.allows({dx, dy})) best = std::min(best, {sum, dx * dx + dy * dy, dy, dx});
  });
  FoundShift found;
  found.d = {std::get<3>(best), std::get<2>(best)};
  const uint64_t total = std::accumulate(sums.begin(), sums.end(), uint64_t{0});
  found.mean = static_cast<uint32_t>(total / sums.size() >> scale);
  forShifts([&](int dx, int dy, uint64_t sum) {
    const int x = dx - found.d.x + 1, y = dy - found.d.y + 1;
    const auto told = static_cast<uint32_t>(sum >> scale);
    found.isBeaten = found.isBeaten || sum < std::get<0>(best);
    if (x < 0 || x > 2 || y < 0 || y > 2)
      found.rival = std::min(found.rival, told);
    else
      found.sums[static_cast<size_t>(3 * y + x)] = told;
  });
  return found;
}

}  // namespace

void sumAllShifts(std::span<const Run> runs, ImageView<const uint8_t> luma,
                  const PaddedLuma& previous, int reach, std::vector<uint64_t>& sums) {
  const int side = 2 * reach + 1;
  sums.assign(static_cast<size_t>(side) * static_cast<size_t>(side), 0);
  for (const Run& run : runs) {
    const uint8_t* from = luma.row(run.y) + run.begin;
    uint64_t* to = sums.data();
    for (int ey = -reach; ey <= reach; ++ey) {
      const uint8_t* before = previous.along(run.begin - reach, run.y + ey);
      for (int i = 0; i < side; ++i) *to++ += sumRun(from, before + i, run.end - run.begin);
    }
  }
}

RegionMotion matchAllPixels(std::span<const Run> runs, ImageView<const uint8_t> luma,
                            const PaddedLuma& previous, const ShiftRange& range,
                            LiteralScratch& scratch) {
  sumAllShifts(runs, luma, previous, range.reach, scratch.sums);
  const GradientSums gradients = sumGradients(runs, luma);
  const int scale = literalScale(gradients.pixels);
  const FoundShift found = describeBest(scratch.sums, range, scale);
  RegionMotion motion = estimateMotion(found, scaled(gradients, scale));
  const int side = 2 * range.reach + 1;
  motion.sad =
      scratch.sums[static_cast<size_t>((range.reach - found.d.y) * side + range.reach - found.d.x)];
  return motion;
}

}  // namespace rg::motion
