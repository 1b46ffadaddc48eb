// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/region_comparison.hpp"

#include "core/base/pixel.hpp"
#include "core/simd/base/motion_rows.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace rg::objects {
namespace {

constexpr int kBands = OwnMotionScratch::kBands;
constexpr size_t kLeftOut = 2;
constexpr int kShortRun = 8;  // Pixels: of fewer, choosing the instruction set takes longest.

using Sums = OwnMotionScratch::Sums;

simd::DifferenceSums sumFew(const simd::ComparedRows& rows, int count) {
  simd::DifferenceSums sums;
  for (int i = 0; i < count; ++i) {
    sums.still += static_cast<uint32_t>(absDiff(rows.now[i], rows.still[i]));
    sums.moved += static_cast<uint32_t>(absDiff(rows.now[i], rows.moved[i]));
  }
  return sums;
}

/// Calls visit(first, last) for the parts of a row's columns that nothing hides from a region.
template <class Visit, class IsHiding>
void forVisible(const uint16_t* hidden, ShownRange columns, const IsHiding& isHiding,
                const Visit& visit) {
  const int count = columns.last - columns.first;
  if (count <= 0) return;
  const uint16_t* from = hidden + columns.first;
  const bool isClear = count < kShortRun
                           ? std::all_of(from, from + count, [](uint16_t by) { return by == 0; })
                           : !simd::isAnySet(from, count);
  if (isClear) return visit(columns.first, columns.last);
  for (int first = columns.first; first < columns.last;) {
    int last = first + 1;
    while (last < columns.last && hidden[last] == hidden[first]) ++last;
    if (!isHiding(hidden[first])) visit(first, last);
    first = last;
  }
}

/// Adds up the bands of a region but for the neighbours that gain most.
Sums withoutBest(const std::array<Sums, kBands>& bands) {
  const auto sumOf = [](auto first, auto last) {
    Sums sum;
    for (auto band = first; band != last; ++band) {
      sum.still += band->still;
      sum.moved += band->moved;
      sum.pixels += band->pixels;
    }
    return sum;
  };
  Sums best;
  int64_t most = INT64_MIN;
  for (auto band = bands.begin(); band + kLeftOut <= bands.end(); ++band) {
    const Sums sum = sumOf(band, band + kLeftOut);
    const auto gain = static_cast<int64_t>(sum.still - sum.moved);
    if (gain > most) best = sum;
    most = std::max(most, gain);
  }
  Sums all = sumOf(bands.begin(), bands.end());
  if (best.pixels == all.pixels) return all;
  return {all.still - best.still, all.moved - best.moved, all.pixels - best.pixels};
}

/// A region, compared where it can be with and without its shift.
class Comparison {
 public:
  Comparison(const motion::Motion& motion, size_t region, const OwnMotionScratch& s)
      : graph_(*motion.graph),
        luma_(graph_.picture->luma()),
        s_(s),
        region_(region),
        label_(segmentation::RegionLabel::ofIndex(region)),
        shift_(s.trials[region].shift),
        box_(graph_.regions[region].box),
        isAcross_(std::abs(shift_.x) >= std::abs(shift_.y)) {
    for (int band = 0; band <= kBands; ++band)
      bandAt_[static_cast<size_t>(band)] = box_.x + band * box_.width / kBands;
  }

  [[nodiscard]] const std::array<Sums, kBands>& run() {
    for (const Run& run : graph_.runs.of(region_)) {
      if (run.y != y_) beginRow(run.y);
      if (isCompared_)
        addRun({std::max<int>(run.begin, columns_.first), std::min<int>(run.end, columns_.last)});
    }
    return bands_;
  }

 private:
  void beginRow(int y) {
    y_ = y;
    const int from = y - shift_.y;
    isCompared_ = from >= 0 && from < luma_.height() && (y - box_.y) % s_.everyRow == 0;
    if (!isCompared_) return;
    // Pixels that the previous frame shows both with and without the shift.
    const ShownRange& still = s_.shown[static_cast<size_t>(y)];
    const ShownRange& moved = s_.shown[static_cast<size_t>(from)];
    columns_ = {std::max(still.first, moved.first + shift_.x),
                std::min(still.last, moved.last + shift_.x)};
    now_ = luma_.row(y);
    still_ = s_.expected.row(y);
    moved_ = s_.expected.row(from);
    hidden_ = s_.hidesAny ? s_.hidden.row(y) : nullptr;
    if (isAcross_) band_ = kBands * (y - box_.y) / box_.height;
  }

  void addRun(const ShownRange& seen) {
    if (hidden_ == nullptr) return addSpan(seen.first, seen.last);
    const auto isHiding = [&](uint16_t by) {
      return by != segmentation::kNoRegion && by != label_.number();
    };
    forVisible(hidden_, seen, isHiding, [&](int first, int last) { addSpan(first, last); });
  }

  void addSpan(int first, int last) {
    if (isAcross_) return addTo(static_cast<size_t>(band_), first, last);
    for (size_t band = 0; band < kBands; ++band)
      addTo(band, std::max(first, bandAt_[band]), std::min(last, bandAt_[band + 1]));
  }

  void addTo(size_t band, int first, int last) {
    if (first >= last) return;
    const simd::ComparedRows rows{now_ + first, still_ + first, moved_ + (first - shift_.x)};
    const simd::DifferenceSums sums = last - first < kShortRun
                                          ? sumFew(rows, last - first)
                                          : simd::sumDifferences(rows, last - first);
    Sums& sum = bands_[band];
    sum.still += sums.still;
    sum.moved += sums.moved;
    sum.pixels += static_cast<uint64_t>(last - first);
  }

  const graph::Graph& graph_;
  ImageView<const uint8_t> luma_;
  const OwnMotionScratch& s_;
  size_t region_;
  segmentation::RegionLabel label_;
  Point shift_;
  Box box_;
  bool isAcross_;                         ///< The bands are rows.
  std::array<int, kBands + 1> bandAt_{};  ///< First column of each band.
  std::array<Sums, kBands> bands_{};

  // The row at hand.
  int y_ = -1, band_ = 0;
  bool isCompared_ = false;
  ShownRange columns_;
  const uint8_t *now_ = nullptr, *still_ = nullptr, *moved_ = nullptr;
  const uint16_t* hidden_ = nullptr;
};

}  // namespace

void compareRegion(const motion::Motion& motion, size_t region, OwnMotionScratch& s) {
  Comparison comparison(motion, region, s);
  const std::array<Sums, kBands>& bands = comparison.run();
  OwnMotionScratch::Trial& trial = s.trials[region];
  trial.seen = 0;
  for (const Sums& band : bands) trial.seen += band.pixels;
  trial.sums = withoutBest(bands);
}

}  // namespace rg::objects
