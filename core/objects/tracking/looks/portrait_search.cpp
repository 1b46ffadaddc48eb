// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a portrait is. Most places are worse than one that is known long before all samples have
// been looked at: what the others can gain at most is known, so they are left out.
#include "core/base/pixel.hpp"
#include "core/objects/tracking/looks/portrait.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace rg::objects {
namespace {

constexpr int kFewSamples = 300;  // Of more, a quarter says where to look closely.
constexpr int kCoarse = 4;        // Places on either side that are tried first.
constexpr int kGain = 8;     // Of a sample whose colour is there, at most; also the most it loses.
constexpr int kPerGain = 4;  // Sums of three channels' differences that cost one.
static_assert(kGain * kPerGain == kAlike);
constexpr size_t kBlock = 32;  // Samples between two looks at what the others can gain.

enum State : uint8_t { kOutside, kCovered, kGround, kThing };

using Samples = PortraitScratch::Samples;

/// The rows and columns that a search looks at.
struct Window {
  Box box;
  int reach;  ///< To a neighbour's cell.
  const uint8_t* state;
};

/// Of the pixels from `begin` on of a row of cells.
void lookAtRow(const PortraitScene& scene, int cellRow, int begin, int end, uint8_t* to) {
  const GroupGrid& e = scene.evidence;
  const size_t first = e.at(0, cellRow);
  for (int x = begin; x < end;) {
    const int column = std::min(x / e.stepPx, e.grid.width - 1);
    const int next = column == e.grid.width - 1 ? end : std::min(end, (column + 1) * e.stepPx);
    const size_t cell = first + static_cast<size_t>(column);
    const bool isTaken = !scene.taken.empty() && scene.taken[cell] != 0;
    std::fill(to + (x - begin), to + (next - begin),
              isTaken              ? kCovered
              : e.group[cell] == 0 ? kGround
                                   : kThing);
    x = next;
  }
}

Window look(const PortraitScene& scene, const Box& box, std::vector<uint8_t>& state) {
  const GroupGrid& e = scene.evidence;
  state.assign(static_cast<size_t>(box.area()), kOutside);
  const Box inside = intersect(box, boundsOf(e.frame));
  const auto rowAt = [&](int y) {
    return state.data() + static_cast<ptrdiff_t>(y - box.y) * box.width + (inside.x - box.x);
  };
  int known = -1;
  for (int y = inside.y; y < inside.bottom(); ++y) {
    const int cellRow = std::min(y / e.stepPx, e.grid.height - 1);
    if (cellRow == known)
      std::copy_n(rowAt(y - 1), inside.width, rowAt(y));
    else
      lookAtRow(scene, cellRow, inside.x, inside.right(), rowAt(y));
    known = cellRow;
  }
  return {box, std::max(1, e.stepPx), state.data()};
}

/// The solid samples of every `skip`-th column and row.
void listSamples(const Portrait& p, const Window& window, ptrdiff_t strideBytes, int skip,
                 int64_t edgeGain, Samples& to) {
  to.list.clear();
  const uint32_t least = p.leastWeight();
  for (int row = 0; row < p.grid.height; row += skip)
    for (int column = 0; column < p.grid.width; column += skip) {
      const PortraitSample& s = p.samples[static_cast<size_t>(row * p.grid.width + column)];
      if (s.weight < least) continue;
      const ptrdiff_t x = column * p.stepPx, y = row * p.stepPx;
      to.list.push_back({y * window.box.width + x, y * strideBytes + x, s});
    }
  to.most.assign((to.list.size() + kBlock - 1) / kBlock, 0);
  int64_t most = 0;
  for (size_t i = to.list.size(); i-- > 0;) {
    most += kGain + edgeGain * std::popcount(to.list[i].sample.edges);
    if (i % kBlock == 0) to.most[i / kBlock] = most;
  }
}

struct Score {
  int64_t gain = 0;
  uint32_t agreeing = 0, seen = 0, covered = 0, ground = 0;
};

/// The search for the best shift from the expected corner.
class Finder {
 public:
  Finder(const Portrait& portrait, const PortraitScene& scene, const PortraitSearch& where,
         PortraitScratch& scratch, const Numbers::Likeness& numbers)
      : p_(portrait),
        colours_(scene.picture),
        window_(look(scene, searchedBox(portrait, scene.evidence, where), scratch.state)),
        where_(where),
        edgeGain_(numbers.edge.whole()),
        groundLoss_(numbers.ground.whole()),
        distance_(numbers.distance.whole()),
        s_(scratch) {
    listSamples(p_, window_, colours_.strideBytes(), 1, edgeGain_, s_.all);
    if (isLarge()) listSamples(p_, window_, colours_.strideBytes(), 2, edgeGain_, s_.some);
    s_.looks = 0;
  }

