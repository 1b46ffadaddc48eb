// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/portrait.hpp"

#include "core/frame_count.hpp"
#include "core/pixel.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace rg {
namespace {

constexpr int kMostSamples = 1500;
constexpr int kFewSamples = 300;  // Of more, a quarter says where to look closely.
constexpr int kCoarse = 4;        // Places on either side that are tried first.
constexpr uint8_t kMostWeight = 8;
constexpr int kGain = 8;     // Of a sample whose colour is there, at most; also the most it loses.
constexpr int kPerGain = 4;  // Sums of three channels' differences that cost one.
constexpr int kEdgeGain = 8;
constexpr int kGroundLoss = 2;  // What hides a thing in part must not push it away.

enum State : uint8_t { kOutside, kCovered, kGround, kThing };
enum Edge : uint8_t { kLeft = 1, kRight = 2, kTop = 4, kBottom = 8 };

int difference(const PortraitSample& s, const Picture& picture, int x, int y) {
  return std::abs(s.red - picture.red().row(y)[x]) + std::abs(s.green - picture.green().row(y)[x]) +
         std::abs(s.blue - picture.blue().row(y)[x]);
}

/// The rows and columns that a search looks at.
struct Window {
  Box box;
  int reach;  ///< To a neighbour's cell.
  const uint8_t* state;

  [[nodiscard]] const uint8_t* row(int y) const {
    return state + static_cast<ptrdiff_t>(y - box.y) * box.width - box.x;
  }
};

Window look(const PortraitScene& scene, const Box& box, std::vector<uint8_t>& state) {
  const Evidence& e = scene.evidence;
  state.assign(static_cast<size_t>(box.area()), kOutside);
  const Box inside = intersect(box, boundsOf(e.frame));
  for (int y = inside.y; y < inside.bottom(); ++y) {
    uint8_t* to = state.data() + static_cast<ptrdiff_t>(y - box.y) * box.width - box.x;
    const size_t first = e.at(0, std::min(y / e.stepPx, e.grid.height - 1));
    for (int x = inside.x; x < inside.right(); ++x) {
      const size_t cell = first + static_cast<size_t>(std::min(x / e.stepPx, e.grid.width - 1));
      const bool isTaken = !scene.taken.empty() && scene.taken[cell] != 0;
      to[x] = isTaken ? kCovered : e.group[cell] == 0 ? kGround : kThing;
    }
  }
  return {box, std::max(1, e.stepPx), state.data()};
}

struct Score {
  int64_t gain = 0;
  uint32_t samples = 0, agreeing = 0, seen = 0, covered = 0, ground = 0;
};

/// What speaks for a place; of the samples every `skip`-th column and row.
Score judge(const Portrait& p, const Picture& picture, const Window& window, Point corner,
            int skip) {
  const int beside = window.reach;
  const std::pair<uint8_t, ptrdiff_t> neighbours[] = {
      {kLeft, -beside},
      {kRight, beside},
      {kTop, -ptrdiff_t{beside} * window.box.width},
      {kBottom, ptrdiff_t{beside} * window.box.width}};
  Score score;
  for (int row = 0; row < p.grid.height; row += skip) {
    const int y = corner.y + row * p.stepPx;
    const PortraitSample* samples = p.samples.data() + static_cast<ptrdiff_t>(row) * p.grid.width;
    const uint8_t* state = window.row(y);
    for (int column = 0; column < p.grid.width; column += skip) {
      const PortraitSample& sample = samples[column];
      if (!p.isSolid(sample)) continue;
      ++score.samples;
      const int x = corner.x + column * p.stepPx;
      score.ground += state[x] == kGround;
      score.covered += state[x] == kCovered;
      if (state[x] != kThing) continue;
      ++score.seen;
      const int gain = std::max(-kGain, kGain - difference(sample, picture, x, y) / kPerGain);
      score.gain += gain;
      score.agreeing += gain > 0;
      if (sample.edges == 0 || gain <= 0) continue;
      for (const auto& [edge, offset] : neighbours)
        if ((sample.edges & edge) != 0 && state[x + offset] == kGround) score.gain += kEdgeGain;
    }
  }
  score.gain -= int64_t{kGroundLoss} * score.ground;
  return score;
}

/// The search for the best shift from the expected corner.
struct Finder {
  using Key = std::tuple<int64_t, int, int, int>;  ///< Cost, distance, row, column.

