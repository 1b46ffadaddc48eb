// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion_estimate.hpp"

#include "core/block_matching.hpp"
#include "core/pixel.hpp"

#include <algorithm>
#include <tuple>

namespace rg {
namespace {

constexpr int64_t kNoiseVariance = 16;     // Grey levels squared.
constexpr int64_t kCurvaturePerPixel = 4;  // Grey levels: half of full reliability.

/// Sums by shift of the region; d = −e.
template <class Sum>
class Surface {
 public:
  Surface(std::span<const Sum> sums, int reach) : sums_(sums), reach_(reach) {}
  [[nodiscard]] size_t indexOf(Point d) const {
    return static_cast<size_t>((reach_ - d.y) * (2 * reach_ + 1) + reach_ - d.x);
  }
  [[nodiscard]] int64_t at(Point d) const { return static_cast<int64_t>(sums_[indexOf(d)]); }
  [[nodiscard]] int reach() const { return reach_; }
  [[nodiscard]] std::span<const Sum> sums() const { return sums_; }

 private:
  std::span<const Sum> sums_;
  int reach_;
};

template <class Sum>
Point findBest(const Surface<Sum>& surface, int maxShift) {
  const auto key = [&](Point d) {
    return std::tuple(surface.at(d), d.x * d.x + d.y * d.y, d.y, d.x);
  };
  Point best{0, 0};
  for (int dy = -maxShift; dy <= maxShift; ++dy)
    for (int dx = -maxShift; dx <= maxShift; ++dx)
      if (surface.at({dx, dy}) <= surface.at(best) && key({dx, dy}) < key(best)) best = {dx, dy};
  return best;
}

/// 256 · value / (value + half): 0 for none, 128 for `half`.
int64_t saturating(int64_t value, int64_t half) {
  return value <= 0 ? 0 : kFullReliability * value / (value + std::max<int64_t>(half, 1));
}

/// Low where the luma changes along one direction only, or not at all.
int64_t gradientReliability(const GradientSums& g) {
  const auto pixels = static_cast<int64_t>(std::max<uint64_t>(g.pixels, 1));
  // Per pixel in 1/16, so that the squares fit: 4 · 255² · 16 < 2^23.
  const int64_t sum = (g.xx + g.yy) * 16 / pixels;
  const int64_t diff = (g.xx - g.yy) * 16 / pixels, twiceXy = 2 * g.xy * 16 / pixels;
  const auto root =
      static_cast<int64_t>(integerSqrt(static_cast<uint64_t>(diff * diff + twiceXy * twiceXy)));
  return saturating((sum - root) / 2, kNoiseVariance * 16);
}

template <class Sum>
int64_t curvatureReliability(const Surface<Sum>& surface, Point v, int64_t pixels) {
  constexpr Point kDirections[] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  int64_t least = INT64_MAX;
  for (const Point& e : kDirections)
    least = std::min(least, surface.at({v.x + e.x, v.y + e.y}) +
                                surface.at({v.x - e.x, v.y - e.y}) - 2 * surface.at(v));
  return saturating(least, kCurvaturePerPixel * pixels);
}

/// Low where another shift matches nearly as well: the lead over the second best is seen against
/// what the second best leaves unexplained, and against a shift at random.
template <class Sum>
int64_t peakReliability(const Surface<Sum>& surface, Point v, int64_t pixels) {
  int64_t second = INT64_MAX;
  for (int dx = -surface.reach(); dx <= surface.reach(); ++dx)
    for (int dy = -surface.reach(); dy <= surface.reach(); ++dy)
      if (std::max(absDiff(dx, v.x), absDiff(dy, v.y)) > 1)
        second = std::min(second, surface.at({dx, dy}));
  if (second == INT64_MAX) return kFullReliability;
  int64_t mean = 0;
  for (const Sum sum : surface.sums()) mean += static_cast<int64_t>(sum);
  mean /= static_cast<int64_t>(surface.sums().size());
  const int64_t lead = kFullReliability * (second - surface.at(v));
  return integerSqrt(static_cast<uint64_t>(lead / (second + pixels) * (lead / (mean + pixels))));
}

}  // namespace

template <class Sum>
RegionMotion estimateMotion(std::span<const Sum> sums, int reach, int maxShift,
                            const GradientSums& gradients) {
  const Surface<Sum> surface(sums, reach);
  const Point v = findBest(surface, maxShift);
  RegionMotion motion{v.x * kMotionUnit, v.y * kMotionUnit, static_cast<uint64_t>(surface.at(v)),
                      0};
  if (*std::min_element(sums.begin(), sums.end()) < sums[surface.indexOf(v)]) return motion;
  const auto pixels = static_cast<int64_t>(gradients.pixels);
  int64_t reliability =
      std::min(gradientReliability(gradients), curvatureReliability(surface, v, pixels));
  if (v != Point{} || motion.sad > 0)
    reliability = std::min(reliability, peakReliability(surface, v, pixels));
  motion.reliability = static_cast<uint16_t>(std::clamp<int64_t>(reliability, 0, kFullReliability));
  return motion;
}

template RegionMotion estimateMotion(std::span<const uint32_t>, int, int, const GradientSums&);
template RegionMotion estimateMotion(std::span<const uint64_t>, int, int, const GradientSums&);

}  // namespace rg