  [[nodiscard]] PortraitMatch find() const {
    const Point best = placeOf(findBest());
    const Score score = scoreAt(best, s_.all, INT64_MIN);
    const auto gainAt = [&](int dx, int dy) {
      return scoreAt({best.x + dx, best.y + dy}, s_.all, INT64_MIN).gain;
    };
    return {{best.x * 16 + topBetween(gainAt(-1, 0), score.gain, gainAt(1, 0)),
             best.y * 16 + topBetween(gainAt(0, -1), score.gain, gainAt(0, 1))},
            score.gain - costOf(best, s_.all.list.size()),
            static_cast<uint32_t>(s_.all.list.size()),
            score.agreeing,
            score.seen,
            score.covered,
            score.ground};
  }

 private:
  using Key = std::tuple<int64_t, int, int, int>;  ///< Cost, distance, row, column.
  static constexpr Key kWorst{INT64_MAX, 0, 0, 0};
  static Point placeOf(const Key& key) { return {std::get<3>(key), std::get<2>(key)}; }

  [[nodiscard]] bool isLarge() const { return p_.grid.area() > kFewSamples; }

  /// Where between a gain and its neighbours the top of a parabola is, in 1/16 px.
  static int topBetween(int64_t before, int64_t at, int64_t after) {
    const int64_t bend = 2 * at - before - after;
    if (bend <= 0) return 0;
    return static_cast<int>(std::clamp<int64_t>(divideRounded(8 * (after - before), bend), -8, 8));
  }

  /// What speaks for a place. Ends early where the gain is sure to stay below `least`; it is below
  /// that then.
  [[nodiscard]] Score scoreAt(Point shift, const Samples& samples, int64_t least) const {
    const Point corner{where_.corner.x + shift.x, where_.corner.y + shift.y};
    const uint8_t* state = window_.state +
                           static_cast<ptrdiff_t>(corner.y - window_.box.y) * window_.box.width +
                           (corner.x - window_.box.x);
    const ptrdiff_t pixel = corner.y * colours_.strideBytes() + corner.x;
    Score score;
    for (size_t first = 0; first < samples.list.size(); first += kBlock) {
      const int64_t gain = score.gain - groundLoss_ * score.ground;
      if (gain + samples.most[first / kBlock] < least) break;
      const size_t last = std::min(first + kBlock, samples.list.size());
      for (size_t i = first; i < last; ++i) addSample(samples.list[i], state, pixel, score);
      s_.looks += last - first;
    }
    score.gain -= groundLoss_ * score.ground;
    return score;
  }

  void addSample(const PortraitScratch::Solid& solid, const uint8_t* state, ptrdiff_t pixel,
                 Score& score) const {
    const uint8_t* at = state + solid.stateAt;
    score.ground += *at == kGround;
    score.covered += *at == kCovered;
    if (*at != kThing) return;
    ++score.seen;
    const int difference = colours_.difference(solid.sample, pixel + solid.pixelAt);
    const int gain = std::max(-kGain, kGain - difference / kPerGain);
    score.gain += gain;
    score.agreeing += gain > 0;
    if (solid.sample.edges == 0 || gain <= 0) return;
    const ptrdiff_t across = window_.reach, down = ptrdiff_t{window_.reach} * window_.box.width;
    const std::pair<PortraitEdge, ptrdiff_t> neighbours[] = {
        {kLeftEdge, -across}, {kRightEdge, across}, {kTopEdge, -down}, {kBottomEdge, down}};
    for (const auto& [edge, offset] : neighbours)
      if ((solid.sample.edges & edge) != 0 && at[offset] == kGround) score.gain += edgeGain_;
  }

