// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/camera_warp.hpp"
#include "kernels/picture_blocks.hpp"
#include "tests/kernels/parity.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace rg::test {
namespace {

constexpr int64_t kOne = CameraMotion::kOne;

/// Whole and broken shifts up to far outside, and whatever else a matrix does.
std::vector<CameraMotion> camerasFor(Size size) {
  std::vector<CameraMotion> cameras{CameraMotion()};
  for (const Point shift : std::initializer_list<Point>{{16, 0},
                                                        {0, -32},
                                                        {-48, 80},
                                                        {5, -7},
                                                        {-37, 23},
                                                        {1, 1},
                                                        {16 * size.width, 0},
                                                        {-16 * size.width + 16, 3},
                                                        {0, 16 * size.height - 1},
                                                        {1 << 20, -(1 << 20)}})
    cameras.emplace_back(shift);
  const Point middle{size.width / 2, size.height / 2};
  const auto add = [&](const CameraMotion::Matrix& matrix, Point origin) {
    cameras.emplace_back(matrix, origin);
    EXPECT_TRUE(cameras.back().isSafe());
  };
  const int64_t px = kOne, tenth = kOne / 10;
  add({kOne, 0, px / 33, 0, kOne, -px / 7, 0, 0, kOne}, middle);  // No sixteenths.
  add({kOne - tenth, 0, 0, 0, kOne - tenth, 0, 0, 0, kOne}, middle);
  add({kOne + tenth, 0, px / 3, 0, kOne + tenth, -px, 0, 0, kOne}, middle);
  add({kOne, tenth, px, -tenth, kOne, px / 5, 0, 0, kOne}, middle);
  add({kOne, tenth / 3, 0, tenth / 7, kOne, 0, kOne / 1000, -kOne / 1500, kOne}, middle);
  add({kOne, 0, 0, 0, kOne, 0, -kOne / 64, 0, kOne}, {});  // Beyond where it may be.
  add({-kOne, 0, 0, 0, -kOne, 0, 0, 0, kOne}, middle);
  add({kOne, kOne / 2, px * 9, 0, kOne, 0, 0, 0, kOne}, {});
  add({kOne + tenth, 0, px * 5000, 0, kOne, 0, 0, 0, kOne}, middle);
  return cameras;
}

/// What was before, and what is `by` pixels farther, with some noise.
struct MovedPictures {
  Image<uint8_t> before, now;
  MovedPictures(Size size, int fill, Point by) : before(size), now(size) {
    constexpr int kFar = 1000;  // No negative places.
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        before.at(x, y) = static_cast<uint8_t>(levelAt(fill, x + kFar, y + kFar));
        const int level = levelAt(fill, x - by.x + kFar, y - by.y + kFar);
        now.at(x, y) = static_cast<uint8_t>(x * y % 7 == 3 ? 255 - level : level);
      }
  }
};

/// Without a block, just one, and up to several with pixels left over; as wide as a row in memory.
constexpr std::array kBlockSizes{Size{1, 1},   Size{7, 16},  Size{8, 8},   Size{9, 23},
                                 Size{31, 17}, Size{64, 24}, Size{65, 16}, Size{131, 67}};

template <class Check>
void forMovedPictures(const Check& check) {
  for (const Size size : kBlockSizes)
    for (int fill = 0; fill < kFills && !::testing::Test::HasFailure(); ++fill) {
      SCOPED_TRACE(std::to_string(size.width) + "x" + std::to_string(size.height) + ", fill " +
                   std::to_string(fill));
      check(MovedPictures(size, fill, {3, -2}));
    }
}

/// Shifts near nothing, at the picture's ends and far beyond them.
std::vector<Point> someShifts(Size size, uint32_t what) {
  std::vector<Point> shifts;
  const int count = BlockGrid::of(size).count();
  for (int i = 0; i < count; ++i) {
    const auto draw = [&](uint32_t axis, int most) {
      return static_cast<int>(hashOf(i, size.width, 10 * what + axis) %
                              static_cast<uint32_t>(2 * most + 1)) -
             most;
    };
    const int kind = i % 5;
    shifts.push_back(kind == 0   ? Point{}
                     : kind == 1 ? Point{draw(1, size.width), draw(2, size.height)}
                     : kind == 2 ? Point{draw(1, 400), draw(2, 3)}
                                 : Point{draw(1, 6), draw(2, 6)});
  }
  return shifts;
}

