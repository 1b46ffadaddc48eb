// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/own_motion.hpp"

#include "core/pixel.hpp"
#include "core/simd/motion_rows.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kNeighbourRounds = 2;
// A search over thousands of shifts finds some gain in mere noise: four deviations of it.
constexpr uint64_t kNoiseGain = 18;
constexpr uint64_t kLeastGainShare = 4;  // At least a grey level for so many pixels.

using Trial = OwnMotionScratch::Trial;

/// What is given to all steps.
struct Inputs {
  const Motion& motion;
  const Executor& executor;
  RegionMotion camera;
};

/// Rows or columns of the frame that the previous frame shows as well.
struct Range {
  int first, last;
};

Range visibleRange(int length, int shift) {
  const int whole = shift >> kMotionFractionBits;
  const bool isWhole = shift % kMotionUnit == 0;
  return {std::clamp(whole + (isWhole ? 0 : 1), 0, length), std::clamp(length + whole, 0, length)};
}

/// expected(x) = previous(x − shift), between its pixels linearly; at the border it repeats.
void warp(ImageView<const uint8_t> previous, const RegionMotion& shift, const Executor& executor,
          Image<uint8_t>& expected) {
  const auto wholeOf = [](int v) { return -((v + kMotionUnit - 1) >> kMotionFractionBits); };
  const auto partOf = [&](int v) { return -v - wholeOf(v) * kMotionUnit; };
  const int dx = wholeOf(shift.dx), dy = wholeOf(shift.dy);
  const int u = partOf(shift.dx), v = partOf(shift.dy);
  const int width = previous.width(), height = previous.height();
  const int first = std::clamp(-dx, 0, width), last = std::clamp(width - 1 - dx, first, width);
  expected.resize(previous.size);
  executor.forRows(height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const uint8_t* above = previous.row(std::clamp(y + dy, 0, height - 1));
      const uint8_t* below = previous.row(std::clamp(y + dy + 1, 0, height - 1));
      uint8_t* to = expected.row(y);
      const auto repeatBorder = [&](int from, int until, int column) {
        const uint8_t sides[] = {above[column], above[column], below[column], below[column]};
        if (from == until) return;
        simd::warpRow({sides, sides + 2, u, v}, 1, to + from);
        std::fill(to + from + 1, to + until, to[from]);
      };
      repeatBorder(0, first, 0);
      if (first < last)
        simd::warpRow({above + first + dx, below + first + dx, u, v}, last - first, to + first);
      repeatBorder(last, width, width - 1);
    }
  });
}

Point shiftBeyond(const RegionMotion& m, const RegionMotion& camera) {
  return {static_cast<int>(divideRounded(m.dx - camera.dx, kMotionUnit)),
          static_cast<int>(divideRounded(m.dy - camera.dy, kMotionUnit))};
}

/// Calls visit(first pixel, count, label) for all that the movers covered in the previous frame.
template <class Visit>
void forCovered(const Inputs& in, const std::vector<uint8_t>& moves, OwnMotionScratch& s,
                const Visit& visit) {
  const Graph& graph = *in.motion.graph;
  in.executor.forRows(graph.size.height, [&](int begin, int end) {
    for (size_t i = 0; i < moves.size(); ++i) {
      if (moves[i] == 0) continue;
      const Point shift = s.shifts[i];
      const auto runs = graph.runs.of(i);
      auto run = std::lower_bound(runs.begin(), runs.end(), begin + shift.y,
                                  [](const RegionRun& r, int y) { return r.y < y; });
      for (; run != runs.end() && run->y < end + shift.y; ++run) {
        const int first = std::max(run->begin - shift.x, 0);
        const int last = std::min(run->end - shift.x, graph.size.width);
        if (first < last)
          visit(s.hidden.row(run->y - shift.y) + first, last - first, static_cast<uint16_t>(i + 1));
      }
    }
  });
}

