// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/mask_cleaning.hpp"
#include "core/base/mask_gaps.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using test::drawBits;
using test::drawMask;
using test::textOf;
using Lines = std::vector<std::string>;

Lines majority(const Lines& lines, int radius, int share, int threads = 1) {
  const BitMask mask = drawBits(lines);
  BitMask out(mask.size());
  background::CleaningScratch scratch;
  background::keepMajority(mask, radius, share, Executor(threads), scratch, out);
  return textOf(out);
}

TEST(MaskCleaning, TheMedianDropsSpecksAndFillsPinholes) {
  EXPECT_EQ(majority({"....", ".#..", "....", "...."}, 1, 128),
            (Lines{"....", "....", "....", "...."}));
  EXPECT_EQ(majority({"#####", "#####", "##.##", "#####", "#####"}, 1, 128)[2], "#####");
}

TEST(MaskCleaning, TheBorderIsRepeatedOutside) {
  EXPECT_EQ(majority({"##.", "##.", "..."}, 1, 128), (Lines{"##.", "#..", "..."}));
  // A column at the frame's right border, in its word's first bit and in one further in.
  for (const size_t width : {size_t{65}, size_t{70}, size_t{128}}) {
    const std::string line = std::string(width - 1, '.') + '#';
    EXPECT_EQ(majority({line, line, line}, 1, 128), (Lines{line, line, line})) << width;
    EXPECT_EQ(majority({line, line, line}, 1, 192), (Lines(3, std::string(width, '.')))) << width;
  }
}

TEST(MaskCleaning, AWindowWiderThanThePictureStaysInside) {
  EXPECT_EQ(majority({"#"}, 7, 0), (Lines{"#"}));
  EXPECT_EQ(majority({"#.", "##"}, 5, 0), (Lines{"##", "##"}));
  // Three quarters of what is outside repeat set pixels.
  EXPECT_EQ(majority({"#.", "##"}, 5, 128), (Lines{"##", "##"}));
}

TEST(MaskCleaning, ThreadsChangeNothing) {
  Lines lines;
  uint32_t state = 3;
  for (int y = 0; y < 100; ++y) {
    std::string line;
    for (int x = 0; x < 67; ++x)
      line += (state = state * 1664525u + 1013904223u) >> 31 == 0 ? '.' : '#';
    lines.push_back(line);
  }
  EXPECT_EQ(majority(lines, 3, 120, 1), majority(lines, 3, 120, 2));
}

TEST(MaskCleaning, SmallPartsGoByTheirFourConnectedArea) {
  BitMask mask = drawBits({"##...", "..##.", "..##."});
  background::CleaningScratch scratch;
  background::dropSmallParts(mask, 3, scratch);
  EXPECT_EQ(textOf(mask), (Lines{".....", "..##.", "..##."}));
}

TEST(MaskCleaning, OnlyEnclosedSmallHolesAreFilled) {
  BitMask mask = drawBits({"#####.", "#.#.#.", "#####.", "#..###", "#..#.#", "####.#"});
  background::CleaningScratch scratch;
  background::fillHoles(mask, 2, scratch);
  // The two pinholes go; the hole of four is too large, the crack reaches the border.
  EXPECT_EQ(textOf(mask), (Lines{"#####.", "#####.", "#####.", "#..###", "#..#.#", "####.#"}));
}

TEST(MaskCleaning, HysteresisKeepsWeakPixelsThatTouchStrongOnes) {
  BitMask mask = drawBits({"###..##", "..#..##"});
  const BitMask strong = drawBits({"..#....", "..#...."});
  background::CleaningScratch scratch;
  background::keepSupported(mask, strong, 2, scratch);
  EXPECT_EQ(textOf(mask), (Lines{"###....", "..#...."}));
}

Lines filled(const Lines& lines, const Box& box) {
  const Image<uint8_t> edges = drawMask(lines);
  Image<uint8_t> out(edges.size());
  out.fill(0);
  background::CleaningScratch scratch;
  background::fillLines(edges, box, scratch, out);
  return textOf(out);
}

TEST(LineSegmentation, FillsWhatRowsAndColumnsBothEnclose) {
  EXPECT_EQ(filled({".##.", "#..#", "#..#", ".##."}, {0, 0, 4, 4}),
            (Lines{".##.", "####", "####", ".##."}));
}

TEST(LineSegmentation, AnOpenSideStaysOpen) {
  // No edge below the arc's inside: columns 1 and 2 end with their only edge pixel.
  EXPECT_EQ(filled({"####", "#..#", "#..#"}, {0, 0, 4, 3}), (Lines{"####", "#..#", "#..#"}));
}

TEST(LineSegmentation, LooksOnlyInsideItsBox) {
  EXPECT_EQ(filled({"#.#.#", "#.#.#"}, {2, 0, 3, 2}), (Lines{"..#.#", "..#.#"}));
  EXPECT_EQ(filled({"#"}, {0, 0, 1, 1}), (Lines{"#"}));
}

Lines gapsFilled(uint8_t inside, uint32_t mostPx) {
  Lines lines(24, std::string(24, '.'));
  for (size_t y = 4; y < 24; ++y)
    for (size_t x = 4; x < 20; ++x)
      if (y < 8 || x < 8 || x >= 16) lines[y][x] = '#';
  BitMask mask = drawBits(lines);
  // The body is 40 bright, the wall 200; what lies between the arms is asked for.
  Image<uint8_t> picture(mask.size());
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x)
      picture.at(x, y) = mask.at(x, y) ? 40 : x >= 8 && x < 16 && y >= 8 ? inside : 200;
  GapScratch scratch;
  fillUnedged(picture, 14, mostPx, Executor(1), scratch, mask);
  return textOf(mask);
}

TEST(MaskGaps, ABorderWithoutAnEdgeIsNoBorder) {
  EXPECT_EQ(gapsFilled(42, 200)[20], "....################....");
}

TEST(MaskGaps, ARealEdgeKeepsTheGap) {
  EXPECT_EQ(gapsFilled(200, 200)[20], "....####........####....");
}

TEST(MaskGaps, AThinPieceOfTheBorderDoesNotKeepTheGap) {
  // Its lower end is one column wide: behind that the wall is read.
  BitMask mask({40, 24});
  mask.clear();
  Image<uint8_t> picture(mask.size());
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool isBody = x >= 6 && x < 27 && y >= 2;
      if (isBody && (y < 8 || x < 14 || x >= (y < 18 ? 22 : 26))) mask.set(x, y);
      picture.at(x, y) = isBody ? 40 : 200;
    }
  GapScratch scratch;
  EXPECT_TRUE(fillUnedged(picture, 14, 300, Executor(1), scratch, mask));
  EXPECT_EQ(textOf(mask)[20], std::string(6, '.') + std::string(21, '#') + std::string(13, '.'));
  EXPECT_FALSE(fillUnedged(picture, 14, 300, Executor(1), scratch, mask));
}

TEST(MaskGaps, LargeGapsStay) {
  EXPECT_EQ(gapsFilled(42, 20)[20], "....####........####....");
}

}  // namespace
}  // namespace rg
