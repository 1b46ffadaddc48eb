// SPDX-License-Identifier: LGPL-2.1-or-later
// Merging of small regions into the neighbour most like them (part of stage 2).
//
// In each round every region below a limit chooses the neighbour of least key (squared colour
// distance of the means by length of the common border, id); chosen pairs merge all at once, then
// means and borders are computed anew. The limit grows from round to round, so that small ones find
// a home before they tear others along. Then thin regions do the same: the ramp of a blurred edge
// is a ribbon of its own colour along it, and so are the cells that an edge crosses.
// Determinism: choices depend on the state before the round only; sums commute.
#pragma once

#include <cstdint>
#include <vector>

namespace rg::segmentation {

struct AbsorbedRegion {
  uint64_t red = 0, green = 0, blue = 0;  ///< Sums over its pixels.
  uint32_t areaPx = 0;
  uint32_t representative = 0;  ///< The initial region that stands for it.
};

/// Two neighbours, and the pixel pairs across their border.
struct AbsorbedBorder {
  uint32_t a = 0;
  uint32_t b = 0;
  uint32_t borderPx = 0;
};

/// The mean colour of a region's pixels, in 1/16 grey levels, rounded down.
struct MeanColour {
  uint16_t red, green, blue;
};
inline constexpr int kMeanFractionBits = 4;
[[nodiscard]] constexpr MeanColour meanOf(const AbsorbedRegion& region) {
  const auto mean = [&](uint64_t sum) {
    const uint64_t fine = sum << kMeanFractionBits;
    // Most regions are small, and a short division takes half the time.
    return static_cast<uint16_t>(fine >> 32 == 0 ? static_cast<uint32_t>(fine) / region.areaPx
                                                 : fine / region.areaPx);
  };
  return {mean(region.red), mean(region.green), mean(region.blue)};
}

/// How little like each other two neighbours are: the same seen from both sides. Below
/// (3 · (255 · 16)² + 64²) · 16 < 2^30.
[[nodiscard]] constexpr uint32_t distanceAcross(const MeanColour& a, const MeanColour& b,
                                                uint32_t borderPx) {
  // Colours that differ by less than 4 grey levels: there the border's length decides.
  constexpr uint32_t kAlike = 4 << kMeanFractionBits, kUnit = 16;
  const int red = a.red - b.red, green = a.green - b.green, blue = a.blue - b.blue;
  const auto squares = static_cast<uint32_t>(red * red + green * green + blue * blue);
  return (squares + kAlike * kAlike) * kUnit / borderPx;
}

/// A ribbon of width w has about 2 / w pixels of border a pixel: thin is below a width of 1.5
/// grains.
[[nodiscard]] constexpr bool isThin(uint32_t areaPx, uint32_t perimeterPx, uint32_t grainPx) {
  return uint64_t{4} * areaPx < uint64_t{3} * grainPx * perimeterPx;
}

struct AbsorptionLimits {
  uint32_t minAreaPx = 1;
  uint32_t maxRegions = 1024;
  uint32_t grainPx = 1;  ///< Side of the cells that the initial regions are made of.
  uint32_t growth = 4;   ///< Of the limit, from round to round.
};

class Absorption {
 public:
  /// To be filled before run(): one entry an initial region, in order; borders in any order, more
  /// than one a pair if need be.
  std::vector<AbsorbedRegion>& regions() { return regions_; }
  std::vector<AbsorbedBorder>& borders() { return borders_; }

  /// Merges until no region with a neighbour is below the least area or thin and, as far as there
  /// are neighbours, no more than the largest number is left: that number exactly if there were
  /// more.
  void run(const AbsorptionLimits& limits);

  /// After run(): the initial region that stands for the region of initial region i.
  [[nodiscard]] uint32_t representative(uint32_t i);
  /// After run(): the regions that are left, in no promised order.
  [[nodiscard]] const std::vector<AbsorbedRegion>& left() const { return regions_; }

 private:
  [[nodiscard]] uint64_t mergeRound();
  void chooseAllBelow(uint32_t areaPx);
  void chooseThin(uint32_t grainPx);
  void chooseSmallest(uint32_t count);
  void findBest();
  void contract();
  void numberKept();
  void joinBorders();

  std::vector<AbsorbedRegion> regions_;
  std::vector<AbsorbedBorder> borders_, sorted_;
  std::vector<uint32_t> forest_;  ///< Initial region → one nearer to its representative.
  std::vector<uint32_t> perimeters_;
  std::vector<uint8_t> chooses_;   ///< Regions that look for a neighbour in this round.
  std::vector<uint8_t> hasGrown_;  ///< Regions that others went to in this round.
  std::vector<uint64_t> best_;     ///< Least key of each of those.
  std::vector<uint32_t> parents_;  ///< Where each region goes in this round.
  std::vector<uint32_t> numbers_;  ///< New number of each region after the round.
  std::vector<uint32_t> starts_, seenAt_;
  std::vector<MeanColour> means_;
  std::vector<uint64_t> order_;
};

}  // namespace rg::segmentation
