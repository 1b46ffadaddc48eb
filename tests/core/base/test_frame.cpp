// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/frame.hpp"
#include "core/base/picture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace rg {
namespace {

Result<Frame> grey(Size size, uint64_t bytes, int64_t stride) {
  static const std::vector<uint8_t> memory(4096);
  const PlaneMemory plane{memory.data(), bytes, stride};
  return Frame::make({PixelFormat::Gray8, size}, std::array{plane});
}

TEST(Frame, AcceptsMemoryThatEndsWithTheLastRow) {
  EXPECT_TRUE(grey({10, 3}, 2 * 16 + 10, 16));
}

TEST(Frame, RefusesMemoryOneByteShort) {
  const auto frame = grey({10, 3}, 2 * 16 + 9, 16);
  ASSERT_FALSE(frame);
  EXPECT_NE(frame.error().message.find("plane 0 ends"), std::string::npos);
}

TEST(Frame, RefusesStridesBelowARowAndBelowZero) {
  EXPECT_FALSE(grey({10, 3}, 4096, 9));
  EXPECT_FALSE(grey({10, 3}, 4096, -16));
  EXPECT_FALSE(grey({10, 3}, 4096, INT64_MIN));
}

TEST(Frame, RefusesStridesThatOverflow) {
  EXPECT_FALSE(grey({10, 3}, 4096, INT64_MAX));
}

TEST(Frame, RefusesEmptySizesAndMissingPlanes) {
  EXPECT_FALSE(grey({0, 3}, 4096, 16));
  EXPECT_FALSE(grey({3, -1}, 4096, 16));
  EXPECT_FALSE(Frame::make({PixelFormat::Nv12, {2, 2}}, std::array<PlaneMemory, 1>{}));
}

TEST(Frame, OddSizesRoundChromaUp) {
  EXPECT_EQ(planeBytes(PixelFormat::Nv12, {5, 3}, 1), (Size{6, 2}));
  EXPECT_EQ(planeBytes(PixelFormat::I420, {1, 1}, 2), (Size{1, 1}));
}

Picture load(PixelFormat format, Size size, const std::vector<std::vector<uint8_t>>& planes,
             YuvMatrix matrix = YuvMatrix::Bt601, YuvRange range = YuvRange::Limited) {
  std::vector<PlaneMemory> memory;
  for (int i = 0; i < planeCount(format); ++i)
    memory.push_back({planes[static_cast<size_t>(i)].data(), planes[static_cast<size_t>(i)].size(),
                      planeBytes(format, size, i).width});
  const auto frame = Frame::make({format, size, matrix, range}, memory);
  EXPECT_TRUE(frame);
  Picture picture;
  picture.load(*frame, Executor(1));
  return picture;
}

void expectPixel(const Picture& picture, int x, int y, int red, int green, int blue) {
  EXPECT_EQ(picture.red().at(x, y), red);
  EXPECT_EQ(picture.green().at(x, y), green);
  EXPECT_EQ(picture.blue().at(x, y), blue);
}

TEST(Picture, PackedFormatsPutEachChannelInItsPlane) {
  expectPixel(load(PixelFormat::Bgrx, {1, 1}, {{3, 2, 1, 9}}), 0, 0, 1, 2, 3);
  expectPixel(load(PixelFormat::Rgba, {1, 1}, {{1, 2, 3, 9}}), 0, 0, 1, 2, 3);
  expectPixel(load(PixelFormat::Bgr, {1, 1}, {{3, 2, 1}}), 0, 0, 1, 2, 3);
  expectPixel(load(PixelFormat::Rgb, {1, 1}, {{1, 2, 3}}), 0, 0, 1, 2, 3);
}

TEST(Picture, LimitedRangeBlackAndWhiteReachTheEnds) {
  const auto picture = load(PixelFormat::I420, {2, 1}, {{16, 235}, {128}, {128}});
  expectPixel(picture, 0, 0, 0, 0, 0);
  expectPixel(picture, 1, 0, 255, 255, 255);
}

TEST(Picture, FollowsTheMatrixOfTheCaps) {
  // Pure red, as each standard writes it in limited range.
  expectPixel(load(PixelFormat::Nv12, {1, 1}, {{81}, {90, 240}}), 0, 0, 254, 0, 0);
  expectPixel(load(PixelFormat::Nv12, {1, 1}, {{63}, {102, 240}}, YuvMatrix::Bt709), 0, 0, 255, 1,
              0);
}

TEST(Picture, AGreyFrameHasOnePlane) {
  const auto picture = load(PixelFormat::Gray8, {3, 1}, {{7, 8, 9}});
  EXPECT_TRUE(picture.isGrey());
  expectPixel(picture, 2, 0, 9, 9, 9);
  EXPECT_EQ(picture.luma().data, picture.red().data);
}

TEST(Picture, ThreadsChangeNothing) {
  const Size size{67, 129};
  std::vector<uint8_t> pixels(static_cast<size_t>(size.area()) * 3);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<uint8_t>(i * 37 + i / 251);
  const PlaneMemory plane{pixels.data(), pixels.size(), size.width * 3};
  const auto frame = Frame::make({PixelFormat::Rgb, size}, std::array{plane});
  Picture one, two;
  one.load(*frame, Executor(1));
  two.load(*frame, Executor(2));
  for (int y = 0; y < size.height; ++y)
    EXPECT_EQ(std::memcmp(one.luma().row(y), two.luma().row(y), static_cast<size_t>(size.width)),
              0);
}

}  // namespace
}  // namespace rg