/// Whether what covered a pixel keeps a region from being seen there: what moves along with it does
/// not, being a part of the same thing.
bool isHidden(uint16_t by, Point shift, const std::vector<uint8_t>& moves, uint16_t region,
              const OwnMotionScratch& s) {
  if (by == kNoRegion || by == region) return false;
  const Point other = s.shifts[by - 1u];
  return moves[region - 1u] == 0 ||
         std::max(absDiff(other.x, shift.x), absDiff(other.y, shift.y)) > 1;
}

/// Calls visit(first, last) for the parts of a row's columns that nothing hides from a region.
template <class Visit, class IsHiding>
void forVisible(const uint16_t* hidden, Range columns, const IsHiding& isHiding,
                const Visit& visit) {
  const int count = columns.last - columns.first;
  if (count > 0 && !simd::isAnySet(hidden + columns.first, count))
    return visit(columns.first, columns.last);
  for (int first = columns.first; first < columns.last;) {
    int last = first + 1;
    while (last < columns.last && hidden[last] == hidden[first]) ++last;
    if (!isHiding(hidden[first])) visit(first, last);
    first = last;
  }
}

/// Compares a region, where it can be compared with and without the shift.
void compare(const Inputs& in, const std::vector<uint8_t>& moves, size_t region,
             OwnMotionScratch& s) {
  const Graph& graph = *in.motion.graph;
  const ImageView<const uint8_t> luma = graph.labels->picture->luma();
  const Range columns = visibleRange(graph.size.width, in.camera.dx);
  const Range rows = visibleRange(graph.size.height, in.camera.dy);
  Trial& trial = s.trials[region];
  const Point shift = trial.shift;
  const auto label = static_cast<uint16_t>(region + 1);
  const auto isHiding = [&](uint16_t by) { return isHidden(by, shift, moves, label, s); };
  for (const RegionRun& run : graph.runs.of(region)) {
    const int y = run.y, from = y - shift.y;
    if (y < rows.first || y >= rows.last || from < rows.first || from >= rows.last) continue;
    const Range seen{std::max({int{run.begin}, columns.first, columns.first + shift.x}),
                     std::min({int{run.end}, columns.last, columns.last + shift.x})};
    const uint8_t *now = luma.row(y), *still = s.expected.row(y), *moved = s.expected.row(from);
    forVisible(s.hidden.row(y), seen, isHiding, [&](int first, int last) {
      const simd::DifferenceSums sums = simd::sumDifferences(
          {now + first, still + first, moved + (first - shift.x)}, last - first);
      trial.still += sums.still;
      trial.moved += sums.moved;
      trial.pixels += static_cast<uint64_t>(last - first);
    });
  }
}

/// Measures each region that has a shift to try, on pixels that can be compared with and without.
void measure(const Inputs& in, const std::vector<uint8_t>& moves, OwnMotionScratch& s) {
  forCovered(in, moves, s, simd::raiseRow);
  in.executor.forEach(static_cast<int>(s.trials.size()), [&](int i) {
    const auto region = static_cast<size_t>(i);
    if (s.trials[region].shift != Point{}) compare(in, moves, region, s);
  });
  forCovered(in, moves, s,
             [](uint16_t* hidden, int count, uint16_t) { std::fill_n(hidden, count, kNoRegion); });
}

/// Whether `better` explains the pixels better than `worse`, beyond what noise may do.
bool isClearlyLess(uint64_t better, uint64_t worse, uint64_t pixels) {
  if (better + pixels / kLeastGainShare >= worse) return false;
  const uint64_t gain = worse - better;
  return gain * gain * pixels > kNoiseGain * better * better;
}

