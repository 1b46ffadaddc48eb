// SPDX-License-Identifier: LGPL-2.1-or-later
// The pruned search against the exhaustive one, on every target of this machine.
#include "core/base/pixel.hpp"
#include "core/motion/shift_search.hpp"
#include "tests/core/fills.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <cmath>

namespace rg {
namespace {

using namespace scenes;

uint32_t hashOf(int x, int y, uint32_t what) {
  return mixHash(static_cast<uint32_t>(x + 1000), static_cast<uint32_t>(y + 1000), what);
}

using LevelAt = std::function<int(int, int)>;

Image<uint8_t> painted(Size size, const LevelAt& levelAt) {
  Image<uint8_t> image(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) image.at(x, y) = static_cast<uint8_t>(levelAt(x, y));
  return image;
}

/// Blocks that are inside of the picture.
void addPart(Size size, int column, int strip, uint64_t blocks,
             std::vector<motion::MatchedPart>& parts) {
  if (const int rows = size.height - strip * motion::kPartHeight; rows < motion::kPartHeight)
    blocks &= (uint64_t{1} << (2 * rows)) - 1;
  if ((column + 1) * motion::kPartWidth > size.width) blocks &= 0x5555555555555555;
  if (blocks != 0)
    parts.push_back({blocks, static_cast<uint16_t>(column), static_cast<uint16_t>(strip),
                     segmentation::RegionLabel::ofIndex(0)});
}

/// In all corners of the picture and with all kinds of gaps.
std::vector<motion::MatchedPart> raggedParts(Size size) {
  std::vector<motion::MatchedPart> parts;
  for (int strip = 0; strip * motion::kPartHeight < size.height; ++strip)
    for (int column = 0; column * motion::kPartWidth + motion::kBlockWidth <= size.width;
         ++column) {
      const uint32_t hash = hashOf(column, strip, 4);
      addPart(size, column, strip,
              hash % 3 == 0   ? ~uint64_t{0}
              : hash % 3 == 1 ? uint64_t{1} << hash % 64
                              : uint64_t{hash} << 32 | hashOf(column, strip, 5),
              parts);
    }
  return parts;
}

motion::SearchedPicture searched(const Image<uint8_t>& luma, int reach) {
  motion::SearchedPicture picture;
  picture.build(luma, reach, Executor(1));
  return picture;
}

void expectExhaustive(const Image<uint8_t>& before, const Image<uint8_t>& now,
                      const std::vector<motion::MatchedPart>& parts,
                      const motion::ShiftRange& range) {
  const motion::SearchedPicture previous = searched(before, range.reach + 1);
  const motion::FoundShift right = motion::searchShiftsPlainly(parts, now, previous, range);
  test::forEachTarget([&] {
    motion::SearchScratch scratch;
    for (int turn = 0; turn < 2; ++turn) {
      const motion::FoundShift found = motion::searchShifts(parts, now, previous, range, scratch);
      EXPECT_EQ(found.d.x, right.d.x);
      EXPECT_EQ(found.d.y, right.d.y);
      EXPECT_EQ(found.sums, right.sums);
      EXPECT_EQ(found.rival, right.rival);
      EXPECT_EQ(found.mean, right.mean);
      EXPECT_EQ(found.isBeaten, right.isBeaten);
      EXPECT_TRUE(found.isWithin);
    }
  });
}

/// With a limit at the best sum all is found as without; with a lower one nothing is.
void expectLimited(const Image<uint8_t>& before, const Image<uint8_t>& now,
                   const std::vector<motion::MatchedPart>& parts, motion::ShiftRange range) {
  const motion::SearchedPicture previous = searched(before, range.reach + 1);
  const motion::FoundShift right = motion::searchShiftsPlainly(parts, now, previous, range);
  const auto least = static_cast<uint32_t>(right.sum());
  test::forEachTarget([&] {
    motion::SearchScratch scratch;
    range.mostSum = least;
    const motion::FoundShift found = motion::searchShifts(parts, now, previous, range, scratch);
    EXPECT_TRUE(found.isWithin);
    EXPECT_EQ(found.d, right.d);
    EXPECT_EQ(found.sums, right.sums);
    EXPECT_EQ(found.rival, right.rival);
    EXPECT_EQ(found.mean, right.mean);
    EXPECT_EQ(found.isBeaten, right.isBeaten);
    if (least == 0) return;
    range.mostSum = least - 1;
    EXPECT_FALSE(motion::searchShifts(parts, now, previous, range, scratch).isWithin);
    EXPECT_FALSE(motion::searchShiftsPlainly(parts, now, previous, range).isWithin);
  });
}

TEST(ShiftSearch, FindsWhatTheExhaustiveOneFindsInAnyPicture) {
  struct Case {
    Size size;
    motion::ShiftRange range;
  };
  for (const Case& c : {Case{{4, 1}, {3, 4}}, Case{{21, 65}, {19, 20}}, Case{{47, 33}, {7, 8}},
                        Case{{257, 5}, {16, 17}}, Case{{12, 9}, {64, 65}}, Case{{13, 9}, {0, 1}}})
    for (int kind = 0; kind < test::kFills; ++kind) {
      SCOPED_TRACE(std::to_string(c.size.width) + " wide, fill " + std::to_string(kind));
      expectExhaustive(test::filled(c.size, (kind + 1) % test::kFills), test::filled(c.size, kind),
                       raggedParts(c.size), c.range);
      expectLimited(test::filled(c.size, (kind + 1) % test::kFills), test::filled(c.size, kind),
                    raggedParts(c.size), c.range);
    }
}

/// Like a photograph: details on hills, few of them far from the mean.
double scene(double x, double y) {
  const auto lot = [](int column, int row) {
    return static_cast<double>(hashOf(column, row, 2) % 64);
  };
  const int column = static_cast<int>(std::floor(x / 3)), row = static_cast<int>(std::floor(y / 3));
  const double u = x / 3 - column, v = y / 3 - row;
  const double detail = (lot(column, row) * (1 - u) + lot(column + 1, row) * u) * (1 - v) +
                        (lot(column, row + 1) * (1 - u) + lot(column + 1, row + 1) * u) * v;
  return 90 + 40 * std::sin(x * 0.05) * std::cos(y * 0.07) + 12 * std::sin(x * 0.4 - y * 0.3) +
         detail;
}

/// With the noise of a camera.
Image<uint8_t> photographed(Size size, double dx, double dy, uint32_t seed) {
  return painted(size, [=](int x, int y) {
    const uint32_t bits = hashOf(x, y, seed);
    const int noise =
        static_cast<int>((bits & 7) + (bits >> 3 & 7) - (bits >> 6 & 7) - (bits >> 9 & 7));
    return static_cast<int>(std::lround(scene(x - dx, y - dy))) + noise;
  });
}

TEST(ShiftSearch, FindsWhatTheExhaustiveOneFindsInFastNoisyScenes) {
  const Size size{96, 88};
  std::vector<motion::MatchedPart> parts;
  for (int column = 4; column < 8; ++column)
    for (int strip = 0; strip < 2; ++strip)
      addPart(size, column, strip, uint64_t{0xFFFFFFFF} << 16, parts);
  const Image<uint8_t> before = photographed(size, 0, 0, 1);
  for (const double d : {0.0, 5.0, -21.5, 40.0})
    expectExhaustive(before, photographed(size, d, -d / 2, 2), parts, {40, 41});
  expectExhaustive(before, photographed(size, -64, 63, 2), parts, {64, 65});
}

// What is left of a scene that has gone further than the search goes.
TEST(ShiftSearch, TellsThatAShiftBeyondTheSearchIsBetter) {
  const Size size{64, 64};
  std::vector<motion::MatchedPart> parts;
  addPart(size, 3, 0, ~uint64_t{0} << 20, parts);
  const Image<uint8_t> before = photographed(size, 0, 0, 1);
  for (const int dx : {11, 12}) {
    motion::SearchScratch scratch;
    const auto found = motion::searchShifts(parts, photographed(size, dx, 0, 1),
                                            searched(before, 12), {11, 12}, scratch);
    EXPECT_EQ(found.isBeaten, dx == 12);
  }
}

// Of 64 boxes, all of them black before and white now: more than 16 bits hold.
TEST(ShiftSearch, TheMeanIsOfSumsHoweverLarge) {
  const Size size{64, 64};
  std::vector<motion::MatchedPart> parts;
  for (int column = 0; column < 4; ++column) addPart(size, column, 0, ~uint64_t{0}, parts);
  Image<uint8_t> black(size), white(size);
  black.fill(0);
  white.fill(255);
  test::forEachTarget([&] {
    motion::SearchScratch scratch;
    const auto found = motion::searchShifts(parts, white, searched(black, 8), {7, 8}, scratch);
    EXPECT_EQ(found.mean, 64 * 16 * 255);
  });
  expectExhaustive(black, white, parts, {7, 8});
}

TEST(ShiftSearch, BoxesLieInRunsOfBlocks) {
  motion::MatchedPart part{0, 2, 1, segmentation::RegionLabel::ofIndex(0)};
  for (const int row : {1, 2, 3, 4, 5, 6, 7, 8, 9, 20, 21, 22, 28, 29, 30, 31})
    part.blocks |= uint64_t{1} << (2 * row);
  part.blocks |= uint64_t{0xAA};
  std::vector<std::pair<int, int>> boxes;
  motion::forBoxes(part, [&](int x, int y) { boxes.emplace_back(x, y); });
  EXPECT_EQ(boxes, (std::vector<std::pair<int, int>>{{16, 33}, {16, 37}, {16, 60}, {20, 32}}));
}

}  // namespace
}  // namespace rg