  const Portrait& p;
  const Picture& picture;
  Window window;
  const PortraitSearch& where;

  [[nodiscard]] Score scoreAt(Point shift, int skip) const {
    return judge(p, picture, window, {where.corner.x + shift.x, where.corner.y + shift.y}, skip);
  }
  [[nodiscard]] int64_t costOf(Point shift, uint32_t samples) const {
    if (samples == 0) return 0;
    const int64_t width = std::max(1, p.sizePx.width + 3 * where.turn.x);
    const int64_t height = std::max(1, p.sizePx.height + 3 * where.turn.y);
    const int64_t across = shift.x * height, down = shift.y * width;
    const int64_t far = across * across + down * down;
    // Things as large as the largest frames, unseen for an hour, reach the ends of 64 bits.
    const int64_t weight = 9 * kGain * int64_t{samples};
    const int64_t whole = width * width * height * height;
    return std::min(far, INT64_MAX / weight) * weight /
           (whole * std::min<int64_t>(where.calm, INT64_MAX / whole));
  }
  [[nodiscard]] Key keyAt(Point shift, int skip) const {
    const Score score = scoreAt(shift, skip);
    return {costOf(shift, score.samples) - score.gain, shift.x * shift.x + shift.y * shift.y,
            shift.y, shift.x};
  }
  /// Of the places up to `around` from `middle`.
  [[nodiscard]] Point bestOf(Point middle, Point around, Point stride, int skip) const {
    Key best{INT64_MAX, 0, 0, 0};
    for (int dy = middle.y - around.y; dy <= middle.y + around.y; dy += stride.y)
      for (int dx = middle.x - around.x; dx <= middle.x + around.x; dx += stride.x)
        if (std::abs(dx) <= where.reach.x && std::abs(dy) <= where.reach.y)
          best = std::min(best, keyAt({dx, dy}, skip));
    return {std::get<3>(best), std::get<2>(best)};
  }
  /// From a place to better ones around it, with ever smaller strides.
  [[nodiscard]] Point climb(Point place, Point stride, int skip) const {
    while (stride.x > 1 || stride.y > 1) {
      stride = {(stride.x + 1) / 2, (stride.y + 1) / 2};
      place = bestOf(place, {2 * stride.x, 2 * stride.y}, stride, skip);
    }
    return bestOf(place, {1, 1}, {1, 1}, 1);
  }
  [[nodiscard]] Point find() const {
    const int skip = p.grid.area() > kFewSamples ? 2 : 1;
    const Point reach = where.reach;
    const Point stride{(reach.x + kCoarse - 1) / kCoarse, (reach.y + kCoarse - 1) / kCoarse};
    const Point from =
        bestOf({}, {reach.x / stride.x * stride.x, reach.y / stride.y * stride.y}, stride, skip);
    const Point best = climb(from, stride, skip);
    if (from == Point{}) return best;
    // A sliver that comes out from behind something lies between the coarse places.
    const Point near = climb({}, stride, skip);
    return keyAt(near, 1) < keyAt(best, 1) ? near : best;
  }
};

/// Where between a gain and its neighbours the top of a parabola is, in 1/16 px.
int topBetween(int64_t before, int64_t at, int64_t after) {
  const int64_t bend = 2 * at - before - after;
  if (bend <= 0) return 0;
  return static_cast<int>(std::clamp<int64_t>(divideRounded(8 * (after - before), bend), -8, 8));
}

uint8_t mix(uint8_t old, uint8_t fresh, int known) {
  return static_cast<uint8_t>((old * known + fresh + (known + 1) / 2) / (known + 1));
}

void begin(Portrait& p, Size sizePx) {
  p.sizePx = sizePx;
  p.stepPx = 1;
  const auto samplesOf = [&](int step) {
    return Size{(sizePx.width + step - 1) / step, (sizePx.height + step - 1) / step};
  };
  while (samplesOf(p.stepPx).area() > kMostSamples) ++p.stepPx;
  p.grid = samplesOf(p.stepPx);
  p.samples.assign(static_cast<size_t>(p.grid.area()), {});
  p.frames = 0;
  p.usual = 0;
}

void findEdges(Portrait& p) {
  const auto isSolidAt = [&](int column, int row) {
    return boundsOf(p.grid).contains({column, row}) &&
           p.isSolid(p.samples[static_cast<size_t>(row * p.grid.width + column)]);
  };
  for (int row = 0; row < p.grid.height; ++row)
    for (int column = 0; column < p.grid.width; ++column) {
      uint8_t& edges = p.samples[static_cast<size_t>(row * p.grid.width + column)].edges;
      edges = 0;
      if (!isSolidAt(column, row)) continue;
      edges = static_cast<uint8_t>(
          (isSolidAt(column - 1, row) ? 0 : kLeft) | (isSolidAt(column + 1, row) ? 0 : kRight) |
          (isSolidAt(column, row - 1) ? 0 : kTop) | (isSolidAt(column, row + 1) ? 0 : kBottom));
    }
}

bool isOtherSize(Size a, Size b) {
  return 8 * std::abs(a.width - b.width) > std::max(16, b.width) ||
         8 * std::abs(a.height - b.height) > std::max(16, b.height);
}

}  // namespace