/// How long the border of each region is, with how much of it moving regions share, and which of
/// those shares most.
void measureBorders(const Graph& graph, const std::vector<uint8_t>& moves, OwnMotionScratch& s) {
  s.border.assign(moves.size(), 0);
  s.movingBorder.assign(moves.size(), 0);
  s.longest.assign(moves.size(), 0);
  s.neighbour.assign(moves.size(), 0);
  s.movingArea.assign(moves.size(), 0);
  const auto see = [&](uint32_t region, uint32_t other, uint32_t borderPx) {
    s.border[region] += borderPx;
    if (moves[other] == 0) return;
    s.movingBorder[region] += borderPx;
    s.movingArea[region] += graph.regions[other].areaPx;
    if (borderPx <= s.longest[region]) return;
    s.longest[region] = borderPx;
    s.neighbour[region] = other + 1;
  };
  for (const Arc& arc : graph.arcs) {
    see(arc.a - 1u, arc.b - 1u, arc.borderPx);
    see(arc.b - 1u, arc.a - 1u, arc.borderPx);
  }
}

/// The whole-pixel shift of each region that moves otherwise than the camera. True if any does.
bool findShifts(const Inputs& in, int32_t threshold, std::vector<Point>& shifts) {
  const std::vector<RegionMotion>& regions = in.motion.regions;
  shifts.assign(regions.size(), {});
  for (size_t i = 0; i < regions.size(); ++i) {
    const int64_t dx = regions[i].dx - in.camera.dx, dy = regions[i].dy - in.camera.dy;
    if (dx * dx + dy * dy > int64_t{threshold} * threshold)
      shifts[i] = shiftBeyond(regions[i], in.camera);
  }
  return std::any_of(shifts.begin(), shifts.end(), [](Point p) { return p != Point{}; });
}

/// Tries each region's own vector; twice, as the first movers show which ground was hidden.
void tryOwnVectors(const Inputs& in, OwnMotionScratch& s, std::vector<uint8_t>& moves) {
  const size_t count = moves.size();
  for (int round = 0; round < 2; ++round) {
    s.trials.assign(count, {});
    for (size_t i = 0; i < count; ++i) s.trials[i].shift = s.shifts[i];
    measure(in, moves, s);
    for (size_t i = 0; i < count; ++i)
      moves[i] = isClearlyLess(s.trials[i].moved, s.trials[i].still, s.trials[i].pixels);
  }
}

/// Tries the vectors of moving neighbours on the regions that are not found to move.
void tryNeighbours(const Inputs& in, OwnMotionScratch& s, std::vector<uint8_t>& moves) {
  const Graph& graph = *in.motion.graph;
  const size_t count = moves.size();
  measureBorders(graph, moves, s);
  s.trials.assign(count, {});
  for (size_t i = 0; i < count; ++i)
    if (moves[i] == 0 && s.neighbour[i] != 0) s.trials[i].shift = s.shifts[s.neighbour[i] - 1];
  measure(in, moves, s);
  for (size_t i = 0; i < count; ++i) {
    const Trial& t = s.trials[i];
    if (t.shift == Point{}) continue;
    const bool isOpen = !isClearlyLess(t.still, t.moved, t.pixels);
    const bool isSurrounded =
        2 * uint64_t{s.movingBorder[i]} > s.border[i] && graph.regions[i].areaPx <= s.movingArea[i];
    if (isClearlyLess(t.moved, t.still, t.pixels) || (isOpen && isSurrounded)) {
      moves[i] = 1;
      s.shifts[i] = t.shift;
    }
  }
}

}  // namespace

void findOwnMotion(const Motion& motion, ImageView<const uint8_t> previous,
                   const OwnMotionRules& rules, const Executor& executor, OwnMotionScratch& s,
                   std::vector<uint8_t>& movesOtherwise) {
  const Inputs in{motion, executor, rules.camera};
  movesOtherwise.assign(motion.regions.size(), 0);
  if (!findShifts(in, rules.threshold, s.shifts)) return;
  if (s.hidden.size() != motion.size) {
    s.hidden.resize(motion.size);
    s.hidden.fill(kNoRegion);
  }
  warp(previous, rules.camera, executor, s.expected);
  tryOwnVectors(in, s, movesOtherwise);
  for (int round = 0; round < kNeighbourRounds; ++round) tryNeighbours(in, s, movesOtherwise);
}

}  // namespace rg
