// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/own_motion.hpp"

#include "core/pixel.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kNeighbourRounds = 2;
// A search over thousands of shifts finds some gain in mere noise: four deviations of it.
constexpr uint64_t kNoiseGain = 18;
constexpr uint64_t kLeastGainShare = 4;  // At least a grey level for so many pixels.

using Trial = OwnMotionScratch::Trial;

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
void warp(ImageView<const uint8_t> previous, const RegionMotion& shift, Image<uint8_t>& expected) {
  const auto wholeOf = [](int v) { return -((v + kMotionUnit - 1) >> kMotionFractionBits); };
  const auto partOf = [&](int v) { return -v - wholeOf(v) * kMotionUnit; };
  const int dx = wholeOf(shift.dx), dy = wholeOf(shift.dy);
  const int u = partOf(shift.dx), v = partOf(shift.dy);
  const int width = previous.width(), height = previous.height();
  expected.resize(previous.size);
  for (int y = 0; y < height; ++y) {
    const uint8_t* above = previous.row(std::clamp(y + dy, 0, height - 1));
    const uint8_t* below = previous.row(std::clamp(y + dy + 1, 0, height - 1));
    uint8_t* to = expected.row(y);
    for (int x = 0; x < width; ++x) {
      const int left = std::clamp(x + dx, 0, width - 1),
                right = std::clamp(x + dx + 1, 0, width - 1);
      const int top = above[left] * (kMotionUnit - u) + above[right] * u;
      const int low = below[left] * (kMotionUnit - u) + below[right] * u;
      to[x] = static_cast<uint8_t>(
          roundShift(top * (kMotionUnit - v) + low * v, 2 * kMotionFractionBits));
    }
  }
}

Point shiftBeyond(const RegionMotion& m, const RegionMotion& camera) {
  return {static_cast<int>(divideRounded(m.dx - camera.dx, kMotionUnit)),
          static_cast<int>(divideRounded(m.dy - camera.dy, kMotionUnit))};
}

/// Marks where the movers were in the previous frame.
void hideMovers(const Labels& labels, const std::vector<uint8_t>& moves, OwnMotionScratch& s) {
  s.hidden.resize(labels.size);
  s.hidden.fill(kNoRegion);
  for (int y = 0; y < labels.size.height; ++y) {
    const uint16_t* ids = labels.ids.row(y);
    for (int x = 0; x < labels.size.width; ++x) {
      if (ids[x] == kNoRegion || moves[ids[x] - 1u] == 0) continue;
      const Point from{x - s.shifts[ids[x] - 1u].x, y - s.shifts[ids[x] - 1u].y};
      if (!boundsOf(labels.size).contains(from)) continue;
      uint16_t& hidden = s.hidden.at(from.x, from.y);
      hidden = std::max(hidden, ids[x]);
    }
  }
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

/// Measures each region that has a shift to try, on pixels that can be compared with and without.
void measure(const Motion& motion, const RegionMotion& camera, const std::vector<uint8_t>& moves,
             OwnMotionScratch& s) {
  const Labels& labels = *motion.graph->labels;
  const ImageView<const uint8_t> luma = labels.picture->luma();
  const Range columns = visibleRange(motion.size.width, camera.dx);
  const Range rows = visibleRange(motion.size.height, camera.dy);
  for (int y = rows.first; y < rows.last; ++y) {
    const uint16_t *ids = labels.ids.row(y), *hidden = s.hidden.row(y);
    const uint8_t *now = luma.row(y), *expected = s.expected.row(y);
    for (int x = columns.first; x < columns.last; ++x) {
      if (ids[x] == kNoRegion) continue;
      Trial& trial = s.trials[ids[x] - 1u];
      const Point from{x - trial.shift.x, y - trial.shift.y};
      if (trial.shift == Point{} || from.x < columns.first || from.x >= columns.last ||
          from.y < rows.first || from.y >= rows.last ||
          isHidden(hidden[x], trial.shift, moves, ids[x], s))
        continue;
      trial.still += static_cast<uint64_t>(absDiff(now[x], expected[x]));
      trial.moved += static_cast<uint64_t>(absDiff(now[x], s.expected.at(from.x, from.y)));
      ++trial.pixels;
    }
  }
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

/// Tries each region's own vector; twice, as the first movers show which ground was hidden.
void tryOwnVectors(const Motion& motion, const RegionMotion& camera, int32_t threshold,
                   OwnMotionScratch& s, std::vector<uint8_t>& moves) {
  const size_t count = motion.regions.size();
  s.shifts.assign(count, {});
  for (size_t i = 0; i < count; ++i) {
    const RegionMotion& m = motion.regions[i];
    const int64_t dx = m.dx - camera.dx, dy = m.dy - camera.dy;
    if (dx * dx + dy * dy > int64_t{threshold} * threshold) s.shifts[i] = shiftBeyond(m, camera);
  }
  moves.assign(count, 0);
  for (int round = 0; round < 2; ++round) {
    hideMovers(*motion.graph->labels, moves, s);
    s.trials.assign(count, {});
    for (size_t i = 0; i < count; ++i) s.trials[i].shift = s.shifts[i];
    measure(motion, camera, moves, s);
    for (size_t i = 0; i < count; ++i)
      moves[i] = isClearlyLess(s.trials[i].moved, s.trials[i].still, s.trials[i].pixels);
  }
}

/// Tries the vectors of moving neighbours on the regions that are not found to move.
void tryNeighbours(const Motion& motion, const RegionMotion& camera, OwnMotionScratch& s,
                   std::vector<uint8_t>& moves) {
  const size_t count = moves.size();
  measureBorders(*motion.graph, moves, s);
  hideMovers(*motion.graph->labels, moves, s);
  s.trials.assign(count, {});
  for (size_t i = 0; i < count; ++i)
    if (moves[i] == 0 && s.neighbour[i] != 0) s.trials[i].shift = s.shifts[s.neighbour[i] - 1];
  measure(motion, camera, moves, s);
  for (size_t i = 0; i < count; ++i) {
    const Trial& t = s.trials[i];
    if (t.shift == Point{}) continue;
    const bool isOpen = !isClearlyLess(t.still, t.moved, t.pixels);
    const bool isSurrounded = 2 * uint64_t{s.movingBorder[i]} > s.border[i] &&
                              motion.graph->regions[i].areaPx <= s.movingArea[i];
    if (isClearlyLess(t.moved, t.still, t.pixels) || (isOpen && isSurrounded)) {
      moves[i] = 1;
      s.shifts[i] = t.shift;
    }
  }
}

}  // namespace

void findOwnMotion(const Motion& motion, ImageView<const uint8_t> previous,
                   const RegionMotion& camera, int32_t threshold, OwnMotionScratch& s,
                   std::vector<uint8_t>& movesOtherwise) {
  warp(previous, camera, s.expected);
  tryOwnVectors(motion, camera, threshold, s, movesOtherwise);
  for (int round = 0; round < kNeighbourRounds; ++round)
    tryNeighbours(motion, camera, s, movesOtherwise);
}

}  // namespace rg
