// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/own_motion.hpp"
#include "core/pixel.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <gmock/gmock.h>

#include <algorithm>

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
  findOwnMotion(motion, previous.luma(), {camera, kMotionUnit}, Executor(1), scratch, moves);
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

/// The same pixel by pixel, over whole frames.
class Plainly {
 public:
  Plainly(const Motion& motion, const Picture& previous, RegionMotion camera)
      : motion_(motion),
        labels_(*motion.graph->labels),
        now_(labels_.picture->luma()),
        camera_(camera),
        before_(previous.luma()) {}

  std::vector<uint8_t> run() {
    const size_t count = motion_.regions.size();
    moves_.assign(count, 0);
    for (size_t i = 0; i < count; ++i) {
      const int64_t dx = motion_.regions[i].dx - camera_.dx,
                    dy = motion_.regions[i].dy - camera_.dy;
      const auto whole = [](int64_t d) { return static_cast<int>(divideRounded(d, kMotionUnit)); };
      shifts_.push_back(dx * dx + dy * dy > kMotionUnit * kMotionUnit ? Point{whole(dx), whole(dy)}
                                                                      : Point{});
    }
    for (int round = 0; round < 2; ++round) {
      const auto before = moves_;
      for (size_t i = 0; i < count; ++i) moves_[i] = gains(i, shifts_[i], before) > 0 ? 1 : 0;
    }
    for (int round = 0; round < 2; ++round) tryNeighbours();
    return moves_;
  }

 private:
  [[nodiscard]] int expected(int x, int y) const {
    const auto at = [&](int px, int py) {
      return int{before_.at(std::clamp(px, 0, before_.width() - 1),
                            std::clamp(py, 0, before_.height() - 1))};
    };
    const int fx = x * kMotionUnit - camera_.dx, fy = y * kMotionUnit - camera_.dy;
    const int px = fx >> 4, py = fy >> 4, u = fx & 15, v = fy & 15;
    const int top = at(px, py) * (16 - u) + at(px + 1, py) * u;
    const int low = at(px, py + 1) * (16 - u) + at(px + 1, py + 1) * u;
    return (top * (16 - v) + low * v + 128) >> 8;
  }

  [[nodiscard]] bool isShown(int x, int y) const {
    const auto isInside = [](int at, int shift, int length) {
      return at * kMotionUnit >= shift && at * kMotionUnit < length * kMotionUnit + (shift & ~15);
    };
    return boundsOf(labels_.size).contains({x, y}) && isInside(x, camera_.dx, labels_.size.width) &&
           isInside(y, camera_.dy, labels_.size.height);
  }

  [[nodiscard]] bool isHidden(int x, int y, size_t region, Point shift,
                              const std::vector<uint8_t>& moves) const {
    size_t by = moves.size();
    for (size_t i = 0; i < moves.size(); ++i) {
      const Point to{x + shifts_[i].x, y + shifts_[i].y};
      if (moves[i] != 0 && boundsOf(labels_.size).contains(to) &&
          labels_.ids.at(to.x, to.y) == i + 1)
        by = i;
    }
    if (by == moves.size() || by == region) return false;
    return moves[region] == 0 || absDiff(shifts_[by].x, shift.x) > 1 ||
           absDiff(shifts_[by].y, shift.y) > 1;
  }

  /// 1 where the shift is clearly better, −1 where it is clearly worse.
  [[nodiscard]] int gains(size_t region, Point shift, const std::vector<uint8_t>& moves) const {
    if (shift == Point{}) return 0;
    uint64_t still = 0, moved = 0, pixels = 0;
    for (int y = 0; y < labels_.size.height; ++y)
      for (int x = 0; x < labels_.size.width; ++x) {
        const Point from{x - shift.x, y - shift.y};
        if (labels_.ids.at(x, y) != region + 1 || !isShown(x, y) || !isShown(from.x, from.y) ||
            isHidden(x, y, region, shift, moves))
          continue;
        still += static_cast<uint64_t>(absDiff(now_.at(x, y), expected(x, y)));
        moved += static_cast<uint64_t>(absDiff(now_.at(x, y), expected(from.x, from.y)));
        ++pixels;
      }
    const auto isLess = [&](uint64_t a, uint64_t b) {
      return a + pixels / 4 < b && (b - a) * (b - a) * pixels > 18 * a * a;
    };
    return isLess(moved, still) ? 1 : isLess(still, moved) ? -1 : 0;
  }

