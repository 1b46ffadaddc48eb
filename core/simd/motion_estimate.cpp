// SPDX-License-Identifier: LGPL-2.1-or-later
// Plain integer arithmetic, compiled for every instruction set: all targets give the same bits.
#include "core/motion_estimate.hpp"

#include "core/block_matching.hpp"
#include "core/pixel.hpp"
#include "core/simd/targets.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/motion_estimate.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::simd::HWY_NAMESPACE {
namespace {

constexpr int64_t kNoiseVariance = 16;     // Grey levels squared.
constexpr int64_t kCurvaturePerPixel = 4;  // Grey levels: half of full reliability.

// A loop of which the compiler makes vectors: std::min is one of selected references.
template <class Sum>
Sum leastOf(const Sum* sums, size_t count) {
  Sum least = std::numeric_limits<Sum>::max();
  for (size_t i = 0; i < count; ++i) least = sums[i] < least ? sums[i] : least;
  return least;
}

/// Sums by shift of the region; d = −e.
template <class Sum>
class Surface {
 public:
  Surface(std::span<const Sum> sums, int reach) : sums_(sums), reach_(reach) {}
  [[nodiscard]] int64_t at(Point d) const { return static_cast<int64_t>(row(d.y)[reach_ - d.x]); }
  /// Of d.x = reach … −reach.
  [[nodiscard]] const Sum* row(int dy) const {
    return sums_.data() + static_cast<size_t>((reach_ - dy) * side());
  }
  [[nodiscard]] int reach() const { return reach_; }
  [[nodiscard]] int side() const { return 2 * reach_ + 1; }
  [[nodiscard]] std::span<const Sum> sums() const { return sums_; }

 private:
  std::span<const Sum> sums_;
  int reach_;
};

template <class Sum>
Point findBest(const Surface<Sum>& surface, int maxShift) {
  const auto count = static_cast<size_t>(2 * maxShift + 1);
  const int margin = surface.reach() - maxShift;
  std::array<Sum, 2 * kMostReach + 1> leasts{};
  for (int dy = -maxShift; dy <= maxShift; ++dy)
    leasts[static_cast<size_t>(dy + maxShift)] = leastOf(surface.row(dy) + margin, count);
  const Sum least = leastOf(leasts.data(), count);
  const auto key = [](Point d) { return std::tuple(d.x * d.x + d.y * d.y, d.y, d.x); };
  Point best{INT16_MAX, INT16_MAX};
  for (int dy = -maxShift; dy <= maxShift; ++dy) {
    if (leasts[static_cast<size_t>(dy + maxShift)] != least) continue;
    for (int dx = -maxShift; dx <= maxShift; ++dx)
      if (surface.row(dy)[surface.reach() - dx] == least && key({dx, dy}) < key(best))
        best = {dx, dy};
  }
  return best;
}

/// The least sum of all shifts but the 3x3 around v.
template <class Sum>
Sum leastBeside(const Surface<Sum>& surface, Point v) {
  Sum least = std::numeric_limits<Sum>::max();
  const auto look = [&](const Sum* first, const Sum* last) {
    if (first < last) least = std::min(least, leastOf(first, static_cast<size_t>(last - first)));
  };
  const int reach = surface.reach();
  const Sum *first = surface.sums().data(), *last = first + surface.sums().size();
  // Rows follow each other by falling d.y.
  const int above = std::min(v.y + 1, reach), below = std::max(v.y - 1, -reach);
  look(first, surface.row(above));
  for (int dy = above; dy >= below; --dy) {
    const Sum* row = surface.row(dy);
    look(row, row + (reach - v.x - 1));
    look(row + (reach - v.x + 2), row + surface.side());
  }
  look(surface.row(below) + surface.side(), last);
  return least;
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
  if (surface.reach() == 1 && v == Point{}) return kFullReliability;
  const auto second = static_cast<int64_t>(leastBeside(surface, v));
  uint64_t total = 0;
  for (const Sum sum : surface.sums()) total += sum;
  const auto mean = static_cast<int64_t>(total / surface.sums().size());
  const int64_t lead = kFullReliability * (second - surface.at(v));
  return integerSqrt(static_cast<uint64_t>(lead / (second + pixels) * (lead / (mean + pixels))));
}

template <class Sum>
RegionMotion estimate(std::span<const Sum> sums, int reach, int maxShift,
                      const GradientSums& gradients) {
  const Surface<Sum> surface(sums, reach);
  const Point v = findBest(surface, maxShift);
  const int64_t sad = surface.at(v);
  RegionMotion motion{v.x * kMotionUnit, v.y * kMotionUnit, static_cast<uint64_t>(sad), 0};
  if (static_cast<int64_t>(leastOf(sums.data(), sums.size())) < sad) return motion;
  const auto pixels = static_cast<int64_t>(gradients.pixels);
  int64_t reliability =
      std::min(gradientReliability(gradients), curvatureReliability(surface, v, pixels));
  if (v != Point{} || motion.sad > 0)
    reliability = std::min(reliability, peakReliability(surface, v, pixels));
  motion.reliability = static_cast<uint16_t>(std::clamp<int64_t>(reliability, 0, kFullReliability));
  return motion;
}

RegionMotion estimateNarrow(std::span<const uint32_t> sums, int reach, int maxShift,
                            const GradientSums& gradients) {
  return estimate(sums, reach, maxShift, gradients);
}

RegionMotion estimateWide(std::span<const uint64_t> sums, int reach, int maxShift,
                          const GradientSums& gradients) {
  return estimate(sums, reach, maxShift, gradients);
}

}  // namespace
}  // namespace rg::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg {
namespace simd {
namespace {
HWY_EXPORT(estimateNarrow);
HWY_EXPORT(estimateWide);
}  // namespace
}  // namespace simd

RegionMotion estimateMotion(std::span<const uint32_t> sums, int reach, int maxShift,
                            const GradientSums& gradients) {
  return HWY_DYNAMIC_DISPATCH(simd::estimateNarrow)(sums, reach, maxShift, gradients);
}

RegionMotion estimateMotion(std::span<const uint64_t> sums, int reach, int maxShift,
                            const GradientSums& gradients) {
  return HWY_DYNAMIC_DISPATCH(simd::estimateWide)(sums, reach, maxShift, gradients);
}

}  // namespace rg
#endif
