// SPDX-License-Identifier: LGPL-2.1-or-later
// The sums that motion is fitted with against plain ones: every target of this machine, cells at
// all of the frame's edges, fills that provoke overflows.
#include "core/motion/fit_moments.hpp"
#include "tests/core/fills.hpp"
#include "tests/core/simd_targets.hpp"

#include <vector>

namespace rg {
namespace {

using test::filled, test::hashOf, test::kFills;

constexpr int kReach = 9;

std::vector<motion::MatchedPart> partsOf(Size size) {
  std::vector<motion::MatchedPart> parts;
  for (int y = 0; y < size.height; y += motion::kPartHeight)
    for (int x = 0; x + motion::kBlockWidth <= size.width; x += motion::kPartWidth) {
      uint64_t blocks = hashOf(x, y, 4) % 2 == 0
                            ? ~uint64_t{0}
                            : uint64_t{hashOf(x, y, 5)} << 32 | hashOf(x, y, 6);
      if (const int rows = size.height - y; rows < motion::kPartHeight)
        blocks &= (uint64_t{1} << (2 * rows)) - 1;
      if (x + motion::kPartWidth > size.width) blocks &= 0x5555555555555555;
      if (blocks != 0)
        parts.push_back({blocks, static_cast<uint16_t>(x / motion::kPartWidth),
                         static_cast<uint16_t>(y / motion::kPartHeight),
                         segmentation::RegionLabel::ofIndex(0)});
    }
  return parts;
}

constexpr Size kSizes[] = {{4, 1}, {4, 3}, {9, 9}, {21, 65}, {47, 33}, {128, 8}, {64, 40}};

TEST(SimdFit, MomentsArePlainOnes) {
  const motion::FitField fields[] = {
      {{0, 0}, {}, {10, 10}},
      {{3 * motion::kFine, -8 * motion::kFine}, {}, {10, 10}},
      {{77, -301}, {}, {30, 5}},
      {{-motion::kFine + 1, 128}, {40, -13, 9, 250}, {20, 20}},
      {{kReach * motion::kFine - 1, 1 - kReach * motion::kFine}, {-5, 0, 0, 3}, {0, 30}}};
  for (const Size size : kSizes)
    for (int fill = 0; fill < kFills; ++fill)
      for (int before = 0; before < kFills; before += 2) {
        const Image<uint8_t> current = filled(size, fill);
        motion::PaddedLuma previous;
        previous.build(filled(size, (fill + before) % kFills), kReach, Executor(1));
        const motion::FitPlane plane{current, &previous};
        const auto parts = partsOf(size);
        for (const motion::FitField& field : fields)
          for (const int limit : {0, 700, motion::kMostLimit}) {
            const motion::FitMoments expected =
                motion::sumMomentsPlainly(parts, plane, field, limit);
            test::forEachTarget([&] {
              EXPECT_EQ(motion::sumMoments(parts, plane, field, limit), expected)
                  << size.width << 'x' << size.height << " fill " << fill << ' ' << before
                  << " limit " << limit << " at " << field.at.x << ", " << field.at.y;
            });
          }
      }
}

TEST(SimdFit, CellsArePlainOnes) {
  const Size size{31, 26};
  const Image<uint8_t> current = filled(size, 4);
  motion::PaddedLuma previous;
  previous.build(filled(size, 5), kReach, Executor(1));
  for (int y = 0; y < size.height; y += motion::kCellSize)
    for (int x = 0; x + motion::kBlockWidth <= size.width; x += motion::kCellSize)
      for (const Point d : {Point{}, {motion::kFine, 0}, {100, -700}, {-2303, 2303}}) {
        const int rows = std::min(size.height - y, motion::kCellSize);
        auto blocks = static_cast<uint16_t>((1u << (2 * rows)) - 1);
        if (x + motion::kCellSize > size.width) blocks &= 0x5555;
        const motion::MatchedCell cell{x, y, blocks};
        const motion::FitSums expected = motion::sumFitPlainly(cell, current, previous, d, 3000);
        test::forEachTarget([&] {
          EXPECT_EQ(motion::sumFit(cell, current, previous, d, 3000), expected) << x << ", " << y;
        });
      }
}

TEST(SimdFit, GradientsArePlainOnes) {
  for (const Size size : kSizes)
    for (int fill = 0; fill < kFills; ++fill) {
      const Image<uint8_t> luma = filled(size, fill);
      const auto parts = partsOf(size);
      const motion::GradientProducts expected = motion::sumGradientsPlainly(parts, luma);
      test::forEachTarget(
          [&] { EXPECT_EQ(motion::sumGradients(parts, luma), expected) << size.width; });
    }
}

}  // namespace
}  // namespace rg