  void tryNeighbours() {
    const Graph& graph = *motion_.graph;
    auto moves = moves_;
    auto shifts = shifts_;
    for (size_t i = 0; i < moves.size(); ++i) {
      uint32_t border = 0, moving = 0, longest = 0;
      uint64_t area = 0;
      size_t neighbour = 0;
      for (const Arc& arc : graph.arcs) {
        if (arc.a != i + 1 && arc.b != i + 1) continue;
        const size_t other = static_cast<size_t>(arc.a == i + 1 ? arc.b : arc.a) - 1;
        border += arc.borderPx;
        if (moves_[other] == 0) continue;
        moving += arc.borderPx;
        area += graph.regions[other].areaPx;
        if (arc.borderPx > longest) neighbour = other;
        longest = std::max(longest, arc.borderPx);
      }
      if (moves_[i] != 0 || longest == 0 || shifts_[neighbour] == Point{}) continue;
      const int gain = gains(i, shifts_[neighbour], moves_);
      const bool isSurrounded = 2 * moving > border && graph.regions[i].areaPx <= area;
      if (gain < 0 || (gain == 0 && !isSurrounded)) continue;
      moves[i] = 1;
      shifts[i] = shifts_[neighbour];
    }
    moves_ = moves;
    shifts_ = shifts;
  }

  const Motion& motion_;
  const Labels& labels_;
  ImageView<const uint8_t> now_;
  RegionMotion camera_;
  ImageView<const uint8_t> before_;
  std::vector<uint8_t> moves_;
  std::vector<Point> shifts_;
};

/// Ragged tiles, some of which move otherwise than the camera, with vectors right and wrong.
TEST(OwnMotion, IsThatOfEachPixelOnEveryTargetAndNumberOfThreads) {
  constexpr Size kFrame{150, 67};
  constexpr int kAcross = 15, kTiles = kAcross * 7;
  int movers = 0;
  for (const RegionMotion& camera : {RegionMotion{0, 0, 0, 256}, RegionMotion{37, -21, 0, 256}}) {
    const auto hash = [](int a, int b) {
      return mixHash(static_cast<uint32_t>(a), static_cast<uint32_t>(b), 7);
    };
    const auto tileAt = [&](int x, int y) {
      const int tx = std::min((x + static_cast<int>(hash(y, 0) % 3)) / 10, kAcross - 1);
      return y / 10 * kAcross + tx;
    };
    const auto stepOf = [&](int tile) {
      return tile % 3 == 0 ? Point{static_cast<int>(hash(tile, 1) % 9) - 4, tile % 4 - 2} : Point{};
    };
    const auto previous = scenes::paintGrey(
        kFrame, [](int x, int y) { return texture(x, y, 5) / 2 + texture(x / 2, y / 2, 6) / 2; });
    const auto current = scenes::paintGrey(kFrame, [&](int x, int y) {
      const Point step = stepOf(tileAt(x, y));
      const int px = x - step.x - camera.dx / 16, py = y - step.y - camera.dy / 16;
      return texture(px, py, 5) / 2 + texture(px / 2, py / 2, 6) / 2;
    });
    Motion motion;
    motion.size = kFrame;
    motion.status = Status::Ok;
    motion.graph = *makeGraphStage(scenes::contextWith(1))
                        ->process(scenes::label(current, kTiles,
                                                [&](int x, int y) { return tileAt(x, y) + 1; }),
                                  {});
    for (int tile = 0; tile < kTiles; ++tile) {
      const Point step = tile % 7 == 1 ? Point{-30 + tile, 4} : stepOf(tile);
      motion.regions.push_back({camera.dx + step.x * 16 + tile % 5, camera.dy + step.y * 16, 0, 9});
    }
    const auto expected = Plainly(motion, *previous, camera).run();
    movers += static_cast<int>(std::count(expected.begin(), expected.end(), 1));
    test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
      OwnMotionScratch scratch;
      std::vector<uint8_t> moves;
      for (int frame = 0; frame < 2; ++frame)
        findOwnMotion(motion, previous->luma(), {camera, kMotionUnit}, *executor, scratch, moves);
      EXPECT_EQ(moves, expected);
    });
  }
  EXPECT_GT(movers, 20);
}

}  // namespace
}  // namespace rg
