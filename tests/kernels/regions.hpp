// SPDX-License-Identifier: LGPL-2.1-or-later
// Groups of cells and their division, in memory as a device has them.
#pragma once

#include "kernels/cell_groups.hpp"
#include "kernels/region_division.hpp"
#include "tests/kernels/parity.hpp"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace rg::test {

using Numbers = std::vector<uint32_t>;

/// Labels of up to so many kinds of patches, and pixels without any. Returns how many there are:
/// each has a pixel, as the stage has it.
inline uint32_t numberPatches(uint32_t kinds, int sidePx, Image<uint16_t>& ids) {
  std::vector<uint16_t> numbers(kinds + 1, 0);
  uint16_t count = 0;
  for (int y = 0; y < ids.height(); ++y)
    for (int x = 0; x < ids.width(); ++x) {
      const uint32_t kind = hashOf(x / sidePx, y / sidePx, 14) % (kinds + 1);
      if (kind != 0 && numbers[kind] == 0) numbers[kind] = ++count;
      ids.at(x, y) = numbers[kind];
    }
  return count;
}

/// Sums up what pairs of numbers come with.
using PairSums = std::map<std::pair<uint32_t, uint32_t>, uint32_t>;
inline void add(uint32_t a, uint32_t b, uint32_t value, PairSums& sums) {
  sums[std::minmax(a, b)] += value;
}

struct DevicePairs {
  std::vector<unsigned long long> keys;
  Numbers sums;
  explicit DevicePairs(uint64_t pairs)
      : keys(gpu::slotsFor(pairs), 0xA5A5A5A5), sums(keys.size(), 0xA5A5A5A5) {}
  gpu::PairTable view() { return {keys.data(), sums.data()}; }
};

struct DeviceGroups {
  Numbers of, first, numbers, scratch, parents, areas, wholes, wholeAreas;
  DevicePairs pairs;
  std::vector<segmentation::AbsorbedBorder> borders;
  uint32_t borderCount = 0xA5A5A5A5;

  explicit DeviceGroups(Size cells)
      : pairs(gpu::segmentation::mostBorders(cells.area())),
        borders(gpu::segmentation::mostBorders(cells.area())) {
    const auto count = static_cast<size_t>(cells.area());
    for (Numbers* list : {&of, &first, &parents, &areas, &wholes, &wholeAreas})
      list->assign(count, 0xA5A5A5A5);
    numbers.assign(count + 1, 0xA5A5A5A5);
    scratch.assign(static_cast<size_t>(gpu::scanScratchOf(static_cast<int>(count))), 0);
  }
  gpu::segmentation::GroupsView view() {
    return {of.data(),      first.data(),
            numbers.data(), scratch.data(),
            parents.data(), areas.data(),
            wholes.data(),  wholeAreas.data(),
            pairs.view(),   {borders.data(), &borderCount}};
  }
  [[nodiscard]] PairSums listed() const {
    PairSums sums;
    for (uint32_t i = 0; i < borderCount; ++i)
      add(borders[i].a, borders[i].b, borders[i].borderPx, sums);
    return sums;
  }
};

struct DeviceAbsorption {
  std::vector<segmentation::AbsorbedRegion> regions;
  uint32_t count = 0, left = 0xA5A5A5A5;
  std::vector<segmentation::AbsorbedBorder> borders;
  uint32_t borderCount = 0;
  DevicePairs pairs;
  Numbers forest, roots, numbers, perimeters;
  std::vector<unsigned long long> best;
  std::vector<segmentation::MeanColour> means;
  std::vector<uint8_t> chooses;

  DeviceAbsorption(size_t most, size_t mostBorders)
      : regions(most),
        borders(mostBorders),
        pairs(mostBorders),
        best(most),
        means(most),
        chooses(most) {
    for (Numbers* list : {&forest, &roots, &numbers, &perimeters}) list->assign(most, 0xA5A5A5A5);
  }
  gpu::segmentation::AbsorptionView view() {
    return viewWith({borders.data(), &borderCount}, pairs.view());
  }
  gpu::segmentation::AbsorptionView viewWith(const gpu::segmentation::BorderListView& list,
                                             const gpu::PairTable& table) {
    return {regions.data(), &count,         &left,
            list,           table,          forest.data(),
            roots.data(),   numbers.data(), perimeters.data(),
            best.data(),    means.data(),   chooses.data()};
  }
};

/// The borders and the table are those of the groups.
struct DeviceDivision {
  DeviceAbsorption absorption;
  Numbers firstOf, labels;
  std::vector<segmentation::AbsorbedRegion> labelled;
  uint32_t count = 0xA5A5A5A5;

  DeviceDivision(Size cells, uint32_t maxRegions)
      : absorption(static_cast<size_t>(cells.area()), 1),
        firstOf(static_cast<size_t>(cells.area())),
        labels(static_cast<size_t>(cells.area())),
        labelled(maxRegions + 1) {}
  gpu::segmentation::DivisionView view(DeviceGroups& groups) {
    return {absorption.viewWith({groups.borders.data(), &groups.borderCount}, groups.pairs.view()),
            firstOf.data(), labels.data(), labelled.data(), &count};
  }
};

}  // namespace rg::test
