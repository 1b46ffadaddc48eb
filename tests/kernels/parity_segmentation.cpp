// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/colour_links.hpp"
#include "core/segmentation/hue_decision.hpp"
#include "kernels/colour_cells.hpp"
#include "kernels/hues.hpp"
#include "tests/kernels/parity.hpp"
#include "tests/kernels/pictures.hpp"

#include <utility>

namespace rg::test {
namespace {

using segmentation::ColourCells;
using segmentation::ColourGrid;

/// What is divided: all of a picture, or what is in scope and in scope apart.
struct Divided {
  Picture picture;
  Image<uint8_t> scope;
  bool hasScope;
  [[nodiscard]] ImageView<const uint8_t> scopeView() const {
    return hasScope ? scope.view() : ImageView<const uint8_t>{};
  }
};

template <class Check>
void forDivided(const Check& check) {
  forSizesAndFills([&](Size size, int fill) {
    for (const bool isGrey : {false, true})
      for (const bool hasScope : {false, true}) {
        Divided divided{{}, Image<uint8_t>(size), hasScope};
        loadScene(size, fill, 1, isGrey, divided.picture);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) {
            // Kinds follow blocks of 8x8, which no cell leaves.
            const uint8_t kind = hashOf(x / 8, y / 8, 4) % 3 == 0 ? kInScopeApart : kInScope;
            divided.scope.at(x, y) = hashOf(x / 3, y / 3, 5) % 3 == 0 ? uint8_t{128} : kind;
          }
        check(divided);
      }
  });
}

gpu::Planes inOrder(const Picture& picture) {
  return {{picture.red(), picture.green(), picture.blue()}, picture.isGrey() ? 1 : 3};
}

gpu::Planes planesOf(const ColourGrid& grid) {
  return {{grid.colours[0], grid.colours[1], grid.colours[2]}, grid.channels};
}

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
                                                   {60, true, {1400, 300}}}) {
      segmentation::ColourLinks links;
      links.build(cells.pixels(), params, oneThread());
      Plane<uint8_t> out(size), nearest(size);
      Plane<int16_t> hues(size);
      gpu::segmentation::linkColours(planesOf(cells.pixels()), divided.scopeView(), params,
                                     {out, nearest, hues}, nullptr);
      const ptrdiff_t stride = size.height > 1 ? links.links(1) - links.links(0) : size.width;
      out.expect({links.links(0), size, stride}, "links");
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
