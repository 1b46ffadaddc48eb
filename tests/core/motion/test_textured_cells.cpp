// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/motion/fit_sums.hpp"
#include "core/motion/textured_cells.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <array>
#include <bit>

namespace rg {
namespace {

using namespace scenes;

/// Two strips of whole parts over the picture, but for the last two rows of the second strip.
std::vector<motion::MatchedPart> partsOver(Size size) {
  std::vector<motion::MatchedPart> parts;
  for (int strip = 0; strip < 2; ++strip)
    for (int column = 0; column < size.width / motion::kPartWidth; ++column)
      parts.push_back({strip == 0 ? ~uint64_t{0} : ~uint64_t{0} >> 4, static_cast<uint16_t>(column),
                       static_cast<uint16_t>(strip), segmentation::RegionLabel::ofIndex(0)});
  return parts;
}

uint32_t pixelsOf(std::span<const motion::MatchedPart> parts) {
  uint32_t pixels = 0;
  for (const motion::MatchedPart& part : parts) pixels += part.pixels();
  return pixels;
}

std::vector<motion::MatchedPart> kept(const Picture& picture,
                                      std::vector<motion::MatchedPart> parts) {
  motion::TextureScratch scratch;
  const motion::GradientProducts left = motion::keepTextured(picture.luma(), parts, scratch);
  EXPECT_EQ(left, motion::sumGradientsPlainly(parts, picture.luma()));
  return parts;
}

constexpr Size kFrame{160, 64};

TEST(TexturedCells, FlatOnesAreLeftOutFirst) {
  const auto picture = paintGrey(kFrame, [](int x, int y) {
    const auto bits = mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), 3);
    return x < 80 ? 100 + static_cast<int>(bits % 3) : static_cast<int>(bits % 200);
  });
  const auto parts = kept(*picture, partsOver(kFrame));
  EXPECT_GE(pixelsOf(parts), motion::kEnoughPx);
  EXPECT_LT(pixelsOf(parts), motion::kEnoughPx + motion::kCellSize * motion::kCellSize);
  for (const motion::MatchedPart& part : parts) EXPECT_TRUE(part.blocks == 0 || part.x() >= 80);
}

TEST(TexturedCells, OfLikeOnesThoseKeptLieAllOverTheRegion) {
  const auto parts = kept(*greyNoise(kFrame, 7), partsOver(kFrame));
  std::array<uint32_t, 4> quarters{};
  for (const motion::MatchedPart& part : parts)
    quarters[2 * part.strip + (part.x() >= kFrame.width / 2)] += part.pixels();
  for (const uint32_t pixels : quarters) EXPECT_NEAR(pixels, motion::kEnoughPx / 4, 2 * 64);
}

TEST(TexturedCells, AllThatAreEnoughStay) {
  std::vector<motion::MatchedPart> parts = partsOver(kFrame);
  parts.resize(motion::kEnoughPx / parts.front().pixels());
  const auto after = kept(*greyNoise(kFrame, 7), parts);
  EXPECT_EQ(pixelsOf(after), pixelsOf(parts));
}

/// Cell by cell from what the header says: of which class it is and whether it is kept whole.
TEST(TexturedCells, NoneIsLeftOutWhereOneOfAClassBelowIsKept) {
  const auto picture = paintGrey(kFrame, [](int x, int y) {
    const auto bits = mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), 3);
    return 100 + static_cast<int>(bits % (2u + static_cast<uint32_t>(x)));
  });
  const std::vector<motion::MatchedPart> all = partsOver(kFrame);
  std::vector<motion::MatchedPart> first;
  test::forEachTarget([&] {
    const auto parts = kept(*picture, all);
    int leastKept = 64, mostLeftOut = -1;
    for (size_t i = 0; i < all.size(); ++i)
      for (int cell = 0; cell < 4; ++cell) {
        motion::MatchedPart one = all[i];
        one.blocks &= uint64_t{0xFFFF} << 16 * cell;
        const uint64_t left = parts[i].blocks & one.blocks;
        ASSERT_TRUE(left == 0 || left == one.blocks);
        const motion::GradientProducts sums =
            motion::sumGradientsPlainly({&one, 1}, picture->luma());
        const auto mean = static_cast<uint64_t>(sums.xx + sums.yy) / one.pixels();
        const auto texture = static_cast<int>(std::bit_width(mean)) / 2;
        if (left == 0)
          mostLeftOut = std::max(mostLeftOut, texture);
        else
          leastKept = std::min(leastKept, texture);
      }
    EXPECT_LE(mostLeftOut, leastKept);
    EXPECT_GE(mostLeftOut, 0);
    if (first.empty()) first = parts;
    for (size_t i = 0; i < parts.size(); ++i) EXPECT_EQ(parts[i].blocks, first[i].blocks);
  });
}

}  // namespace
}  // namespace rg
