// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/scaled_cascade.hpp"
#include "kernels/haar_cascade.hpp"
#include "tests/core/detection/cascades.hpp"
#include "tests/kernels/parity.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

namespace rg::test {
namespace {

using detection::CascadeView;
using detection::Scale;
using detection::SearchWindows;
using detection::WindowPlace;
using detection::WindowTable;

constexpr uint16_t kUntouched = 0xA5A5;

std::vector<Scale> scalesOf(Size frame, Size window) {
  const auto scales = detection::scalesOf({frame, window, 1.3});
  return scales ? *scales : std::vector<Scale>();
}

/// Whole frames, and areas of which one is too small for windows.
std::vector<std::vector<Box>> areasOf(Size frame) {
  return {{boundsOf(frame)},
          {{0, 0, frame.width / 2, frame.height},
           {frame.width / 2 + 2, 1, 3, 3},
           {frame.width / 2 + 6, 0, frame.width / 2 - 6, frame.height}}};
}

}  // namespace

void parity_sumIntegrals() {
  forSizesAndFills([](Size size, int fill) {
    const Image<uint8_t> luma = filled(size, fill);
    const Size sums{size.width + 1, size.height + 1};
    Image<uint32_t> expected(sums);
    Image<double> squares(sums);
    detection::sumIntegrals(luma, {expected, squares});
    Plane<uint8_t> from{luma.view()};
    Plane<uint32_t> own(sums);
    Plane<double> ownSquares(sums);
    gpu::detection::sumIntegrals(from, {own, ownSquares}, nullptr);
    own.expect(expected, "sums");
    ownSquares.expect(squares, "squares");
  });
}

void parity_locateWindows() {
  for (const Size frame : {Size{8, 10}, Size{131, 67}, Size{200, 40}})
    for (const auto& areas : areasOf(frame)) {
      const auto scales = scalesOf(frame, {8, 10});
      SearchWindows windows;
      ASSERT_TRUE(windows.lay(scales, areas));
      const WindowTable table = windows.table();
      const WindowPlace none{-7, {-7, -7}};
      std::vector<WindowPlace> places(table.count + 1, none);
      gpu::detection::locateWindows(table, places.data(), nullptr);
      for (uint32_t id = 0; id < table.count; ++id)
        ASSERT_EQ(places[id], detection::placeOf(table, id)) << id;
      ASSERT_EQ(places.back(), none);
    }
}

void parity_judgeWindows() {
  std::set<int> depths;
  for (const Size frame : {Size{12, 15}, Size{131, 67}})
    for (int fill = 2; fill < kFills; ++fill)
      for (const auto& areas : areasOf(frame)) {
        const auto cascade = randomCascade(static_cast<uint32_t>(fill));
        const auto scales = scalesOf(frame, cascade.window);
        const Image<uint8_t> luma = filled(frame, fill);
        Plane<uint32_t> sums({frame.width + 1, frame.height + 1});
        Plane<double> squares({frame.width + 1, frame.height + 1});
        detection::sumIntegrals(luma, {sums, squares});
        const detection::SumLayout layout{1, 0, sums.view().strideBytes / 4,
                                          squares.view().strideBytes / 8};
        std::vector<detection::ScaledCascade> scaled;
        for (const Scale& scale : scales) scaled.emplace_back(cascade, scale, layout);
        std::vector<CascadeView> views;
        for (const auto& one : scaled) views.push_back(one.view());
        SearchWindows windows;
        ASSERT_TRUE(windows.lay(scales, areas));
        const WindowTable table = windows.table();
        const detection::JudgedPlanes planes{views.data(), sums, squares};
        std::vector<uint16_t> expected(table.count + 1, kUntouched), own = expected;
        detection::judgeWindows(planes, table, expected.data());
        gpu::detection::judgeWindows(planes, table, own.data(), nullptr);
        ASSERT_EQ(own, expected) << "fill " << fill;
        depths.insert(expected.begin(), expected.end() - 1);
      }
  ASSERT_GE(depths.size(), 5u);
}

}  // namespace rg::test
