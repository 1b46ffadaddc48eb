// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/looks/portrait.hpp"

#include "core/base/pixel.hpp"
#include "core/base/time/frame_count.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace rg::objects {
namespace {

constexpr int kMostSamples = 1500;
constexpr uint8_t kMostWeight = Portrait::kMostWeight;

/// Inverses of 1 + what a sample weighs, in 1/2^16.
constexpr std::array<uint32_t, kMostWeight + 1> kInverses = [] {
  std::array<uint32_t, kMostWeight + 1> inverses{};
  for (uint32_t known = 0; known <= kMostWeight; ++known)
    inverses[known] = ((1u << 16) + known) / (known + 1);
  return inverses;
}();

constexpr uint32_t divide(uint32_t sum, uint32_t known) {
  return sum * kInverses[known] >> 16;
}
static_assert([] {
  for (uint32_t known = 0; known <= kMostWeight; ++known)
    for (uint32_t sum = 0; sum < 256 * (known + 2); ++sum)
      if (divide(sum, known) != sum / (known + 1)) return false;
  return true;
}());

/// (old · known + fresh) / (known + 1), rounded.
constexpr uint8_t mix(uint8_t old, uint8_t fresh, uint32_t known) {
  return static_cast<uint8_t>(divide(old * known + fresh + (known + 1) / 2, known));
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
  const uint32_t least = p.leastWeight();
  const auto isSolid = [&](const PortraitSample& s) { return s.weight >= least; };
  const ptrdiff_t width = p.grid.width;
  for (int row = 0; row < p.grid.height; ++row) {
    PortraitSample* samples = p.samples.data() + row * width;
    const bool hasUpper = row > 0, hasLower = row + 1 < p.grid.height;
    for (int column = 0; column < p.grid.width; ++column) {
      PortraitSample* at = samples + column;
      at->edges = 0;
      if (!isSolid(*at)) continue;
      const bool hasLeft = column > 0, hasRight = column + 1 < p.grid.width;
      at->edges = static_cast<uint8_t>((hasLeft && isSolid(at[-1]) ? 0 : kLeftEdge) |
                                       (hasRight && isSolid(at[1]) ? 0 : kRightEdge) |
                                       (hasUpper && isSolid(at[-width]) ? 0 : kTopEdge) |
                                       (hasLower && isSolid(at[width]) ? 0 : kBottomEdge));
    }
  }
}

bool isOtherSize(Size a, Size b) {
  return 8 * std::abs(a.width - b.width) > std::max(16, b.width) ||
         8 * std::abs(a.height - b.height) > std::max(16, b.height);
}

/// The rows or columns of samples that lie in the frame.
struct Range {
  int first, last;
};

Range rangeInside(int corner, int stepPx, int samples, int length) {
  const auto from = [&](int px) { return px <= 0 ? 0 : (px + stepPx - 1) / stepPx; };
  return {std::min(from(-corner), samples), std::min(from(length - corner), samples)};
}

struct Agreement {
  uint32_t solid = 0, agreeing = 0;
};

/// One row of samples, of which the pixels lie in row y.
class RowLearner {
 public:
  RowLearner(Portrait& p, const PortraitScene& scene, std::span<const uint16_t> owner, uint16_t own)
      : p_(p),
        e_(scene.evidence),
        colours_(scene.picture),
        owner_(owner),
        own_(own),
        least_(p.frames > 0 ? p.leastWeight() : UINT32_MAX) {}

  void learn(std::span<PortraitSample> samples, Point first, Agreement& agreement) const {
    const uint16_t* owners = owner_.data() + e_.at(0, first.y / e_.stepPx);
    int cell = first.x / e_.stepPx, within = first.x % e_.stepPx;
    ptrdiff_t place = colours_.placeOf(first.x, first.y);
    for (PortraitSample& sample : samples) {
      learn(sample, owners[cell] == own_, place, agreement);
      place += p_.stepPx;
      for (within += p_.stepPx; within >= e_.stepPx; within -= e_.stepPx) ++cell;
    }
  }

 private:
  void learn(PortraitSample& s, bool isOwn, ptrdiff_t place, Agreement& agreement) const {
    if (s.weight >= least_) {
      ++agreement.solid;
      agreement.agreeing += isOwn && colours_.agrees(s, place);
    }
    if (!isOwn) {
      s.weight = static_cast<uint8_t>(std::max(0, s.weight - 1));
      return;
    }
    const graph::Colour colour = colours_.at(place);
    s.red = mix(s.red, colour.red, s.weight);
    s.green = mix(s.green, colour.green, s.weight);
    s.blue = mix(s.blue, colour.blue, s.weight);
    s.weight = std::min<uint8_t>(kMostWeight, static_cast<uint8_t>(s.weight + 1));
  }

  const Portrait& p_;
  const GroupGrid& e_;
  PortraitColours colours_;
  std::span<const uint16_t> owner_;
  uint16_t own_;
  uint32_t least_;
};

}  // namespace

void learn(Portrait& p, const PortraitScene& scene, Point corner, Size sizePx,
           std::span<const uint16_t> owner, uint16_t own) {
  if (p.frames == 0 || isOtherSize(p.sizePx, sizePx)) begin(p, sizePx);
  const Size frame = scene.evidence.frame;
  const Range rows = rangeInside(corner.y, p.stepPx, p.grid.height, frame.height);
  const Range columns = rangeInside(corner.x, p.stepPx, p.grid.width, frame.width);
  const RowLearner learner(p, scene, owner, own);
  Agreement agreement;
  for (int row = rows.first; row < rows.last && columns.first < columns.last; ++row) {
    const auto first = static_cast<size_t>(row * p.grid.width + columns.first);
    learner.learn(
        std::span(p.samples).subspan(first, static_cast<size_t>(columns.last - columns.first)),
        {corner.x + columns.first * p.stepPx, corner.y + row * p.stepPx}, agreement);
  }
  if (agreement.solid > 0) {
    const int64_t known = std::min<int64_t>(p.frames - 1, 7);
    p.usual = static_cast<uint16_t>(divideRounded(
        p.usual * known + int64_t{agreement.agreeing} * 256 / agreement.solid, known + 1));
  }
  countUp(p.frames);
  findEdges(p);
}

}  // namespace rg::objects
