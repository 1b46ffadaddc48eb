// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/absorption.hpp"
#include "core/segmentation/border_pixels.hpp"
#include "core/segmentation/colour_links.hpp"
#include "core/segmentation/pixel_runs.hpp"
#include "core/segmentation/region_division.hpp"
#include "kernels/border_pixels.hpp"
#include "tests/kernels/divided.hpp"
#include "tests/kernels/regions.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace rg::test {
namespace {

using segmentation::ColourCells;
using segmentation::ColourLinks;
using segmentation::PixelRuns;
using segmentation::RegionDivision;
using segmentation::RunLimits;

/// The same components, with the same numbers, and the same borders.
void expectSame(const DeviceGroups& found, const PixelRuns& expected, Size size, uint32_t sidePx) {
  ASSERT_EQ(found.numbers.back(), expected.componentCount());
  Numbers of(found.of.size(), gpu::segmentation::kNoGroup);
  for (int y = 0; y < size.height; ++y)
    for (uint32_t i = expected.rowStart(y); i < expected.rowStart(y + 1); ++i)
      for (int x = expected.run(i).first; x < expected.run(i).last; ++x)
        of[static_cast<size_t>(y * size.width + x)] = expected.component(i);
  ASSERT_EQ(found.of, of);
  PairSums borders;
  expected.forBorders(
      [&](uint32_t a, uint32_t b, uint32_t pairs) { add(a, b, pairs * sidePx, borders); });
  ASSERT_EQ(found.listed(), borders);
  ASSERT_EQ(found.borderCount, borders.size());
}

ImageView<const uint8_t> linksOf(const ColourLinks& links) {
  const Size size = links.size();
  return {links.links(0), size, size.height > 1 ? links.links(1) - links.links(0) : size.width};
}

/// Cells of a picture, linked.
struct LinkedPicture {
  ColourCells cells;
  ColourLinks links;
  PixelRuns runs;
  LinkedPicture(const Divided& divided, int side, int similarity, const RunLimits& limits) {
    cells.build(divided.picture, divided.scopeView(), side, oneThread());
    links.build(cells.cells(), {similarity, similarity > 0, {}}, oneThread());
    runs.build(links, limits, oneThread());
  }
};

DeviceGroups grouped(const LinkedPicture& linked, const RunLimits& limits) {
  const segmentation::ColourGrid& cells = linked.cells.cells();
  DeviceGroups groups(cells.size);
  gpu::segmentation::groupLinked(Plane<uint8_t>(linksOf(linked.links)), cells.scope, limits,
                                 cells.sidePx, groups.view(), nullptr);
  return groups;
}

}  // namespace

void parity_groupLinked() {
  forDivided([](const Divided& divided) {
    for (const RunLimits& limits : {RunLimits{}, {20, 4}, {300, 16}})
      for (const auto& [side, similarity] : {std::pair{1, 12}, {1, 0}, {2, 250}}) {
        const LinkedPicture linked(divided, side, similarity, limits);
        expectSame(grouped(linked, limits), linked.runs, linked.links.size(),
                   static_cast<uint32_t>(side));
      }
  });
}

void parity_groupLabelled() {
  forDivided([](const Divided& divided) {
    const Size size = divided.picture.size();
    for (const uint32_t kinds : {1u, 3u, 1000u}) {
      Image<uint16_t> labels(size);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
          // No label is of two scopes, and none is out of scope.
          const uint32_t label = hashOf(x / 4, y / 2, 80) % (kinds + 1);
          const uint8_t scope = divided.hasScope ? divided.scope.at(x, y) : kInScope;
          const bool isNone = label == 0 || !isInScope(scope);
          labels.at(x, y) =
              static_cast<uint16_t>(isNone ? 0 : 2 * label + (scope == kInScope ? 0 : 1));
        }
      PixelRuns runs;
      runs.build(labels, divided.scopeView(), oneThread());
      DeviceGroups groups(size);
      gpu::segmentation::groupLabelled(Plane<uint16_t>(labels.view()), divided.scopeView(),
                                       groups.view(), nullptr);
      expectSame(groups, runs, size, 1);
    }
  });
}

void parity_absorb() {
  using segmentation::AbsorptionLimits;
  for (const uint32_t count : {1u, 2u, 40u, 900u})
    for (const uint32_t neighbours : {0u, 1u, 3u})
      for (const AbsorptionLimits& limits :
           {AbsorptionLimits{50, 1024, 1, 4}, {1, 7, 1, 4}, {400, 30, 2, 16}, {5000, 1, 8, 4}}) {
        SCOPED_TRACE(std::to_string(count) + " regions, " + std::to_string(neighbours));
        segmentation::Absorption expected;
        DeviceAbsorption there(count, 2 * count * neighbours + 1);
        for (uint32_t i = 0; i < count; ++i) {
          const auto draw = [&](uint32_t what) { return hashOf(static_cast<int>(i), 9, what); };
          const uint32_t area = 1 + draw(1) % 90;
          // Many are alike, so that lengths and numbers decide.
          const auto sum = [&](uint32_t what) { return uint64_t{area} * (draw(what) % 4 * 60); };
          expected.regions().push_back({sum(2), sum(3), sum(4), area, 0});
          for (uint32_t k = 0; k < 2 * neighbours; ++k) {
            const uint32_t other = k % 2 == 0 ? (i + 1 + k) % count : draw(5 + k) % count;
            if (other != i) expected.borders().push_back({i, other, 1 + draw(20 + k) % 5});
          }
        }
        std::copy(expected.regions().begin(), expected.regions().end(), there.regions.begin());
        std::copy(expected.borders().begin(), expected.borders().end(), there.borders.begin());
        there.count = count;
        there.borderCount = static_cast<uint32_t>(expected.borders().size());
        gpu::segmentation::absorb(limits, there.view(), nullptr);
        expected.run(limits);
        ASSERT_EQ(there.left, expected.left().size());
        for (size_t i = 0; i < there.left; ++i) {
          const segmentation::AbsorbedRegion &a = there.regions[i], &b = expected.left()[i];
          ASSERT_EQ(std::tuple(a.red, a.green, a.blue, a.areaPx, a.representative),
                    std::tuple(b.red, b.green, b.blue, b.areaPx, b.representative));
        }
        for (uint32_t i = 0; i < count; ++i) {
          uint32_t representative = i;
          while (there.forest[representative] != representative)
            representative = there.forest[representative];
          ASSERT_EQ(representative, expected.representative(i)) << i;
        }
      }
}

