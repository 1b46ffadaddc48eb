// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/kernels/parity.hpp"

#include <optional>

namespace rg::test {
namespace {

/// A frame whose planes have odd strides, and begin anywhere.
struct HostFrame {
  std::array<std::vector<uint8_t>, Frame::kMaxPlanes> bytes;
  std::optional<Frame> frame;

  HostFrame(const FrameLayout& layout, int fill) {
    std::array<PlaneMemory, Frame::kMaxPlanes> planes;
    const int count = planeCount(layout.format);
    for (int i = 0; i < count; ++i) {
      const Size need = planeBytes(layout.format, layout.size, i);
      const size_t stride = static_cast<size_t>(need.width) + 7;
      std::vector<uint8_t>& plane = bytes[static_cast<size_t>(i)];
      plane.assign(1 + stride * static_cast<size_t>(need.height), 0xA5);
      for (int y = 0; y < need.height; ++y)
        for (int x = 0; x < need.width; ++x)
          plane[1 + stride * static_cast<size_t>(y) + static_cast<size_t>(x)] =
              static_cast<uint8_t>(levelAt(fill, x + 3 * i, y));
      planes[static_cast<size_t>(i)] = {plane.data() + 1, plane.size() - 1,
                                        static_cast<int64_t>(stride)};
    }
    frame = *Frame::make(layout, std::span(planes).first(static_cast<size_t>(count)));
  }
};

void checkLoading(const FrameLayout& layout, int fill) {
  const HostFrame host(layout, fill);
  Picture expected;
  expected.load(*host.frame, oneThread());
  Plane<uint8_t> red(layout.size), green(layout.size), blue(layout.size), luma(layout.size);
  gpu::loadPlanes(*host.frame, {red, green, blue, luma}, nullptr);
  luma.expect(expected.luma(), "luma");
  if (expected.isGrey()) return;
  red.expect(expected.red(), "red");
  green.expect(expected.green(), "green");
  blue.expect(expected.blue(), "blue");
}

}  // namespace

void parity_loadPlanes() {
  forSizesAndFills([](Size size, int fill) {
    for (const PixelFormat format :
         {PixelFormat::Bgrx, PixelFormat::Rgba, PixelFormat::Bgr, PixelFormat::Rgb,
          PixelFormat::Gbr, PixelFormat::Nv12, PixelFormat::Nv21, PixelFormat::I420,
          PixelFormat::Y42b, PixelFormat::Yuy2, PixelFormat::Uyvy, PixelFormat::I420Ten,
          PixelFormat::P010, PixelFormat::Gray8})
      for (const bool isInterlaced : {false, true})
        checkLoading({format, size, YuvMatrix::Bt601, YuvRange::Limited, isInterlaced}, fill);
    for (const YuvMatrix matrix : {YuvMatrix::Bt709, YuvMatrix::Bt2020, YuvMatrix::Fcc})
      checkLoading({PixelFormat::Nv12, size, matrix, YuvRange::Full}, fill);
  });
}

void parity_countLevels() {
  forSizesAndFills([](Size size, int fill) {
    const Image<uint8_t> image = filled(size, fill);
    Plane<uint8_t> there(image.view());
    Histogram levels;
    levels.fill(0xA5A5A5A5);
    gpu::countLevels(there, levels.data(), nullptr);
    ASSERT_EQ(levels, countLevels(image, oneThread()));
  });
}

namespace {

/// Histograms of pictures, and ones that are hard on corners: flat, one level, two peaks alike, a
/// long tail, empty.
template <class Check>
void forHistograms(const Check& check) {
  for (int kind = 0; kind < 40 && !::testing::Test::HasFailure(); ++kind) {
    SCOPED_TRACE("histogram " + std::to_string(kind));
    Histogram levels{};
    for (size_t i = 0; i < levels.size(); ++i) {
      const auto at = static_cast<int>(i);
      switch (kind % 5) {
        case 0:
          levels[i] = 7;
          break;
        case 1:
          levels[i] = at == 6 * kind ? 1u << 28 : 0;
          break;
        case 2:
          levels[i] = at == 3 * kind || at == 3 * kind + 40 ? 1000 : 1;
          break;
        case 3:
          levels[i] = 100000u / static_cast<uint32_t>(1 + at * kind) + hashOf(at, kind, 1) % 9;
          break;
        default:
          levels[i] = kind == 4 ? 0 : hashOf(at, kind, 2) % 1000;
      }
    }
    check(levels);
  }
}

}  // namespace

void parity_quantile() {
  forHistograms([](const Histogram& levels) {
    for (const int share : {0, 1, 26, 128, 230, 256}) {
      int level = -1;
      gpu::quantile(levels.data(), share, &level, nullptr);
      ASSERT_EQ(level, quantile(levels, share)) << share;
    }
  });
}

void parity_differenceThreshold() {
  forHistograms([](const Histogram& levels) {
    for (const int least : {0, 12, 300}) {
      int threshold = -1;
      gpu::differenceThreshold(levels.data(), least, &threshold, nullptr);
      ASSERT_EQ(threshold, differenceThreshold(levels, least)) << least;
    }
  });
}

void parity_contrastThreshold() {
  forHistograms([](const Histogram& levels) {
    int threshold = -1;
    gpu::contrastThreshold(levels.data(), 3, &threshold, nullptr);
    ASSERT_EQ(threshold, contrastThreshold(levels, 3));
  });
}

}  // namespace rg::test
