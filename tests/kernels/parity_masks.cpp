// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/mask_cleaning.hpp"
#include "core/base/mask_gaps.hpp"
#include "kernels/cast_shadows.hpp"
#include "kernels/mask_gaps.hpp"
#include "kernels/primitives.hpp"
#include "tests/kernels/masks.hpp"
#include "tests/kernels/tested_device.hpp"

#include <numeric>
#include <vector>

namespace rg::test {
namespace {

void expectSame(const DeviceComponents& found, const Components& expected) {
  ASSERT_EQ(found.firstRun.back(), expected.runs.size());
  ASSERT_EQ(found.firstRoot.back(), expected.list.size());
  for (size_t i = 0; i < expected.runs.size(); ++i) {
    ASSERT_EQ(static_cast<const Run&>(found.runs[i]), static_cast<const Run&>(expected.runs[i]));
    ASSERT_EQ(found.runs[i].component, expected.runs[i].component) << "run " << i;
  }
  for (size_t i = 0; i < expected.list.size(); ++i) {
    ASSERT_EQ(found.list[i].box, expected.list[i].box) << "component " << i;
    ASSERT_EQ(found.list[i].areaPx, expected.list[i].areaPx) << "component " << i;
    ASSERT_EQ(found.list[i].firstPixel, expected.list[i].firstPixel) << "component " << i;
  }
}

}  // namespace

void parity_packEqual() {
  forMasks([](const BitMask& mask) {
    Image<uint8_t> bytes(mask.size());
    bytes.fill(127);
    paint(mask, 128, bytes);
    Plane<uint8_t> there(bytes.view());
    Bits out(mask.size());
    gpu::packEqual(there, 128, out, nullptr);
    out.expect(mask, "packed");
  });
}

void parity_paint() {
  forMasks([](const BitMask& mask) {
    Image<uint8_t> expected(mask.size());
    expected.fill(7);
    Plane<uint8_t> there(expected.view());
    paint(mask, 128, expected);
    gpu::paint(Bits(mask), 128, there, nullptr);
    there.expect(expected.view(), "painted");
  });
}

void parity_remove() {
  forMasks([](const BitMask& mask) {
    BitMask expected = scattered(mask.size(), 4);
    Bits there(expected);
    remove(mask, expected);
    gpu::remove(Bits(mask), there, nullptr);
    there.expect(expected, "rest");
  });
}

void parity_keepOnly() {
  forMasks([](const BitMask& mask) {
    BitMask expected = scattered(mask.size(), 4);
    Bits there(expected);
    keepOnly(mask, expected);
    gpu::keepOnly(Bits(mask), there, nullptr);
    there.expect(expected, "rest");
  });
}

void parity_countSet() {
  forMasks([](const BitMask& mask) {
    uint32_t count = 0xA5A5A5A5;
    gpu::countSet(Bits(mask), &count, nullptr);
    ASSERT_EQ(count, countSet(mask));
  });
}

void parity_keepInside() {
  forMasks([](const BitMask& mask) {
    Image<uint8_t> interest(mask.size()), scope = filled(mask.size(), 5);
    interest.fill(0);
    paint(mask, 255, interest);
    Plane<uint8_t> there(scope.view());
    gpu::keepInside(Plane<uint8_t>(interest.view()), there, nullptr);
    keepInside(interest, scope);
    there.expect(scope.view(), "inside");
  });
}

void parity_paintForeground() {
  forMasks([](const BitMask& mask) {
    for (const Point shift : {Point{0, 0}, Point{3, -1}, Point{-2, 3}}) {
      if (mask.width() < 4 && shift != Point{}) continue;  // Nothing that findShift() could see.
      const BitMask shadow = scattered(mask.size(), 5);
      Image<uint8_t> expected(mask.size());
      background::paintForeground(mask, shadow, shift, oneThread(), expected);
      Plane<uint8_t> out(mask.size());
      gpu::background::paintForeground(Bits(mask), Bits(shadow), shift, out, nullptr);
      out.expect(expected.view(), "foreground");
    }
  });
}

void parity_fillUnedged() {
  uint32_t filledPixels = 0;
  forMasks([&](const BitMask& mask) {
    const Size size = mask.size();
    for (const int fill : {0, 4, 5})
      for (const uint32_t mostPx : {20u, 5000u}) {
        const Image<uint8_t> picture = filled(size, fill);
        GapScratch scratch;
        BitMask expected(size);
        for (int y = 0; y < size.height; ++y)
          std::copy_n(mask.row(y), mask.wordsPerRow(), expected.row(y));
        fillUnedged(picture, 40, mostPx, oneThread(), scratch, expected);
        Bits there(mask), thick(size), chosen(size);
        DeviceComponents parts(size);
        std::vector<GapContour> contours(parts.runs.size());
        gpu::fillUnedged(Plane<uint8_t>(picture.view()), 40, mostPx,
                         {thick, chosen, parts.view(), contours.data()}, there, nullptr);
        there.expect(expected, "without gaps");
        filledPixels += countSet(expected) - countSet(mask);
      }
  });
  EXPECT_GT(filledPixels, 0u);
}

void parity_thicken() {
  forMasks([](const BitMask& mask) {
    for (const int margin : {1, 2, 9, 63}) {
      BitMask across, expected;
      thicken(mask, margin, oneThread(), across, expected);
      Bits out(mask.size());
      gpu::thicken(Bits(mask), margin, out, nullptr);
      out.expect(expected, "thick");
    }
  });
}

void parity_findComponents() {
  forMasks([](const BitMask& mask) {
    for (const Connectivity connectivity : {Connectivity::Four, Connectivity::Eight})
      for (const bool value : {false, true}) {
        Components expected;
        findComponents(mask, value, connectivity, expected);
        DeviceComponents found(mask.size());
        gpu::findComponents(Bits(mask), value, connectivity, found.view(), nullptr);
        expectSame(found, expected);
      }
  });
}

void parity_keepMajority() {
  forMasks([](const BitMask& mask) {
    for (const int radius : {1, 2, 3, 7})
      for (const int share : {115, 128, 255}) {
        background::CleaningScratch scratch;
        BitMask expected(mask.size());
        background::keepMajority(mask, radius, share, oneThread(), scratch, expected);
        Bits out(mask.size());
        gpu::background::keepMajority(Bits(mask), radius, share, out, nullptr);
        out.expect(expected, "majority");
      }
  });
}

void parity_dropSmallParts() {
  forMasks([](BitMask mask) {
    Bits there(mask);
    background::CleaningScratch scratch;
    DeviceComponents found(mask.size());
    gpu::background::dropSmallParts(there, 4, found.view(), nullptr);
    background::dropSmallParts(mask, 4, scratch);
    there.expect(mask, "large parts");
  });
}

void parity_fillHoles() {
  forMasks([](BitMask mask) {
    Bits there(mask);
    background::CleaningScratch scratch;
    DeviceComponents found(mask.size());
    gpu::background::fillHoles(there, 5, found.view(), nullptr);
    background::fillHoles(mask, 5, scratch);
    there.expect(mask, "without holes");
  });
}

void parity_keepSupported() {
  forMasks([](BitMask mask) {
    const BitMask strong = scattered(mask.size(), 9);
    Bits there(mask);
    background::CleaningScratch scratch;
    DeviceComponents found(mask.size());
    gpu::background::keepSupported(there, Bits(strong), 3, found.view(), nullptr);
    background::keepSupported(mask, strong, 3, scratch);
    there.expect(mask, "supported");
  });
}

void parity_keepCastShadows() {
  forMasks([](const BitMask& mask) {
    // Darkened patches of it, some of them cut by its gaps.
    BitMask dark = scattered(mask.size(), 11);
    keepOnly(mask, dark);
    Bits there(dark);
    background::CastShadowScratch scratch;
    DeviceComponents found(mask.size());
    std::vector<background::DarkPart> parts(found.runs.size());
    std::vector<uint32_t> darkOf(found.runs.size(), 0xA5A5A5A5);
    gpu::background::keepCastShadows(Bits(mask), there, {found.view(), parts.data(), darkOf.data()},
                                     nullptr);
    background::keepCastShadows(mask, dark, scratch);
    there.expect(dark, "cast");
  });
}

}  // namespace rg::test

namespace rg {

TEST(Primitives, AScanSumsWhatStandsBefore) {
  for (const int count : {1, 31, 1024, 1025, 5000, 300000}) {
    test::shuffleThreads(3);
    std::vector<uint32_t> numbers(static_cast<size_t>(count)), sums(numbers.size() + 1, 9);
    for (size_t i = 0; i < numbers.size(); ++i)
      numbers[i] = test::hashOf(static_cast<int>(i), 0, 1);
    std::vector<uint32_t> expected(sums.size());
    std::partial_sum(numbers.begin(), numbers.end(), expected.begin() + 1);
    std::vector<uint32_t> scratch(static_cast<size_t>(gpu::scanScratchOf(count)));
    gpu::scan(numbers.data(), count, sums.data(), scratch.data(), nullptr);
    ASSERT_EQ(sums, expected) << count;
    sums.assign(numbers.begin(), numbers.end());
    sums.push_back(9);
    gpu::scan(sums.data(), count, sums.data(), scratch.data(), nullptr);
    ASSERT_EQ(sums, expected) << count << " in place";
    test::expectNoFindings();
  }
}

}  // namespace rg
