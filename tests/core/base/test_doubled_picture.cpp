// SPDX-License-Identifier: LGPL-2.1-or-later
// Pictures of twice the size against the same filter taken pixel by pixel.
#include "core/base/memory/result_plane.hpp"
#include "core/base/picture.hpp"
#include "core/base/reduced_frame.hpp"
#include "tests/core/row_fills.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace rg {
namespace {

/// Of a line through a pixel and its neighbours, so far from its middle.
double cubicAt(double distance) {
  const double d = std::abs(distance);
  if (d <= 1) return 1.5 * d * d * d - 2.5 * d * d + 1;
  if (d < 2) return -.5 * d * d * d + 2.5 * d * d - 4 * d + 2;
  return 0;
}

int doubledAt(const Image<uint8_t>& plane, int x, int y) {
  const auto at = [&](int column, int row) {
    return plane.at(std::clamp(column, 0, plane.width() - 1),
                    std::clamp(row, 0, plane.height() - 1));
  };
  const double fromX = (x + .5) / 2 - .5, fromY = (y + .5) / 2 - .5;
  double sum = 0;
  for (int row = y / 2 - 3; row <= y / 2 + 3; ++row)
    for (int column = x / 2 - 3; column <= x / 2 + 3; ++column)
      sum += cubicAt(column - fromX) * cubicAt(row - fromY) * at(column, row);
  return static_cast<int>(std::clamp(std::floor(sum + .5), 0., 255.));
}

Picture greyPicture(Size size, const test::Fill& fill) {
  Picture picture;
  Image<uint8_t>& plane = picture.writeGrey(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) plane.row(y)[x] = fill(x, y);
  return picture;
}

TEST(DoubledPicture, HoldsWhatLiesAQuarterOffEachCentre) {
  Picture large;  // Of all sizes in turn.
  for (const Size size : {Size{1, 1}, {2, 3}, {3, 1}, {61, 47}, {2051, 5}, {257, 33}})
    for (const test::Fill& fill : test::fills()) {
      SCOPED_TRACE(std::to_string(size.width) + "x" + std::to_string(size.height));
      const Picture small = greyPicture(size, fill);
      Image<uint8_t> plane;
      plane.copyFrom(small.luma());
      test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
        large.loadDoubled(small, *executor);
        ASSERT_EQ(large.size(), doubled(size));
        ASSERT_TRUE(large.isGrey());
      });
      for (int y = 0; y < 2 * size.height; ++y)
        for (int x = 0; x < 2 * size.width; ++x)
          ASSERT_EQ(int{large.luma().at(x, y)}, doubledAt(plane, x, y)) << x << ' ' << y;
    }
}

TEST(DoubledPicture, IsTheSameForEveryTargetAndNumberOfThreads) {
  const Picture small = greyPicture({331, 77}, test::fills().back());
  Picture first;
  first.loadDoubled(small, Executor(1));
  test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
    Picture large;
    large.loadDoubled(small, *executor);
    for (int y = 0; y < large.size().height; ++y)
      ASSERT_TRUE(std::equal(large.luma().row(y), large.luma().row(y) + large.size().width,
                             first.luma().row(y)))
          << y;
  });
}

/// Each plane is its own, and the luma of a picture is not that of its doubled colours.
TEST(DoubledPicture, DoublesEachPlane) {
  constexpr Size kSize{13, 9};
  std::vector<uint8_t> bytes(size_t{3} * kSize.width * kSize.height);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<uint8_t>(i * 37 % 251);
  const FrameLayout layout{PixelFormat::Rgb, kSize, YuvMatrix::Bt601, YuvRange::Full};
  const std::array memory{PlaneMemory{bytes.data(), bytes.size(), 3 * kSize.width}};
  Picture small, large;
  small.load(*Frame::make(layout, memory), Executor(1));
  large.loadDoubled(small, Executor(1));
  ASSERT_FALSE(large.isGrey());
  using Plane = ImageView<const uint8_t> (Picture::*)() const;
  for (const Plane plane : {&Picture::red, &Picture::green, &Picture::blue, &Picture::luma}) {
    Image<uint8_t> from;
    from.copyFrom((small.*plane)());
    for (int y = 0; y < 2 * kSize.height; ++y)
      for (int x = 0; x < 2 * kSize.width; ++x)
        ASSERT_EQ(int{(large.*plane)().at(x, y)}, doubledAt(from, x, y));
  }
}

TEST(DoubledPicture, IsLookedAtInsteadOfSmallFramesOnly) {
  EXPECT_EQ(usualSize({320, 240}), (Size{640, 480}));
  EXPECT_EQ(usualSize({128, 96}), (Size{256, 192}));
  EXPECT_EQ(usualSize({352, 299}), (Size{704, 598}));
  EXPECT_EQ(usualSize({480, 120}), (Size{960, 240}));
  for (const Size size : {Size{127, 95}, {400, 300}, {640, 480}, {481, 120}, {64, 48}})
    EXPECT_EQ(usualSize(size), size);
}

/// Three of four decide; of two and two it is the smaller, background for a mask.
TEST(DoubledPicture, IsShownAsMostOfItsPixelsAre) {
  const std::array<uint16_t, 10> upper{7, 7, 0, 9, 5, 0, 3, 8, 0, 0};
  const std::array<uint16_t, 10> lower{7, 0, 9, 0, 5, 5, 8, 8, 0, 4};
  std::array<uint16_t, 5> shown;
  halveRows(upper.data(), lower.data(), 5, shown.data());
  EXPECT_EQ(shown, (std::array<uint16_t, 5>{7, 0, 5, 8, 0}));
}

TEST(DoubledPicture, ResultsAreTheSamePackedAsRunsAndWhole) {
  for (const uint32_t mask : {1u, 255u}) {  // Few runs, and more than the plane takes.
    ResultPlane<uint16_t> plane, packed;
    constexpr Size kShown{41, 23};
    plane.resize(doubled(kShown));
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x)
        plane.row(y)[x] = static_cast<uint16_t>(
            mask == 1 ? x / 7 % 2
                      : mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), 1) & mask);
    PlanePacker packer;
    packer.pack(plane, packed, kShown);
    ASSERT_EQ(packed.pixelSize(), kShown);
    Image<uint16_t> room;
    const ImageView<const uint16_t> shown = packed.unpacked(room);
    std::array<uint16_t, kShown.width> expected;
    for (int y = 0; y < kShown.height; ++y) {
      halveRows(plane.row(2 * y), plane.row(2 * y + 1), kShown.width, expected.data());
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), shown.row(y))) << y;
    }
  }
}

}  // namespace
}  // namespace rg
