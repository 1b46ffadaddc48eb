// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/colour_links.hpp"
#include "core/segmentation/hue_decision.hpp"
#include "kernels/colour_cells.hpp"
#include "kernels/hues.hpp"
#include "kernels/scopes.hpp"
#include "tests/kernels/divided.hpp"

#include <array>
#include <utility>
#include <vector>

namespace rg::test {
namespace {

using segmentation::ColourCells;
using segmentation::ColourGrid;
using segmentation::ColourSpace;

/// Where `scope` has something in it.
void expectInScope(Plane<uint8_t>& found, ImageView<const uint8_t> expected,
                   ImageView<const uint8_t> scope, const char* what) {
  for (int y = 0; y < expected.height(); ++y)
    for (int x = 0; x < expected.width(); ++x) {
      if (scope.data != nullptr && !isInScope(scope.at(x, y))) continue;
      ASSERT_EQ(+found.view().at(x, y), +expected.at(x, y)) << what << " " << x << ", " << y;
    }
  found.expectGuarded(what);
}

void expectGrid(DevicePlanes& found, const ColourGrid& expected) {
  for (size_t c = 0; c < static_cast<size_t>(expected.channels); ++c)
    expectInScope(found.planes[c], expected.colours[c], expected.scope, "colour");
}

}  // namespace

void parity_smoothColours() {
  forDivided([](const Divided& divided) {
    ColourCells cells;
    cells.build(divided.picture, divided.scopeView(), 1, oneThread());
    DevicePlanes out(divided.picture.size(), cells.pixels().channels);
    gpu::segmentation::smoothColours(inOrder(divided.picture), out, nullptr);
    expectGrid(out, cells.pixels());
  });
}

void parity_averageCells() {
  forDivided([](const Divided& divided) {
    for (const int side : {2, 4, 8}) {
      ColourCells cells;
      cells.build(divided.picture, divided.scopeView(), side, oneThread());
      const ColourGrid& expected = cells.cells();
      DevicePlanes out(expected.size, expected.channels);
      Plane<uint8_t> scope(expected.size), weights(expected.size), ranges(expected.size);
      gpu::segmentation::averageCells(planesOf(cells.pixels()), divided.scopeView(), side,
                                      {out, scope, weights, ranges}, nullptr);
      expectGrid(out, expected);
      expectInScope(weights, expected.weights, expected.scope, "weight");
      expectInScope(ranges, expected.ranges, expected.scope, "range");
      if (divided.hasScope) scope.expect(expected.scope, "scope");
    }
  });
}

void parity_linkColours() {
  forDivided([](const Divided& divided) {
    ColourCells cells;
    cells.build(divided.picture, divided.scopeView(), 1, oneThread());
    const Size size = divided.picture.size();
    for (const segmentation::LinkParams& params : {segmentation::LinkParams{12, true, {}},
                                                   {0, false, {}},
                                                   {300, true, {40, 500}},
                                                   {60, true, {1400, 300}},
                                                   {12, true, {}, ColourSpace::Hsv},
                                                   {40, false, {200, 400}, ColourSpace::Hsv}}) {
      segmentation::ColourLinks links;
      links.build(cells.pixels(), params, oneThread());
      Plane<uint8_t> out(size), nearest(size), saturations(size), values(size);
      Plane<int16_t> hues(size);
      gpu::segmentation::linkColours(planesOf(cells.pixels()), divided.scopeView(), params,
                                     &params.band, {out, nearest, hues, {{saturations, values}, 2}},
                                     nullptr);
      const ptrdiff_t stride = size.height > 1 ? links.links(1) - links.links(0) : size.width;
      out.expect({links.links(0), size, stride}, "links");
    }
  });
}

void parity_findFrameBand() {
  int bands = 0;
  const auto check = [&](const Picture& picture) {
    std::vector<uint32_t> levels(segmentation::kHueCount, 0xA5A5A5A5);
    segmentation::HueBand band{-1, -1};
    gpu::segmentation::findFrameBand(inOrder(picture), levels.data(), &band, nullptr);
    const segmentation::HueBand expected = segmentation::findFrameBand(picture, oneThread());
    ASSERT_EQ(band, expected);
    bands += expected.count > 0;
  };
  forDivided([&](const Divided& divided) { check(divided.picture); });
  // Pictures of one hue, with noise: peaks at all places of the circle.
  for (int i = 0; i < 12; ++i) {
    Image<uint8_t> packed({3 * 150, 70});
    for (int y = 0; y < 70; ++y)
      for (int x = 0; x < 150; ++x)
        for (int c = 0; c < 3; ++c)
          packed.at(3 * x + c, y) = static_cast<uint8_t>(
              (i + c) % 3 == 0 ? 40
                               : 60 + 12 * (i % 4) * c + static_cast<int>(hashOf(x, y, 3) % 9));
    Picture picture;
    loadPacked(packed, false, picture);
    check(picture);
  }
  EXPECT_GT(bands, 0);
}

void parity_coverAreas() {
  for (const Size size : kSizes)
    for (const int count : {0, 1, 7, 300}) {
      std::vector<Box> areas;
      std::vector<Component> list;
      for (int i = 0; i < count; ++i) {
        const auto draw = [&](uint32_t what, int most) {
          return static_cast<int>(hashOf(i, size.width, what) % static_cast<uint32_t>(most));
        };
        const int x = draw(1, size.width), y = draw(2, size.height);
        const Box box{x, y, 1 + draw(3, size.width - x), 1 + draw(4, size.height - y)};
        areas.push_back(box);
        list.push_back({box, 0, 0});
      }
      Image<uint8_t> expected(size);
      segmentation::coverAreas(areas, kInScopeApart, expected);
      Plane<uint8_t> out(size);
      const auto device = static_cast<uint32_t>(count);
      gpu::segmentation::coverAreas({list.data(), &device}, kInScopeApart, out, nullptr);
      out.expect(std::as_const(expected).view(), "areas");
    }
}

void parity_scopeByHue() {
  forDivided([](const Divided& divided) {
    const Size size = divided.picture.size();
    Image<uint8_t> hue(size), expected(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        hue.at(x, y) = static_cast<uint8_t>(std::array{0, 128, 255}[hashOf(x, y, 8) % 3]);
    const Image<uint8_t> seen = filled(size, 2);
    for (const bool hasEvidence : {false, true}) {
      const ImageView<const uint8_t> evidence =
          hasEvidence ? seen.view() : ImageView<const uint8_t>{};
      segmentation::scopeByHue(hue, evidence, divided.scopeView(), expected);
      Plane<uint8_t> out(size);
      gpu::segmentation::scopeByHue(hue, evidence, divided.scopeView(), out, nullptr);
      out.expect(std::as_const(expected).view(), "scope");
    }
  });
}

void parity_classifyHues() {
  forDivided([](const Divided& divided) {
    const Size size = divided.picture.size();
    for (const segmentation::HueRules& rules :
         {segmentation::HueRules{segmentation::BackgroundHue::FromPeak, {}, {}},
          {segmentation::BackgroundHue::Given, {1500, 400}, {300, 700}},
          {segmentation::BackgroundHue::Ignored, {}, {0, 900}}}) {
      const segmentation::HueBand peak{100, 60};
      Image<uint8_t> raw, expected(size);
      segmentation::classifyHues(divided.picture, rules, peak, divided.scopeView(), oneThread(),
                                 raw, expected);
      Plane<uint8_t> scratch(size), out(size);
      const gpu::Planes picture{
          {divided.picture.red(), divided.picture.green(), divided.picture.blue()}, 3};
      gpu::segmentation::classifyHues(picture, segmentation::bandsOf(rules, peak),
                                      divided.scopeView(), scratch, out, nullptr);
      out.expect(std::as_const(expected).view(), "classes");
    }
  });
}

}  // namespace rg::test
