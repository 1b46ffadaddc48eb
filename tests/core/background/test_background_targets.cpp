// SPDX-License-Identifier: LGPL-2.1-or-later
// The whole of stage 1 on every SIMD target of this machine, with one to four threads, of every
// pixel format, by every method: the same mask and the same areas, frame by frame.
#include "core/background/background.hpp"
#include "core/base/pixel.hpp"
#include "tests/core/simd_targets.hpp"

#include <array>
#include <vector>

namespace rg {
namespace {

constexpr int64_t kFrameNs = 40'000'000;
constexpr int kFrames = 24;

constexpr std::array kFormats{PixelFormat::Bgrx, PixelFormat::Rgbx, PixelFormat::Bgra,
                              PixelFormat::Rgba, PixelFormat::Bgr,  PixelFormat::Rgb,
                              PixelFormat::Nv12, PixelFormat::I420, PixelFormat::Gray8};

/// A frame of noise on a coarse pattern, crossed by a bright block; the light falls halfway. Each
/// plane has rows longer than needed.
struct Shot {
  Shot(PixelFormat format, Size size, int frame) {
    std::vector<PlaneMemory> views;
    for (int i = 0; i < planeCount(format); ++i) {
      const Size bytes = planeBytes(format, size, i);
      const int stride = bytes.width + 13;
      planes.emplace_back(static_cast<size_t>(stride) * static_cast<size_t>(bytes.height));
      for (int y = 0; y < bytes.height; ++y)
        for (int x = 0; x < stride; ++x)
          planes.back()[static_cast<size_t>(y * stride + x)] = valueAt(bytes, {x, y}, frame);
      views.push_back({planes.back().data(), planes.back().size(), stride});
    }
    picture->load(*Frame::make({format, size}, views), Executor(1));
  }

  static uint8_t valueAt(Size bytes, Point p, int frame) {
    const int noise =
        static_cast<int>(mixHash(static_cast<uint32_t>(p.x), static_cast<uint32_t>(p.y),
                                 static_cast<uint32_t>(frame)) %
                         9);
    const int left = bytes.width * frame / kFrames;
    const bool isInside = p.x >= left && p.x < left + bytes.width / 5 && p.y > bytes.height / 4 &&
                          p.y < bytes.height * 3 / 4;
    const int level = isInside ? 220 : 70 + 25 * (p.x / 24 % 3) + 10 * (p.y / 9 % 2);
    return static_cast<uint8_t>((frame < kFrames / 2 ? level : level * 3 / 4) + noise);
  }

  std::vector<std::vector<uint8_t>> planes;
  std::shared_ptr<Picture> picture = std::make_shared<Picture>();
};

struct Seen {
  std::vector<uint8_t> mask;
  std::vector<Box> areas;
  friend bool operator==(const Seen&, const Seen&) = default;
};

std::vector<Seen> watch(std::shared_ptr<const Executor> executor, background::Method method,
                        PixelFormat format, Size size) {
  const auto stage = background::makeStage({std::move(executor), nullptr});
  background::Params params;
  params.method = method;
  params.trainingFrames = 8;
  std::vector<Seen> all;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Shot shot(format, size, frame);
    const auto result = stage->process(shot.picture, params, {frame * kFrameNs, true});
    EXPECT_TRUE(result);
    Seen seen{{}, (*result)->areas};
    for (int y = 0; y < size.height; ++y) {
      const uint8_t* row = (*result)->mask.row(y);
      seen.mask.insert(seen.mask.end(), row, row + size.width);
    }
    all.push_back(std::move(seen));
  }
  return all;
}

struct Case {
  background::Method method;
  PixelFormat format;
  Size size;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  constexpr std::array kSizes{Size{97, 70}, Size{64, 65}, Size{1, 1}, Size{1, 80}, Size{257, 3}};
  for (const auto method : {background::Method::Hybrid, background::Method::Paper,
                            background::Method::FrameDifference}) {
    for (const PixelFormat format : kFormats) all.push_back({method, format, kSizes[0]});
    for (const Size size : kSizes) all.push_back({method, PixelFormat::Bgrx, size});
  }
  return all;
}

TEST(BackgroundTargets, EveryTargetAndThreadCountSeesTheSame) {
  std::vector<std::vector<Seen>> expected;
  for (const Case& one : cases())
    expected.push_back(
        watch(std::make_shared<const Executor>(1), one.method, one.format, one.size));
  // The scene is worth comparing: in its usual size every method sees something and not all.
  for (size_t i = 0; i < expected.size(); ++i) {
    if (cases()[i].size != Size{97, 70}) continue;
    size_t foreground = 0;
    for (const Seen& seen : expected[i])
      foreground += static_cast<size_t>(
          std::count(seen.mask.begin(), seen.mask.end(), background::kForegroundPixel));
    EXPECT_GT(foreground, 97u * 70u / 2) << "case " << i;
    EXPECT_LT(foreground, 97u * 70u * kFrames / 2) << "case " << i;
  }
  test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
    size_t i = 0;
    for (const Case& one : cases()) {
      ASSERT_EQ(watch(executor, one.method, one.format, one.size), expected[i]) << "case " << i;
      ++i;
    }
  });
}

}  // namespace
}  // namespace rg
