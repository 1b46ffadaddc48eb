// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/bit_mask.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

#include <random>

namespace rg {
namespace {

using test::drawBits;
using test::textOf;
using Lines = std::vector<std::string>;

Image<uint8_t> noise(Size size, unsigned seed) {
  std::mt19937 random(seed);
  Image<uint8_t> image(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) image.at(x, y) = random() % 4 == 0 ? 255 : 0;
  return image;
}

TEST(BitMask, PacksAndPaintsAtAnyWidth) {
  for (const int width : {1, 63, 64, 65, 128, 257}) {
    const Image<uint8_t> bytes = noise({width, 3}, 1);
    BitMask mask;
    packEqual(bytes, 255, mask);
    EXPECT_EQ(textOf(mask), textOf(bytes));
    uint32_t count = 0;
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < width; ++x) count += mask.at(x, y);
    EXPECT_EQ(countSet(mask), count);
  }
}

TEST(BitMask, PaintingLeavesOtherPixelsAlone) {
  Image<uint8_t> bytes({70, 1});
  bytes.fill(7);
  BitMask mask({70, 1});
  mask.clear();
  setColumns(mask.row(0), 60, 66, true);
  paint(mask, 128, bytes);
  for (int x = 0; x < 70; ++x) EXPECT_EQ(bytes.at(x, 0), x >= 60 && x < 66 ? 128 : 7) << x;
}

TEST(BitMask, ColumnsAreSetAndCountedAcrossWords) {
  BitMask mask({300, 1});
  mask.clear();
  setColumns(mask.row(0), 10, 290, true);
  setColumns(mask.row(0), 64, 128, false);
  EXPECT_EQ(countColumns(mask.row(0), 0, 300), 216);
  EXPECT_EQ(countColumns(mask.row(0), 60, 130), 6);
  EXPECT_EQ(countColumns(mask.row(0), 64, 64), 0);
}

TEST(BitMask, SetPixelsAreVisitedInRasterOrder) {
  const BitMask mask = drawBits({"#..", "..#", ".#."});
  std::vector<Point> seen;
  forSetPixels(mask, 1, 3, [&](int x, int y) { seen.push_back({x, y}); });
  EXPECT_EQ(seen, (std::vector<Point>{{2, 1}, {1, 2}}));
}

TEST(BitMask, RemovingAndKeepingAreOpposites) {
  const BitMask chosen = drawBits({"##.."});
  BitMask removed = drawBits({".###"}), kept = drawBits({".###"});
  remove(chosen, removed);
  keepOnly(chosen, kept);
  EXPECT_EQ(textOf(removed), Lines{"..##"});
  EXPECT_EQ(textOf(kept), Lines{".#.."});
}

TEST(BitMask, ThickeningReachesASquare) {
  for (const int width : {5, 64, 130})
    for (const int margin : {1, 4}) {
      const Image<uint8_t> bytes = noise({width, 9}, 5);
      BitMask mask, across, thick;
      packEqual(bytes, 255, mask);
      thicken(mask, margin, Executor(2), across, thick);
      for (int y = 0; y < 9; ++y)
        for (int x = 0; x < width; ++x) {
          bool isNear = false;
          for (int v = std::max(0, y - margin); v <= std::min(8, y + margin); ++v)
            for (int u = std::max(0, x - margin); u <= std::min(width - 1, x + margin); ++u)
              isNear = isNear || bytes.at(u, v) != 0;
          ASSERT_EQ(thick.at(x, y), isNear) << x << ", " << y << " of " << width;
        }
      EXPECT_EQ(thick.row(0)[thick.wordsPerRow() - 1] & ~thick.columnsOf(thick.wordsPerRow() - 1),
                0u);
    }
}

}  // namespace
}  // namespace rg
