// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames at a lower resolution against means that are taken pixel by pixel.
#include "core/base/reduced_frame.hpp"
#include "tests/core/row_fills.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace rg {
namespace {

constexpr PixelFormat kFormats[] = {
    PixelFormat::Bgrx, PixelFormat::Rgbx, PixelFormat::Bgra,    PixelFormat::Rgba,
    PixelFormat::Bgr,  PixelFormat::Rgb,  PixelFormat::Gbr,     PixelFormat::Nv12,
    PixelFormat::Nv21, PixelFormat::I420, PixelFormat::Y42b,    PixelFormat::Yuy2,
    PixelFormat::Uyvy, PixelFormat::P010, PixelFormat::I420Ten, PixelFormat::Gray8};
constexpr int kPadding = 5;

/// A frame with padded rows, in memory that ends with the last one.
struct StoredFrame {
  std::vector<std::vector<uint8_t>> planes;
  Frame frame;

  static StoredFrame make(PixelFormat format, Size size, const test::Fill& fill,
                          bool isInterlaced = false) {
    std::vector<std::vector<uint8_t>> planes;
    std::vector<PlaneMemory> memory;
    for (int i = 0; i < planeCount(format); ++i) {
      const Size bytes = planeBytes(format, size, i);
      const int stride = bytes.width + kPadding;
      std::vector<uint8_t> plane(static_cast<size_t>(stride * bytes.height - kPadding));
      for (size_t at = 0; at < plane.size(); ++at)
        plane[at] = fill(static_cast<int>(at) % stride, static_cast<int>(at) / stride + 100 * i);
      planes.push_back(std::move(plane));
      memory.push_back({planes.back().data(), planes.back().size(), stride});
    }
    const FrameLayout layout{format, size, YuvMatrix::Bt601, YuvRange::Limited, isInterlaced};
    return {std::move(planes), *Frame::make(layout, memory)};
  }
};

/// Where samples of a kind lie in the frame and in the reduced one.
struct Kind {
  int plane, step, offset;
  int toPlane, toStep, toOffset;
  int chromaRows = 0;  ///< Of luma that each serves, which it does two columns of; 0: is no chroma.
  bool isOfTen = false;
};

/// The mean of the samples that a reduced sample covers.
int meanOf(ImageView<const uint8_t> plane, const Kind& kind, const Box& covered) {
  int sum = 0;
  for (int y = covered.y; y < covered.bottom(); ++y)
    for (int x = covered.x; x < covered.right(); ++x) {
      const int at = x * kind.step + kind.offset;
      sum += kind.isOfTen ? (plane.at(at, y) / 4 | plane.at(at + 1, y) % 4 << 6) : plane.at(at, y);
    }
  const auto count = static_cast<int>(covered.area());
  return (sum + count / 2) / count;
}

std::vector<Kind> kindsOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::Gray8:
      return {{0, 1, 0, 0, 1, 0}};
    case PixelFormat::I420:
      return {{0, 1, 0, 0, 1, 0}, {1, 1, 0, 1, 1, 0, 2}, {2, 1, 0, 2, 1, 0, 2}};
    case PixelFormat::I420Ten:
      return {
          {0, 2, 0, 0, 1, 0, 0, true}, {1, 2, 0, 1, 1, 0, 2, true}, {2, 2, 0, 2, 1, 0, 2, true}};
    case PixelFormat::Nv12:
      return {{0, 1, 0, 0, 1, 0}, {1, 2, 0, 1, 1, 0, 2}, {1, 2, 1, 2, 1, 0, 2}};
    case PixelFormat::Nv21:
      return {{0, 1, 0, 0, 1, 0}, {1, 2, 1, 1, 1, 0, 2}, {1, 2, 0, 2, 1, 0, 2}};
    case PixelFormat::P010:
      return {{0, 2, 1, 0, 1, 0}, {1, 4, 1, 1, 1, 0, 2}, {1, 4, 3, 2, 1, 0, 2}};
    case PixelFormat::Y42b:
      return {{0, 1, 0, 0, 1, 0}, {1, 1, 0, 1, 1, 0, 1}, {2, 1, 0, 2, 1, 0, 1}};
    case PixelFormat::Yuy2:
      return {{0, 2, 0, 0, 1, 0}, {0, 4, 1, 1, 1, 0, 1}, {0, 4, 3, 2, 1, 0, 1}};
    case PixelFormat::Uyvy:
      return {{0, 2, 1, 0, 1, 0}, {0, 4, 0, 1, 1, 0, 1}, {0, 4, 2, 2, 1, 0, 1}};
    case PixelFormat::Gbr:
      return {{0, 1, 0, 0, 3, 1}, {1, 1, 0, 0, 3, 2}, {2, 1, 0, 0, 3, 0}};
    case PixelFormat::Rgb:
      return {{0, 3, 0, 0, 3, 0}, {0, 3, 1, 0, 3, 1}, {0, 3, 2, 0, 3, 2}};
    case PixelFormat::Bgr:
      return {{0, 3, 2, 0, 3, 0}, {0, 3, 1, 0, 3, 1}, {0, 3, 0, 0, 3, 2}};
    case PixelFormat::Bgrx:
    case PixelFormat::Bgra:
      return {{0, 4, 2, 0, 3, 0}, {0, 4, 1, 0, 3, 1}, {0, 4, 0, 0, 3, 2}};
    default:
      return {{0, 4, 0, 0, 3, 0}, {0, 4, 1, 0, 3, 1}, {0, 4, 2, 0, 3, 2}};
  }
}