bool isSameMatch(const BlockMatch& a, const BlockMatch& b) {
  return a.sad == b.sad && a.shift == b.shift;
}

bool isSameRange(const ShownRange& a, const ShownRange& b) {
  return a.first == b.first && a.last == b.last;
}

}  // namespace

void parity_shrink() {
  forSizesAndFills([](Size size, int fill) {
    const Image<uint8_t> from = filled(size, fill);
    for (const int side : {1, 2, 3, 4, 7}) {
      Image<uint8_t> expected;
      rg::shrink(from, side, oneThread(), expected);
      Plane<uint8_t> to(expected.size());
      gpu::shrink(Plane<uint8_t>(from.view()), side, to, nullptr);
      to.expect(expected, "shrunk");
    }
  });
}

/// Twice with shifts of different reach, of which the second finds what is better, worse and as
/// good; some blocks have a match from before that nothing is better than.
void parity_matchBlocks() {
  int replaced = 0, kept = 0, missing = 0;
  forMovedPictures([&](const MovedPictures& moved) {
    const Size size = moved.now.size();
    const auto count = static_cast<size_t>(BlockGrid::of(size).count());
    std::vector<BlockMatch> expected(count);
    for (size_t i = 3; i < count; i += 7) expected[i] = {static_cast<uint32_t>(i % 2), {900, 900}};
    Guarded<BlockMatch> found(expected, {0, {77, 77}});
    Plane<uint8_t> now(moved.now.view()), before(moved.before.view());
    for (const auto& [reach, what] : {std::pair{4, 1u}, {8, 2u}, {0, 3u}, {1, 2u}}) {
      const std::vector<Point> shifts = someShifts(size, what);
      const std::vector<BlockMatch> earlier = expected;
      rg::matchBlocks(moved.now, moved.before, shifts, reach, oneThread(), expected);
      gpu::matchBlocks(now, before, shifts.data(), reach, found.data(), nullptr);
      found.expect(expected, isSameMatch);
      for (size_t i = 0; i < count; ++i) {
        const bool isNone = expected[i].sad == BlockMatch::kNone;
        const bool isKept = isSameMatch(expected[i], earlier[i]);
        ++(isNone ? missing : isKept ? kept : replaced);
      }
    }
  });
  EXPECT_GT(std::min({replaced, kept, missing}), 0);
}

void parity_sumBlocks() {
  uint64_t pixels = 0;
  forMovedPictures([&](const MovedPictures& moved) {
    const Size size = moved.now.size();
    const auto count = static_cast<size_t>(BlockGrid::of(size).count());
    Plane<uint8_t> now(moved.now.view()), before(moved.before.view());
    for (const CameraMotion& camera : camerasFor(size)) {
      std::vector<BlockSums> expected(count);
      const BlockSums other{1, 2, 3, 4, 5, 6, 7};
      Guarded<BlockSums> sums(std::vector(count, other), other);
      rg::sumBlocks(moved.now, moved.before, camera, oneThread(), expected);
      gpu::sumBlocks(now, before, camera, sums.data(), nullptr);
      sums.expect(expected, [](const auto& a, const auto& b) { return a == b; });
      for (const BlockSums& of : expected) pixels += of.pixels;
    }
  });
  EXPECT_GT(pixels, 0u);
}

void parity_warpByCamera() {
  forSizesAndFills([](Size size, int fill) {
    const Image<uint8_t> previous = filled(size, fill);
    Plane<uint8_t> from(previous.view());
    int number = 0;
    for (const CameraMotion& camera : camerasFor(size)) {
      SCOPED_TRACE("camera " + std::to_string(number++));
      const auto rows = static_cast<size_t>(size.height);
      Image<uint8_t> expected(size);
      std::vector<ShownRange> shown(rows);
      rg::warpByCamera(previous, camera, oneThread(), expected, shown);
      Plane<uint8_t> to(size);
      Guarded<ShownRange> found(std::vector(rows, ShownRange{-5, -6}), {-7, -8});
      gpu::warpByCamera(from, camera, to, found.data(), nullptr);
      to.expect(expected, "expected");
      found.expect(shown, isSameRange);
    }
  });
}

}  // namespace rg::test
