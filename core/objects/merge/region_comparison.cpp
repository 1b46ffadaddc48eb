// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/region_comparison.hpp"

#include "core/base/pixel.hpp"
#include "core/simd/base/motion_rows.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace rg::objects {
namespace {

constexpr int kBands = OwnMotionScratch::kBands;
constexpr int kShortRun = 8;  // Pixels: of fewer, choosing the instruction set takes longest.

using Sums = OwnMotionScratch::Sums;

simd::DifferenceSums sumFew(const simd::ComparedRows& rows, int count, uint8_t most) {
  simd::DifferenceSums sums;
  for (int i = 0; i < count; ++i) {
    sums.still += limitedDifference(rows.now[i], rows.still[i], most);
    sums.moved += limitedDifference(rows.now[i], rows.moved[i], most);
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
        isAcross_(hasRowBands(shift_)) {
    for (int band = 0; band <= kBands; ++band)
      bandAt_[static_cast<size_t>(band)] = bandBegin(band, box_);
  }

  [[nodiscard]] const std::array<Sums, kBands>& run() {
    for (const Run& run : graph_.runs.of(region_)) {
      if (run.y != y_) beginRow(run.y);
      if (isCompared_) forHeld(run, [&](int begin, int end) { addRun(begin, end); });
    }
    return bands_;
  }

 private:
  /// Calls visit(begin, end) for the columns behind which is the region, too.
  template <class Visit>
  void forHeld(const Run& run, const Visit& visit) const {
    const Point back = behind({}, shift_);
    const auto runs = graph_.runs.of(region_);
    auto held = std::lower_bound(runs.begin(), runs.end(), run.y + back.y,
                                 [](const Run& r, int y) { return r.y < y; });
    for (; held != runs.end() && held->y == run.y + back.y; ++held)
      visit(std::max<int>(run.begin, held->begin - back.x),
            std::min<int>(run.end, held->end - back.x));
  }

  void beginRow(int y) {
    y_ = y;
    const int from = y - shift_.y;
    isCompared_ = from >= 0 && from < luma_.height() && isComparedRow(y, box_, s_.everyRow);
    if (!isCompared_) return;
    const ShownRange* shown = s_.shown.row(0);
    columns_ = comparedColumns(shown[y], shown[from], shift_.x);
    now_ = luma_.row(y);
    still_ = s_.expected.row(y);
    moved_ = s_.expected.row(from);
    hidden_ = s_.hidesAny ? s_.hidden.row(y) : nullptr;
    if (isAcross_) band_ = bandOfRow(y, box_);
  }

  void addRun(int begin, int end) {
    const ShownRange seen{std::max(begin, columns_.first), std::min(end, columns_.last)};
    if (hidden_ == nullptr) return addSpan(seen.first, seen.last);
    const auto isHiding = [&](uint16_t by) { return hidesFrom(label_.number(), by); };
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
                                          ? sumFew(rows, last - first, s_.mostLevels)
                                          : simd::sumDifferences(rows, last - first, s_.mostLevels);
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

/// Fills in the sums of a region's trial.
void compareRegion(const motion::Motion& motion, size_t region, OwnMotionScratch& s) {
  Comparison comparison(motion, region, s);
  const std::array<Sums, kBands>& bands = comparison.run();
  OwnMotionScratch::Trial& trial = s.trials[region];
  trial.seen = sumOfBands(bands.data(), kBands).pixels;
  trial.sums = sumWithoutBest(bands.data());
}

/// Calls visit(first pixel, count, label) for all that the movers covered in the earlier frame.
template <class Visit>
void forCovered(const graph::Graph& graph, std::span<const OwnMotion> own, const Executor& executor,
                OwnMotionScratch& s, const Visit& visit) {
  executor.forRows(graph.size.height, [&](int begin, int end) {
    for (size_t i = 0; i < own.size(); ++i) {
      if (s.moves[i] == 0) continue;
      const auto runs = graph.runs.of(i);
      for (const Point by : coveredBy(own[i].shift)) {
        auto run = std::lower_bound(runs.begin(), runs.end(), begin + by.y,
                                    [](const Run& r, int y) { return r.y < y; });
        for (; run != runs.end() && run->y < end + by.y; ++run) {
          const int first = std::max(run->begin - by.x, 0);
          const int last = std::min(run->end - by.x, graph.size.width);
          if (first < last)
            visit(s.hidden.row(run->y - by.y) + first, last - first,
                  segmentation::RegionLabel::ofIndex(i).number());
        }
      }
    }
  });
}

}  // namespace

void compareRegions(const motion::Motion& motion, std::span<const OwnMotion> own,
                    const Executor& executor, OwnMotionScratch& s) {
  if (s.hidden.size() != motion.size) {
    s.hidden.resize(motion.size);
    s.hidden.fill(segmentation::kNoRegion);
  }
  const graph::Graph& graph = *motion.graph;
  if (s.hidesAny) forCovered(graph, own, executor, s, simd::raiseRow);
  executor.forEach(static_cast<int>(s.trials.size()), [&](int i) {
    const auto region = static_cast<size_t>(i);
    if (s.trials[region].shift != Point{}) compareRegion(motion, region, s);
  });
  if (!s.hidesAny) return;
  forCovered(graph, own, executor, s, [](uint16_t* hidden, int count, uint16_t) {
    std::fill_n(hidden, count, segmentation::kNoRegion);
  });
}

}  // namespace rg::objects