  [[nodiscard]] int64_t costOf(Point shift, size_t samples) const {
    if (samples == 0) return 0;
    const int64_t width = std::max(1, p_.sizePx.width + 3 * where_.turn.x);
    const int64_t height = std::max(1, p_.sizePx.height + 3 * where_.turn.y);
    const int64_t across = shift.x * height, down = shift.y * width;
    const int64_t far = across * across + down * down;
    // Things as large as the largest frames, unseen for an hour, reach the ends of 64 bits.
    const int64_t weight = distance_ * kGain * static_cast<int64_t>(samples);
    const int64_t whole = width * width * height * height;
    const int64_t cost = std::min(far, INT64_MAX / weight) * weight /
                         (whole * std::min<int64_t>(where_.calm, INT64_MAX / whole));
    return std::min(cost, INT64_MAX / 1024) * 256 / where_.appearance;  // Sums of it fit, too.
  }

  /// Replaces `best` by the place if that is better.
  void tryPlace(Point shift, const Samples& samples, Key& best) const {
    if (std::abs(shift.x) > where_.reach.x || std::abs(shift.y) > where_.reach.y) return;
    const int64_t cost = costOf(shift, samples.list.size());
    const int64_t least = best == kWorst ? INT64_MIN : cost - std::get<0>(best);
    const Score score = scoreAt(shift, samples, least);
    best = std::min(
        best, Key{cost - score.gain, shift.x * shift.x + shift.y * shift.y, shift.y, shift.x});
  }

  /// Of the places up to `around` from `middle`. That comes first: mostly little is better.
  [[nodiscard]] Key bestOf(Point middle, Point around, Point stride, const Samples& samples) const {
    Key best = kWorst;
    tryPlace(middle, samples, best);
    for (int dy = middle.y - around.y; dy <= middle.y + around.y; dy += stride.y)
      for (int dx = middle.x - around.x; dx <= middle.x + around.x; dx += stride.x)
        if (Point{dx, dy} != middle) tryPlace({dx, dy}, samples, best);
    return best;
  }

  /// From a place to better ones around it, with ever smaller strides.
  [[nodiscard]] Key climb(Point place, Point stride, const Samples& samples) const {
    while (stride.x > 1 || stride.y > 1) {
      stride = {(stride.x + 1) / 2, (stride.y + 1) / 2};
      place = placeOf(bestOf(place, {2 * stride.x, 2 * stride.y}, stride, samples));
    }
    return bestOf(place, {1, 1}, {1, 1}, s_.all);
  }

  [[nodiscard]] Key findBest() const {
    const Samples& samples = isLarge() ? s_.some : s_.all;
    const Point reach = where_.reach;
    const Point stride{(reach.x + kCoarse - 1) / kCoarse, (reach.y + kCoarse - 1) / kCoarse};
    const Point from = placeOf(bestOf(
        {}, {reach.x / stride.x * stride.x, reach.y / stride.y * stride.y}, stride, samples));
    const Key best = climb(from, stride, samples);
    if (from == Point{}) return best;
    // A sliver that comes out from behind something lies between the coarse places.
    return std::min(best, climb({}, stride, samples));
  }

  const Portrait& p_;
  PortraitColours colours_;
  Window window_;
  const PortraitSearch& where_;
  int64_t edgeGain_, groundLoss_, distance_;
  PortraitScratch& s_;
};

}  // namespace

Box searchedBox(const Portrait& p, const GroupGrid& evidence, const PortraitSearch& where) {
  const int rim = 1 + evidence.stepPx;
  const Point corner = where.corner, reach = where.reach;
  return {corner.x - reach.x - rim, corner.y - reach.y - rim,
          p.grid.width * p.stepPx + 2 * (reach.x + rim),
          p.grid.height * p.stepPx + 2 * (reach.y + rim)};
}

PortraitMatch findPortrait(const Portrait& p, const PortraitScene& scene,
                           const PortraitSearch& where, PortraitScratch& s,
                           const Numbers::Likeness& numbers) {
  return Finder(p, scene, where, s, numbers).find();
}

}  // namespace rg::objects
