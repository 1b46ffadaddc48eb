// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/own_motion.hpp"
#include "core/pixel.hpp"
#include "tests/core/scenes.hpp"

#include <gmock/gmock.h>

namespace rg {
namespace {

using testing::ElementsAre;

constexpr Size kSize{96, 64};
constexpr Point kCamera{3, 1};

/// Fixed rough texture.
int texture(int x, int y, uint32_t seed) {
  return 60 +
         static_cast<int>(mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), seed) % 90);
}

/// Two frames of a ground that moves by kCamera and a square that moves by `step`.
struct TwoFrames {
  explicit TwoFrames(Point step) : step_(step) {}

  [[nodiscard]] int levelAt(int x, int y, int time) const {
    const Point origin = squareAt(time);
    if (Box{origin.x, origin.y, 16, 16}.contains({x, y}))
      return texture(x - origin.x, y - origin.y, 9);
    return texture(x - time * kCamera.x + 50, y - time * kCamera.y + 50, 5);
  }
  [[nodiscard]] Point squareAt(int time) const {
    return {40 + time * step_.x, 24 + time * step_.y};
  }
  Point step_;
};

std::vector<uint8_t> moversOf(const Picture& previous, std::shared_ptr<const Labels> labels,
                              const std::vector<Point>& vectors) {
  Motion motion;
  motion.size = kSize;
  motion.status = Status::Ok;
  motion.graph = *makeGraphStage(scenes::contextWith(1))->process(std::move(labels), {});
  for (const Point& v : vectors)
    motion.regions.push_back({v.x * kMotionUnit, v.y * kMotionUnit, 0, 20});
  const RegionMotion camera{kCamera.x * kMotionUnit, kCamera.y * kMotionUnit, 0, 256};
  OwnMotionScratch scratch;
  std::vector<uint8_t> moves;
  findOwnMotion(motion, previous.luma(), camera, kMotionUnit, scratch, moves);
  return moves;
}

/// Of the ground on the left, the ground on the right, and the square.
std::vector<uint8_t> test(const TwoFrames& frames, const std::vector<Point>& vectors) {
  const auto at = [&](int time) {
    return scenes::paintGrey(kSize, [&](int x, int y) { return frames.levelAt(x, y, time); });
  };
  const Point square = frames.squareAt(1);
  const auto labels = scenes::label(at(1), 3, [&](int x, int y) {
    if (Box{square.x, square.y, 16, 16}.contains({x, y})) return 3;
    return x < square.x ? 1 : 2;
  });
  return moversOf(*at(0), labels, vectors);
}

TEST(OwnMotion, ThingsThatMoveWithTheGroundAreNoMovers) {
  EXPECT_THAT(test(TwoFrames(kCamera), {kCamera, kCamera, kCamera}), ElementsAre(0, 0, 0));
}

TEST(OwnMotion, AMoverIsToldFromTheGroundHoweverUnreliableItsVector) {
  EXPECT_THAT(test(TwoFrames({9, 1}), {kCamera, kCamera, {9, 1}}), ElementsAre(0, 0, 1));
}

TEST(OwnMotion, AWrongVectorAloneMakesNoMover) {
  EXPECT_THAT(test(TwoFrames(kCamera), {kCamera, {-8, 4}, {9, 1}}), ElementsAre(0, 0, 0));
}

TEST(OwnMotion, GroundThatAMoverHasLeftStaysGround) {
  // Seen with the mover's step, the ground beside it explains what was uncovered.
  EXPECT_THAT(test(TwoFrames({13, 1}), {Point{13, 1}, kCamera, {13, 1}}), ElementsAre(0, 0, 1));
}

TEST(OwnMotion, APlainPartGoesWithTheMoversAroundIt) {
  const TwoFrames frames({9, 1});
  const auto at = [&](int time) {
    return scenes::paintGrey(kSize, [&](int x, int y) {
      const Point o = frames.squareAt(time);
      return Box{o.x + 5, o.y + 5, 6, 6}.contains({x, y}) ? 100 : frames.levelAt(x, y, time);
    });
  };
  const Point o = frames.squareAt(1);
  const auto labels = scenes::label(at(1), 3, [&](int x, int y) {
    if (Box{o.x + 7, o.y + 7, 3, 3}.contains({x, y})) return 3;
    return Box{o.x, o.y, 16, 16}.contains({x, y}) ? 2 : 1;
  });
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, {9, 1}, {0, 0}}), ElementsAre(0, 1, 1));
}

}  // namespace
}  // namespace rg
