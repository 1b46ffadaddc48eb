// SPDX-License-Identifier: LGPL-2.1-or-later
// What the stages 2 to 5 keep: at most kBytesPerPixel · width · height + kFixedBytes, and
// kBytesPerRegion for each region that they may make, whatever the picture, results in use
// included.
#include "core/base/pixel.hpp"
#include "core/objects/objects.hpp"
#include "tests/core/scenes.hpp"

#include <algorithm>
#include <malloc.h>

namespace rg {
namespace {

using namespace scenes;

constexpr size_t kBytesPerPixel = 200;
constexpr size_t kBytesPerRegion = 1750;
constexpr size_t kFixedBytes = size_t{8} << 20;
constexpr int kMostRegions = 65535;

size_t bytesInUse() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// Frames with as many runs, parts, borders and arcs as there can be.
using LevelAt = int (*)(int x, int y, int time);
constexpr LevelAt kWorst[] = {
    [](int x, int y, int time) { return (x + y + time) % 2 * 200; },
    [](int x, int y, int time) {
      return static_cast<int>(
          mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(time)) %
          256);
    },
    [](int x, int y, int time) { return y > 2 && (x + time) % 2 == 0 ? 30 : 220; },
    [](int x, int y, int time) { return x % 2 == 0 && (y + time) % 2 == 0 ? 220 : 30; }};

TEST(StageMemory, StaysWithinTheBoundOnTheWorstFrames) {
  if (bytesInUse() == 0) GTEST_SKIP() << "this allocator does not tell what is in use";
  for (const LevelAt levelAt : kWorst)
    for (const Size size : {Size{160, 120}, Size{640, 360}}) {
      std::vector<std::shared_ptr<const Picture>> pictures;
      for (int time = 0; time < 3; ++time)
        pictures.push_back(paint(size, [&](int x, int y) {
          const auto level = static_cast<uint8_t>(levelAt(x, y, time));
          return Rgb{level, static_cast<uint8_t>(255 - level), level};
        }));
      const size_t before = bytesInUse();
      const Context context = contextWith(2);
      const auto segmentation = segmentation::makeStage(context);
      const auto graphs = graph::makeStage(context);
      const auto motions = motion::makeStage(context);
      const auto objects = objects::makeStage(context);
      std::shared_ptr<const objects::Objects> last;
      for (const auto& picture : pictures) {
        const auto labels = *segmentation->process(
            picture, nullptr, {segmentation::Scope::Frame, 2, 1, kMostRegions});
        last = *objects->process(*motions->process(*graphs->process(labels, {}), {}, {}), {}, {});
      }
      const size_t grown = bytesInUse() - before;
      const auto pixels = static_cast<size_t>(size.area());
      const size_t regions = std::min<size_t>(pixels, kMostRegions);
      EXPECT_LE(grown, kBytesPerPixel * pixels + kBytesPerRegion * regions + kFixedBytes)
          << size.width << 'x' << size.height << ": "
          << static_cast<double>(grown) / static_cast<double>(pixels) << " bytes per pixel";
    }
}

}  // namespace
}  // namespace rg