namespace {

constexpr RegionDivision::Limits kLimits[] = {{40, 200}, {1, 3}, {90, 65535}};

/// What both divisions of cells say.
struct Division {
  LinkedPicture linked;
  DeviceGroups groups;
  DeviceDivision there;
  RegionDivision core;
  Image<uint16_t> expected;
  Plane<uint16_t> ids;
  uint32_t count;

  Division(const Divided& divided, int side, const RegionDivision::Limits& limits)
      : linked(divided, side, 20, {200, 16}),
        groups(grouped(linked, {200, 16})),
        there(linked.links.size(), limits.maxRegions),
        expected(linked.links.size()),
        ids(linked.links.size()) {
    const segmentation::ColourGrid& cells = linked.cells.cells();
    count = core.run(cells, linked.runs, limits, oneThread(), expected);
    gpu::segmentation::divideRegions({planesOf(cells), cells.weights, cells.sidePx}, groups.view(),
                                     limits, there.view(groups), ids, nullptr);
  }
};

}  // namespace

void parity_divideRegions() {
  forDivided([](const Divided& divided) {
    for (const RegionDivision::Limits& limits : kLimits)
      for (const int side : {1, 4}) {
        Division division(divided, side, limits);
        ASSERT_EQ(division.there.count, division.count);
        division.ids.expect(std::as_const(division.expected).view(), "region");
      }
  });
}

void parity_divideAgain() {
  forDivided([](const Divided& divided) {
    const Size size = divided.picture.size();
    for (const RegionDivision::Limits& limits : kLimits) {
      Division first(divided, 2, {limits.minAreaPx, limits.maxRegions});
      // The labels of cells, some of them a pixel off.
      Image<uint16_t> expected(size);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
          const auto scopeAt = [&](int column) {
            return divided.hasScope ? divided.scope.at(column, y) : kInScope;
          };
          const int left = std::max(0, x - (hashOf(x, y, 7) % 5 == 0 ? 1 : 0));
          const int from = scopeAt(left) == scopeAt(x) ? left : x;
          expected.at(x, y) =
              isInScope(scopeAt(x)) ? first.expected.at(from / 2, y / 2) : uint16_t{0};
        }
      PixelRuns runs;
      runs.build(expected, divided.scopeView(), oneThread());
      Plane<uint16_t> ids(std::as_const(expected).view());
      DeviceGroups groups(size);
      DeviceDivision there(size, limits.maxRegions);
      gpu::segmentation::groupLabelled(ids, divided.scopeView(), groups.view(), nullptr);
      gpu::segmentation::divideAgain(first.there.labelled.data(), groups.view(), limits,
                                     there.view(groups), ids, nullptr);
      RegionDivision again;
      const uint32_t count = again.runAgain(first.core, first.linked.cells.pixels(), runs, limits,
                                            oneThread(), expected);
      ASSERT_EQ(there.count, count);
      ids.expect(std::as_const(expected).view(), "region");
    }
  });
}

void parity_refineBorders() {
  forDivided([](const Divided& divided) {
    const Size size = divided.picture.size();
    for (const int side : {2, 4, 8})
      for (const uint32_t kinds : {2u, 40u}) {
        ColourCells cells;
        cells.build(divided.picture, divided.scopeView(), side, oneThread());
        const segmentation::ColourGrid &grid = cells.cells(), &pixels = cells.pixels();
        Image<uint16_t> cellIds(grid.size);
        for (int y = 0; y < grid.size.height; ++y)
          for (int x = 0; x < grid.size.width; ++x) {
            const bool isIn = !divided.hasScope || isInScope(grid.scope.at(x, y));
            cellIds.at(x, y) = static_cast<uint16_t>(isIn ? hashOf(x / 2, y / 2, 90) % kinds : 0);
          }
        segmentation::BorderPixels refiner;
        Image<uint16_t> expected(size);
        refiner.refine(cells, cellIds, oneThread(), expected);
        std::vector<gpu::segmentation::SideChoice> choices(static_cast<size_t>(grid.size.area()));
        Plane<uint16_t> ids(size);
        gpu::segmentation::refineBorders({planesOf(grid), grid.scope, grid.ranges, cellIds,
                                          planesOf(pixels), pixels.scope, side},
                                         choices.data(), ids, nullptr);
        ids.expect(std::as_const(expected).view(), "region");
      }
  });
}

}  // namespace rg::test