bool Portrait::isSolid(const PortraitSample& sample) const {
  return 2 * sample.weight >= std::min<uint32_t>(frames, kMostWeight) && sample.weight > 0;
}

bool agrees(const PortraitSample& sample, const Picture& picture, int x, int y) {
  return difference(sample, picture, x, y) < kGain * kPerGain;
}

void learn(Portrait& p, const PortraitScene& scene, Point corner, Size sizePx,
           std::span<const uint16_t> owner, uint16_t own) {
  if (p.frames == 0 || isOtherSize(p.sizePx, sizePx)) begin(p, sizePx);
  const Evidence& e = scene.evidence;
  uint32_t solid = 0, agreeing = 0;
  for (int row = 0; row < p.grid.height; ++row)
    for (int column = 0; column < p.grid.width; ++column) {
      const int x = corner.x + column * p.stepPx, y = corner.y + row * p.stepPx;
      if (!boundsOf(e.frame).contains({x, y})) continue;
      PortraitSample& s = p.samples[static_cast<size_t>(row * p.grid.width + column)];
      const size_t cell =
          e.at(std::min(x / e.stepPx, e.grid.width - 1), std::min(y / e.stepPx, e.grid.height - 1));
      const bool isOwn = owner[cell] == own;
      if (p.frames > 0 && p.isSolid(s)) {
        ++solid;
        agreeing += isOwn && agrees(s, scene.picture, x, y);
      }
      if (!isOwn) {
        s.weight = static_cast<uint8_t>(std::max(0, s.weight - 1));
        continue;
      }
      s.red = mix(s.red, scene.picture.red().at(x, y), s.weight);
      s.green = mix(s.green, scene.picture.green().at(x, y), s.weight);
      s.blue = mix(s.blue, scene.picture.blue().at(x, y), s.weight);
      s.weight = std::min<uint8_t>(kMostWeight, static_cast<uint8_t>(s.weight + 1));
    }
  if (solid > 0) {
    const int64_t known = std::min<int64_t>(p.frames - 1, 7);
    p.usual = static_cast<uint16_t>(
        divideRounded(p.usual * known + int64_t{agreeing} * 256 / solid, known + 1));
  }
  countUp(p.frames);
  findEdges(p);
}

PortraitMatch findPortrait(const Portrait& p, const PortraitScene& scene,
                           const PortraitSearch& where, PortraitScratch& s) {
  const int rim = 1 + scene.evidence.stepPx;
  const Point corner = where.corner, reach = where.reach;
  const Box box{corner.x - reach.x - rim, corner.y - reach.y - rim,
                p.grid.width * p.stepPx + 2 * (reach.x + rim),
                p.grid.height * p.stepPx + 2 * (reach.y + rim)};
  const Finder finder{p, scene.picture, look(scene, box, s.state), where};
  const Point best = finder.find();
  const Score score = finder.scoreAt(best, 1);
  const auto gainAt = [&](int dx, int dy) {
    return finder.scoreAt({best.x + dx, best.y + dy}, 1).gain;
  };
  return {{best.x * 16 + topBetween(gainAt(-1, 0), score.gain, gainAt(1, 0)),
           best.y * 16 + topBetween(gainAt(0, -1), score.gain, gainAt(0, 1))},
          score.gain - finder.costOf(best, score.samples),
          score.samples,
          score.agreeing,
          score.seen,
          score.covered,
          score.ground};
}

}  // namespace rg
