// SPDX-License-Identifier: LGPL-2.1-or-later
// The row functions of core/simd/base against their plain references, on every target.
#include "core/simd/base/bit_rows.hpp"
#include "core/simd/base/picture_rows.hpp"
#include "tests/core/row_fills.hpp"

#include <array>
#include <tuple>
#include <utility>

namespace rg {
namespace {

using test::expectGuarded;
using test::expectSame;
using test::Fill;
using test::filled;
using test::forAll;
using test::kGuard;
using test::kMostColumns;
using test::padded;

TEST(SimdRows, PackingIsThePlainOne) {
  forAll([](const Fill& fill, int width) {
    const Image<uint8_t> bytes = filled(1, fill);
    constexpr uint64_t kUntouched = 0xA5A5A5A5A5A5A5A5;
    for (const int value : {0, 1, 254, 255}) {
      std::vector<uint64_t> expected(8, kUntouched), words(8, kUntouched);
      plain::packEqualRow(bytes.row(0), width, static_cast<uint8_t>(value), expected.data());
      simd::packEqualRow(bytes.row(0), width, static_cast<uint8_t>(value), words.data());
      ASSERT_EQ(words, expected) << "value " << value;
      ASSERT_EQ(words.at(static_cast<size_t>(padded(width) / 64)), kUntouched);
    }
  });
}

TEST(SimdRows, CountsWhatIsSet) {
  for (const int count : {0, 1, 7, 8, 9, 30}) {
    std::vector<uint64_t> words;
    uint32_t expected = 0;
    for (uint32_t i = 0; i < 64 * static_cast<uint32_t>(count); ++i) {
      if (i % 64 == 0) words.push_back(0);
      const uint64_t bit = mixHash(i, 0, 9) % 3 == 0;
      words.back() |= bit << i % 64;
      expected += static_cast<uint32_t>(bit);
    }
    EXPECT_EQ(plain::countBits(words.data(), count), expected);
    test::forEachTarget(
        [&] { EXPECT_EQ(simd::countBits(words.data(), count), expected) << count; });
  }
}

/// Four rows of a picture with guards behind them.
struct Planes {
  std::array<Image<uint8_t>, 4> rows;
  Planes() {
    for (Image<uint8_t>& row : rows) row = filled(1, [](int, int) { return kGuard; });
  }
  [[nodiscard]] ColourRows to() {
    return {rows[0].row(0), rows[1].row(0), rows[2].row(0), rows[3].row(0)};
  }
};

void expectSamePlanes(const Planes& a, const Planes& b, int width) {
  for (size_t i = 0; i < a.rows.size(); ++i) {
    expectSame(a.rows[i], b.rows[i], width);
    expectGuarded(a.rows[i], b.rows[i], width);
  }
}

TEST(SimdRows, PackedPixelsAreLoadedAsByThePlainOne) {
  constexpr std::array<PackedOrder, 4> kOrders{
      {{0, 1, 2, 3}, {2, 1, 0, 3}, {0, 1, 2, 4}, {2, 1, 0, 4}}};
  forAll([&](const Fill& fill, int width) {
    const PackedOrder& order = kOrders[static_cast<size_t>(width % 4)];
    std::vector<uint8_t> pixels;  // Of the very length, so that the sanitizer sees a step too far.
    for (int i = 0; i < width * order.bytesPerPixel; ++i) pixels.push_back(fill(i, 0));
    Planes expected, out;
    plain::loadPackedRow(pixels.data(), width, order, expected.to());
    simd::loadPackedRow(pixels.data(), width, order, out.to());
    expectSamePlanes(out, expected, width);
  });
}

TEST(SimdRows, PlanesOfColourAreLoadedAsByThePlainOne) {
  forAll([](const Fill& fill, int width) {
    std::array<std::vector<uint8_t>, 3> colours;
    for (int i = 0; i < width; ++i)
      for (int k = 0; k < 3; ++k) colours[static_cast<size_t>(k)].push_back(fill(i, k));
    const auto [red, green, blue] =
        std::tuple{colours[0].data(), colours[1].data(), colours[2].data()};
    Planes expected, out;
    plain::loadPlanarRow(red, green, blue, width, expected.to());
    simd::loadPlanarRow(red, green, blue, width, out.to());
    expectSamePlanes(out, expected, width);
  });
}

TEST(SimdRows, GatheringIsThePlainOne) {
  forAll([](const Fill& fill, int width) {
    for (const auto& [step, hasTenBits] : {std::pair{2, false}, {4, false}, {2, true}})
      for (int offset = 0; offset < (hasTenBits ? 1 : step); ++offset) {
        std::vector<uint8_t> row;  // Ends with the last sample.
        const int end = offset + step * (width - 1) + (hasTenBits ? 2 : 1);
        for (int i = 0; i < end; ++i) row.push_back(fill(i, 0));
        const SpacedRow from{row.data() + offset, step, hasTenBits};
        Image<uint8_t> expected = filled(1, [](int, int) { return kGuard; });
        Image<uint8_t> out = filled(1, [](int, int) { return kGuard; });
        plain::gatherRow(from, width, expected.row(0));
        simd::gatherRow(from, width, out.row(0));
        expectSame(out, expected, width);
        expectGuarded(out, expected, width);
      }
  });
}

TEST(SimdRows, YuvIsLoadedAsByThePlainOne) {
  constexpr std::array<YuvToRgb, 3> kMatrices{{{16, 19077, 26149, 6419, 13320, 33050},
                                               {0, 16384, 25802, 3069, 7670, 30402},
                                               {16, 19077, 32767, 3172, 11127, 35083}}};
  forAll([&](const Fill& fill, int width) {
    const YuvToRgb& k = kMatrices[static_cast<size_t>(width % 3)];
    const int step = 1 + width % 2;
    std::vector<uint8_t> luma, chroma;
    for (int i = 0; i < width; ++i) luma.push_back(fill(i, 0));
    for (int i = 0; i < (width + 1) / 2 * 2; ++i) chroma.push_back(fill(i, 1));
    const uint8_t* cr = chroma.data() + (step == 2 ? 1 : (width + 1) / 2);
    const YuvRows from{luma.data(), chroma.data(), cr, step};
    Planes expected, out;
    plain::loadYuvRow(from, width, k, expected.to());
    simd::loadYuvRow(from, width, k, out.to());
    expectSamePlanes(out, expected, width);
  });
}

}  // namespace
}  // namespace rg
