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
  EXPECT_EQ(planeBytes(PixelFormat::Yuy2, {5, 3}, 0), (Size{12, 3}));
  EXPECT_EQ(planeBytes(PixelFormat::Y42b, {5, 3}, 1), (Size{3, 3}));
  EXPECT_EQ(planeBytes(PixelFormat::P010, {5, 3}, 1), (Size{12, 2}));
  EXPECT_EQ(planeBytes(PixelFormat::I420Ten, {5, 3}, 2), (Size{6, 2}));
}

TEST(Frame, OfOneTimeIsEverySecondRowOfAnInterlacedOne) {
  const std::vector<uint8_t> bytes(64);
  const std::array memory{PlaneMemory{bytes.data(), 35, 7}, PlaneMemory{bytes.data() + 35, 12, 4},
                          PlaneMemory{bytes.data() + 47, 12, 4}};
  for (const bool isInterlaced : {false, true}) {
    const FrameLayout layout{
        PixelFormat::I420, {7, 5}, YuvMatrix::Bt601, YuvRange::Limited, isInterlaced};
    const auto frame = Frame::make(layout, memory);
    const Frame field = frame->ofOneTime();
    EXPECT_FALSE(field.layout().isInterlaced);
    EXPECT_EQ(field.size(), (Size{7, isInterlaced ? 3 : 5}));
    EXPECT_EQ(field.plane(0).row(2), bytes.data() + (isInterlaced ? 28 : 14));
    EXPECT_EQ(field.plane(1).size, (Size{4, isInterlaced ? 2 : 3}));
    EXPECT_EQ(field.plane(2).row(1), bytes.data() + 47 + (isInterlaced ? 8 : 4));
  }
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

TEST(Picture, PlanesOfColourAreGreenBlueRed) {
  const auto picture = load(PixelFormat::Gbr, {2, 1}, {{2, 5}, {3, 6}, {1, 4}});
  expectPixel(picture, 0, 0, 1, 2, 3);
  expectPixel(picture, 1, 0, 4, 5, 6);
  EXPECT_EQ(int{picture.luma().at(1, 0)}, (77 * 4 + 150 * 5 + 29 * 6 + 128) / 256);
}

/// Red and grey side by side, in every way that Y'CbCr may lie.
TEST(Picture, FindsTheSamplesOfEveryOrder) {
  const auto expectRedGrey = [](const Picture& picture) {
    expectPixel(picture, 0, 0, 254, 0, 0);
    expectPixel(picture, 2, 0, 130, 130, 130);
    EXPECT_EQ(int{picture.luma().at(0, 0)}, 81);
    EXPECT_EQ(int{picture.luma().at(2, 0)}, 128);
  };
  const Size size{3, 1};
  const std::vector<uint8_t> luma{81, 81, 128};
  expectRedGrey(load(PixelFormat::I420, size, {luma, {90, 128}, {240, 128}}));
  expectRedGrey(load(PixelFormat::Y42b, size, {luma, {90, 128}, {240, 128}}));
  expectRedGrey(load(PixelFormat::Nv12, size, {luma, {90, 240, 128, 128}}));
  expectRedGrey(load(PixelFormat::Nv21, size, {luma, {240, 90, 128, 128}}));
  expectRedGrey(load(PixelFormat::Yuy2, size, {{81, 90, 81, 240, 128, 128, 7, 128}}));
  expectRedGrey(load(PixelFormat::Uyvy, size, {{90, 81, 240, 81, 128, 128, 128, 7}}));
  expectRedGrey(load(PixelFormat::P010, size,
                     {{255, 81, 9, 81, 64, 128}, {192, 90, 0, 240, 255, 128, 1, 128}}));
  // 4 · value, and what is below: 81 · 4 + 3 = 327 = 256 + 71.
  expectRedGrey(
      load(PixelFormat::I420Ten, size, {{71, 1, 68, 1, 1, 2}, {104, 1, 3, 2}, {192, 3, 0, 2}}));
}

TEST(Picture, ChromaOfEachRowIsItsOwnWhereItHasAllRows) {
  const auto whole = load(PixelFormat::Y42b, {1, 2}, {{81, 81}, {128, 90}, {128, 240}});
  expectPixel(whole, 0, 1, 254, 0, 0);
  EXPECT_EQ(whole.red().at(0, 0), whole.blue().at(0, 0));
  const auto packed = load(PixelFormat::Yuy2, {1, 2}, {{81, 128, 0, 128, 81, 90, 0, 240}});
  expectPixel(packed, 0, 1, 254, 0, 0);
  EXPECT_EQ(packed.red().at(0, 0), packed.blue().at(0, 0));
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
