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
  struct Mean {
    uint16_t red, green, blue;
  };

  [[nodiscard]] static Mean meanOf(const AbsorbedRegion& region);
  [[nodiscard]] uint64_t mergeRound();
  void chooseAllBelow(uint32_t areaPx);
  void chooseThin(uint32_t grainPx);
  void chooseSmallest(uint32_t count);
  void findBest();
  void contract();
  void numberKept();
  void joinBorders();
  [[nodiscard]] uint32_t distance(const AbsorbedBorder& border) const;

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
  std::vector<Mean> means_;
  std::vector<uint64_t> order_;
};

}  // namespace rg::segmentation