void expectMeans(const Frame& frame, const Frame& reduced) {
  for (const Kind& kind : kindsOf(frame.layout().format)) {
    const auto chroma = [&](Size size, int rows) {
      return rows > 0 ? Size{(size.width + 1) / 2, (size.height + rows - 1) / rows} : size;
    };
    const Size from = chroma(frame.size(), kind.chromaRows);
    const Size to = chroma(reduced.size(), kind.chromaRows > 0 ? 2 : 0);
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x) {
        const int left = x * from.width / to.width, top = y * from.height / to.height;
        const Box covered{left, top, (x + 1) * from.width / to.width - left,
                          (y + 1) * from.height / to.height - top};
        ASSERT_EQ(int{reduced.plane(kind.toPlane).at(x * kind.toStep + kind.toOffset, y)},
                  meanOf(frame.plane(kind.plane), kind, covered))
            << x << ' ' << y << " of kind " << kind.plane << ' ' << kind.offset;
      }
  }
}

TEST(ReducedFrame, HoldsTheRoundedMeansOfEveryFormat) {
  ReducedFrame reduced;  // Of all sizes and formats in turn.
  for (const PixelFormat format : kFormats)
    for (const Size size : {Size{61, 47}, {64, 48}, {1, 33}, {33, 2}, {7, 300}})
      for (const int rows : {1, 5, 12, 24, 46}) {
        const Size to = reducedSize(size, rows);
        if (to == size) continue;
        for (const test::Fill& fill : test::fills()) {
          SCOPED_TRACE(static_cast<int>(format));
          const auto stored = StoredFrame::make(format, size, fill);
          reduced.load(stored.frame, to, Executor(1));
          ASSERT_EQ(reduced.view().size(), to);
          expectMeans(stored.frame, reduced.view());
          if (HasFatalFailure()) return;
        }
      }
}

TEST(ReducedFrame, IsTheSameForEveryTargetAndNumberOfThreads) {
  const auto stored = StoredFrame::make(PixelFormat::Nv12, {2051, 131}, test::fills().back());
  test::forEachTarget([&] {
    for (const int threads : {1, 2}) {
      ReducedFrame reduced;
      reduced.load(stored.frame, reducedSize(stored.frame.size(), 17), Executor(threads));
      expectMeans(stored.frame, reduced.view());
    }
  });
}

/// The sums of the brightest frame of the largest ratio fit, and where chroma has all rows too.
TEST(ReducedFrame, TakesTheLargestRatio) {
  const Size size{300, 16384};
  const Size to = reducedSize(size, 1);
  EXPECT_EQ(to, (Size{2, 128}));
  for (const PixelFormat format : {PixelFormat::I420, PixelFormat::Y42b, PixelFormat::I420Ten}) {
    const auto stored = StoredFrame::make(format, size, [](int, int) { return 255; });
    ReducedFrame reduced;
    reduced.load(stored.frame, to, Executor(1));
    for (int y = 0; y < to.height; ++y) ASSERT_EQ(reduced.view().plane(0).at(1, y), 255);
    for (int y = 0; y < to.height / 2; ++y) ASSERT_EQ(reduced.view().plane(1).at(0, y), 255);
  }
}

TEST(ReducedFrame, OfAnInterlacedFrameHoldsTheMeansOfOneField) {
  for (const PixelFormat format : kFormats) {
    SCOPED_TRACE(static_cast<int>(format));
    const auto stored = StoredFrame::make(format, {61, 47}, test::fills().back(), true);
    ReducedFrame reduced;
    for (const int rows : {5, 12, 24}) {  // The field has 24.
      reduced.load(stored.frame, reducedSize({61, 47}, rows), Executor(1));
      expectMeans(stored.frame.ofOneTime(), reduced.view());
    }
    reduced.load(stored.frame, reducedSize({61, 47}, 40), Executor(1));
    EXPECT_EQ(reduced.view().size(), (Size{52, 40}));
  }
}

TEST(ReducedFrame, KeepsShapeMatrixAndRange) {
  EXPECT_EQ(reducedSize({3840, 2160}, 540), (Size{960, 540}));
  EXPECT_EQ(reducedSize({1366, 768}, 540), (Size{960, 540}));
  EXPECT_EQ(reducedSize({640, 480}, 540), (Size{640, 480}));
  EXPECT_EQ(reducedSize({640, 480}, 0), (Size{640, 480}));
  EXPECT_EQ(reducedSize({1, 100}, 10), (Size{1, 10}));
  const std::vector<uint8_t> bytes(6);
  const std::array memory{PlaneMemory{bytes.data(), 4, 2}, PlaneMemory{bytes.data(), 2, 2}};
  const FrameLayout layout{PixelFormat::Nv12, {2, 2}, YuvMatrix::Bt709, YuvRange::Full};
  ReducedFrame reduced;
  reduced.load(*Frame::make(layout, memory), {1, 1}, Executor(1));
  EXPECT_EQ(reduced.view().layout(),
            (FrameLayout{PixelFormat::I420, {1, 1}, YuvMatrix::Bt709, YuvRange::Full}));
}

}  // namespace
}  // namespace rg
