// SPDX-License-Identifier: LGPL-2.1-or-later
// The row functions of core/segmentation/border_pixels.cpp against plain ones: every target of this
// machine, odd widths, guards.
#include "core/base/pixel.hpp"
#include "core/simd/segmentation/border_rows.hpp"
#include "tests/core/fills.hpp"
#include "tests/core/simd_targets.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

namespace rg {
namespace {

using test::hashOf;

constexpr uint64_t kGuard = 0xA5A5A5A5A5A5A5A5;
constexpr uint64_t kApart = 1 << 16;
constexpr int kMostColumns = 70;

/// A row of cells of up to `regions` regions, some of none, some in scope apart.
struct Line {
  Line(int row, int count, uint32_t regions) {
    const auto length = static_cast<size_t>(count) + segmentation::simd::kSideLanes + 1;
    for (auto* words : {&keys, &colours, &pures}) words->assign(length, 0);
    for (int x = 1; x <= count; ++x) {
      const auto i = static_cast<size_t>(x);
      const uint64_t id = hashOf(x / 2, row / 2, regions) % (regions + 1);
      keys[i] = id == 0 ? 0 : id | (id % 4 == 3 ? kApart : 0);
      colours[i] = uint64_t{1} << 48 | hashOf(x, row, 1) % 256;
      pures[i] = hashOf(x, row, 2) % 3 == 0 ? colours[i] : 0;
    }
  }
  [[nodiscard]] segmentation::simd::PackedCells cells() const {
    return {keys.data() + 1, colours.data() + 1, pures.data() + 1};
  }
  std::vector<uint64_t> keys, colours, pures;
};

struct Sides {
  uint64_t own = 0, other = 0, others = 0;
  friend bool operator==(const Sides&, const Sides&) = default;
};

Sides plainSides(const std::array<Line, 3>& lines, size_t at) {
  const uint64_t own = lines[1].keys[at];
  Sides all, pure;
  std::set<uint64_t> others;
  for (const Line& line : lines)
    for (size_t x = at - 1; x <= at + 1; ++x) {
      const uint64_t key = line.keys[x];
      const bool isCentre = x == at && &line == &lines[1];
      if (key == own) all.own += isCentre ? line.pures[x] : line.colours[x];
      if (key == own) pure.own += line.pures[x];
      if (key == own || key == 0 || (key & kApart) != (own & kApart)) continue;
      others.insert(key);
      all.other += line.colours[x];
      pure.other += line.pures[x];
    }
  if (all.own == 0) all.own = lines[1].colours[at];
  const uint64_t key = others.size() > 1 ? segmentation::simd::kManySides
                       : others.empty()  ? 0
                                         : *others.begin();
  return {pure.own != 0 ? pure.own : all.own, pure.other != 0 ? pure.other : all.other, key};
}

TEST(SimdBorders, BothSidesOfABorderAreSummed) {
  int pairs = 0, many = 0;
  for (const uint32_t regions : {1u, 2u, 3u, 9u})
    for (int count = 1; count <= kMostColumns; ++count) {
      const std::array<Line, 3> lines{Line(1, count, regions), Line(2, count, regions),
                                      Line(4, count, regions)};
      const auto length = static_cast<size_t>(count) + segmentation::simd::kSideLanes - 1;
      test::forEachTarget([&] {
        std::vector<uint64_t> own(length + 1, kGuard), other = own, others = own;
        segmentation::simd::findSides({lines[0].cells(), lines[1].cells(), lines[2].cells()}, count,
                                      {own.data(), other.data(), others.data()});
        for (size_t x = 0; x < static_cast<size_t>(count); ++x) {
          const Sides right = plainSides(lines, x + 1);
          const bool isNone = lines[1].keys[x + 1] == 0;
          ASSERT_EQ(others[x], isNone ? 0 : right.others) << "cell " << x << " of " << count;
          pairs += others[x] != 0 && others[x] != segmentation::simd::kManySides;
          many += others[x] == segmentation::simd::kManySides;
          const Sides found{own[x], other[x], others[x]};
          ASSERT_TRUE(isNone || found == right) << "cell " << x << " of " << count;
        }
        for (const auto* sums : {&own, &other, &others}) EXPECT_EQ(sums->back(), kGuard);
      });
    }
  EXPECT_GT(pairs, 1000);
  EXPECT_GT(many, 1000);
}

TEST(SimdBorders, CellsArePackedIntoLanes) {
  constexpr uint8_t kPure = 12;
  for (int count = 1; count <= kMostColumns; ++count) {
    std::array<std::vector<uint8_t>, 4> bytes;
    std::vector<uint16_t> ids;
    for (int x = 0; x < count; ++x) {
      for (int k = 0; k < 3; ++k)
        bytes[static_cast<size_t>(k)].push_back(static_cast<uint8_t>(hashOf(x, k, 7)));
      bytes[3].push_back(static_cast<uint8_t>(kPure - 1 + hashOf(x, 3, 7) % 3));
      ids.push_back(static_cast<uint16_t>(hashOf(x, 4, 7)));
    }
    test::forEachTarget([&] {
      std::vector<uint64_t> keys(static_cast<size_t>(count) + 1, kGuard), colours = keys;
      std::vector<uint64_t> pures = keys;
      segmentation::simd::packCells(
          {bytes[0].data(), bytes[1].data(), bytes[2].data(), bytes[3].data(), ids.data()}, count,
          kPure, keys.data(), colours.data(), pures.data());
      for (size_t x = 0; x < static_cast<size_t>(count); ++x) {
        const uint64_t colour = bytes[0][x] + (uint64_t{bytes[1][x]} << 16) +
                                (uint64_t{bytes[2][x]} << 32) + (uint64_t{1} << 48);
        ASSERT_EQ(keys[x], ids[x]);
        ASSERT_EQ(colours[x], colour);
        ASSERT_EQ(pures[x], bytes[3][x] <= kPure ? colour : 0);
      }
      for (const auto* words : {&keys, &colours, &pures}) EXPECT_EQ(words->back(), kGuard);
    });
  }
}

TEST(SimdBorders, ElementsAreRepeated) {
  for (const int side : {2, 4, 8})
    for (const int count : {1, 3, 16, 33, kMostColumns}) {
      std::vector<uint8_t> bytes;
      std::vector<uint16_t> words;
      for (int x = 0; x < count; ++x) bytes.push_back(static_cast<uint8_t>(hashOf(x, 0, 3)));
      for (int x = 0; x < count; ++x) words.push_back(static_cast<uint16_t>(hashOf(x, 0, 4)));
      test::forEachTarget([&] {
        const auto length = static_cast<size_t>(count * side);
        std::vector<uint8_t> wideBytes(length + 1, 0xA5);
        std::vector<uint16_t> wideWords(length + 1, 0xA5A5);
        segmentation::simd::repeatRow(bytes.data(), count, side, wideBytes.data());
        segmentation::simd::repeatRow(words.data(), count, side, wideWords.data());
        for (size_t x = 0; x < length; ++x) {
          ASSERT_EQ(wideBytes[x], bytes[x / static_cast<size_t>(side)]);
          ASSERT_EQ(wideWords[x], words[x / static_cast<size_t>(side)]);
        }
        EXPECT_EQ(wideBytes.back(), 0xA5);
        EXPECT_EQ(wideWords.back(), 0xA5A5);
      });
    }
}

TEST(SimdBorders, PixelsGoToTheNearerSide) {
  constexpr int kMargin = 5;
  std::array<std::vector<uint8_t>, 9> rows;
  for (int k = 0; k < 9; ++k)
    for (int x = 0; x < kMostColumns; ++x)  // Wide apart, near to each other, and at the margin.
      rows[static_cast<size_t>(k)].push_back(static_cast<uint8_t>(
          x % 3 == 0 ? hashOf(x, k, 5) : 100 + hashOf(x, k, 6) % (x % 3 == 1 ? 8 : 2)));
  std::vector<uint16_t> owns, others;
  for (int x = 0; x < kMostColumns; ++x) {
    owns.push_back(static_cast<uint16_t>(2 * x));
    others.push_back(static_cast<uint16_t>(65535 - 2 * x));
  }
  segmentation::simd::PixelSides sides{{}, {}, {}, owns.data(), others.data(), kMargin};
  for (size_t c = 0; c < 3; ++c) {
    sides.pixels[c] = rows[c].data();
    sides.own[c] = rows[c + 3].data();
    sides.other[c] = rows[c + 6].data();
  }
  for (int count = 1; count <= kMostColumns; ++count)
    test::forEachTarget([&] {
      std::vector<uint16_t> ids(static_cast<size_t>(count) + 1, 0xA5A5);
      segmentation::simd::chooseSides(sides, count, ids.data());
      for (size_t x = 0; x < static_cast<size_t>(count); ++x) {
        int own = 0, other = kMargin;
        for (size_t c = 0; c < 3; ++c) {
          own += absDiff(rows[c][x], rows[c + 3][x]);
          other += absDiff(rows[c][x], rows[c + 6][x]);
        }
        const bool goes = std::min(other, 255) < std::min(own, 255);
        ASSERT_EQ(ids[x], goes ? others[x] : owns[x]) << "pixel " << x;
      }
      EXPECT_EQ(ids.back(), 0xA5A5);
    });
}

}  // namespace
}  // namespace rg
