// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/region_division.hpp"

#include "core/simd/segmentation/cell_rows.hpp"

#include <algorithm>

namespace rg::segmentation {
namespace {

/// Writes whole blocks where the row goes on: what is written beyond a run is written again.
void fillRun(const Span& run, uint16_t value, int width, uint16_t* to) {
  constexpr int kBlock = 32;
  int x = run.first;
  for (; x < run.last && x + kBlock <= width; x += kBlock) std::fill_n(to + x, kBlock, value);
  if (x < run.last) std::fill(to + x, to + run.last, value);
}

}  // namespace

uint32_t RegionDivision::run(const ColourGrid& planes, const PixelRuns& runs, const Limits& limits,
                             const Executor& executor, ImageView<uint16_t> ids) {
  planes_ = planes;
  runs_ = &runs;
  sumParts(executor);
  std::vector<AbsorbedRegion>& regions = absorption_.regions();
  regions.assign(runs.componentCount(), {});
  for (int band = 0; band < runs.bandCount(); ++band)
    for (const uint32_t part : runs.parts(band)) {
      AbsorbedRegion& region = regions[runs.component(part)];
      const Sums& sums = sums_[part];
      region.red += sums.red;
      region.green += sums.green;
      region.blue += sums.blue;
      region.areaPx += sums.areaPx;
    }
  const auto grainPx = static_cast<uint32_t>(planes.sidePx);
  return divide({limits.minAreaPx, limits.maxRegions, grainPx}, executor, ids);
}

uint32_t RegionDivision::runAgain(const RegionDivision& first, const ColourGrid& planes,
                                  const PixelRuns& runs, const Limits& limits,
                                  const Executor& executor, ImageView<uint16_t> ids) {
  planes_ = planes;
  runs_ = &runs;
  std::vector<AbsorbedRegion>& regions = absorption_.regions();
  regions.assign(runs.componentCount(), {});
  int row = 0;
  for (int band = 0; band < runs.bandCount(); ++band)
    for (const uint32_t part : runs.parts(band)) {
      while (runs.rowStart(row + 1) <= part) ++row;
      AbsorbedRegion& region = regions[runs.component(part)];
      region.areaPx += runs.partArea(part);
      region.representative = ids.row(row)[runs.run(part).first];
    }
  for (AbsorbedRegion& region : regions) {
    const AbsorbedRegion& whole = first.labelled_[region.representative];
    region.red = whole.red * region.areaPx / whole.areaPx;
    region.green = whole.green * region.areaPx / whole.areaPx;
    region.blue = whole.blue * region.areaPx / whole.areaPx;
  }
  return divide({limits.minAreaPx, limits.maxRegions, 1, kPieceGrowth}, executor, ids);
}

uint32_t RegionDivision::divide(const AbsorptionLimits& limits, const Executor& executor,
                                ImageView<uint16_t> ids) {
  collectBorders();
  absorption_.run(limits);
  const uint32_t count = numberRegions(limits.maxRegions);
  executor.forRows(planes_.size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) writeRow(y, ids.row(y));
  });
  return count;
}

// Sums by part first: bands have those of their own.
void RegionDivision::sumParts(const Executor& executor) {
  sums_.resize(runs_->count());
  executor.forEach(runs_->bandCount(), [&](int band) {
    const Span rows = runs_->bandRows(band);
    for (const uint32_t part : runs_->parts(band)) sums_[part] = {};
    for (int y = rows.first; y < rows.last; ++y) addRow(y);
  });
}

void RegionDivision::addRow(int y) {
  const uint8_t *red = planes_.colours[0].row(y), *green = planes_.colours[1].row(y),
                *blue = planes_.colours[2].row(y);
  const uint8_t* weights = planes_.weights.data != nullptr ? planes_.weights.row(y) : nullptr;
  for (uint32_t i = runs_->rowStart(y); i < runs_->rowStart(y + 1); ++i) {
    const Span& run = runs_->run(i);
    const int count = run.last - run.first;
    Sums& sums = sums_[runs_->part(i)];
    if (weights == nullptr) {
      sums.red += simd::sumRow(red + run.first, count);
      sums.green += simd::sumRow(green + run.first, count);
      sums.blue += simd::sumRow(blue + run.first, count);
      sums.areaPx += static_cast<uint32_t>(count);
      continue;
    }
    for (int x = run.first; x < run.last; ++x) {
      const uint32_t weight = weights[x];
      sums.red += weight * red[x];
      sums.green += weight * green[x];
      sums.blue += weight * blue[x];
      sums.areaPx += weight;
    }
  }
}

void RegionDivision::collectBorders() {
  const auto side = static_cast<uint32_t>(planes_.sidePx);
  std::vector<AbsorbedBorder>& borders = absorption_.borders();
  borders.clear();
  borders.reserve(runs_->mostBorders() + 1);  // One more, as absorption writes before it decides.
  runs_->forBorders([&](uint32_t a, uint32_t b, uint32_t pairs) {
    borders.push_back({a, b, pairs * side});
  });
}

// Numbers follow the raster order of first pixels, as the components do. Where parts that touch
// nothing are still more than allowed, the smallest go to label 0.
uint32_t RegionDivision::numberRegions(uint32_t maxRegions) {
  constexpr uint32_t kDropped = 0, kOpen = ~uint32_t{0};
  numbers_.assign(runs_->componentCount(), kOpen);
  const std::vector<AbsorbedRegion>& left = absorption_.left();
  if (left.size() > maxRegions) {
    order_.clear();
    for (const AbsorbedRegion& region : left)
      order_.push_back(uint64_t{region.areaPx} << 32 | region.representative);
    const size_t surplus = left.size() - maxRegions;
    std::nth_element(order_.begin(), order_.begin() + static_cast<ptrdiff_t>(surplus),
                     order_.end());
    for (size_t i = 0; i < surplus; ++i) numbers_[static_cast<uint32_t>(order_[i])] = kDropped;
  }
  uint32_t count = 0;
  for (uint32_t i = 0; i < numbers_.size(); ++i) {
    uint32_t& number = numbers_[absorption_.representative(i)];
    if (number == kOpen) number = ++count;
    numbers_[i] = number;
  }
  labelled_.assign(count + 1, {});
  for (const AbsorbedRegion& region : left) labelled_[numbers_[region.representative]] = region;
  return count;
}

void RegionDivision::writeRow(int y, uint16_t* ids) const {
  const int width = planes_.size.width;
  int done = 0;
  for (uint32_t i = runs_->rowStart(y); i < runs_->rowStart(y + 1); ++i) {
    const Span& run = runs_->run(i);
    std::fill(ids + done, ids + run.first, uint16_t{0});
    fillRun(run, static_cast<uint16_t>(numbers_[runs_->component(i)]), width, ids);
    done = run.last;
  }
  std::fill(ids + done, ids + width, uint16_t{0});
}

}  // namespace rg::segmentation
