// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/objects/merge/own_motion.hpp"
#include "core/objects/operations.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

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

motion::Motion motionOf(std::shared_ptr<const segmentation::Labels> labels,
                        const std::vector<Point>& vectors) {
  motion::Motion motion;
  motion.size = labels->size;
  motion.status = Status::Ok;
  motion.camera =
      CameraMotion(Point{kCamera.x * motion::kMotionUnit, kCamera.y * motion::kMotionUnit});
  motion.graph = *graph::makeStage(scenes::contextWith(1))->process(std::move(labels), {});
  for (const Point& v : vectors)
    motion.regions.push_back({v.x * motion::kMotionUnit, v.y * motion::kMotionUnit, 0, 20});
  return motion;
}

std::vector<objects::ArcEnergy> energiesOf(const motion::Motion& motion) {
  std::vector<objects::ArcEnergy> energies;
  objects::weighArcs(motion, {}, {}, energies);
  return energies;
}

/// The frame before.
objects::ComparedFrame since(const Picture& previous, const motion::Motion& motion) {
  return {previous, motion.camera};
}

struct Found {
  std::vector<uint8_t> moves;
  int rounds = 0;
  std::vector<objects::OwnMotion> own;
};

Found searchFor(const Picture& previous, std::shared_ptr<const segmentation::Labels> labels,
                const std::vector<Point>& vectors, objects::OwnMotionRules rules = {}) {
  const motion::Motion motion = motionOf(std::move(labels), vectors);
  objects::OwnMotionScratch scratch;
  std::vector<objects::OwnMotion> own;
  objects::clearOwnMotion(motion.regions.size(), scratch, own);
  const std::vector<objects::ArcEnergy> arcs = energiesOf(motion);
  rules.arcs = arcs;
  const Executor executor(1);
  objects::Operations operations(executor);
  objects::findOwnMotion(motion, since(previous, motion), rules, operations, scratch, own);
  return {scratch.moves, scratch.rounds, own};
}

std::vector<uint8_t> moversOf(const Picture& previous,
                              std::shared_ptr<const segmentation::Labels> labels,
                              const std::vector<Point>& vectors,
                              const objects::OwnMotionRules& rules = {}) {
  return searchFor(previous, std::move(labels), vectors, rules).moves;
}

/// Of the ground on the left, the ground on the right, and the square.
Found search(const TwoFrames& frames, const std::vector<Point>& vectors) {
  const auto at = [&](int time) {
    return scenes::paintGrey(kSize, [&](int x, int y) { return frames.levelAt(x, y, time); });
  };
  const Point square = frames.squareAt(1);
  const auto labels = scenes::label(at(1), 3, [&](int x, int y) {
    if (Box{square.x, square.y, 16, 16}.contains({x, y})) return 3;
    return x < square.x ? 1 : 2;
  });
  return searchFor(*at(0), labels, vectors);
}

std::vector<uint8_t> test(const TwoFrames& frames, const std::vector<Point>& vectors) {
  return search(frames, vectors).moves;
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

TEST(OwnMotion, IsNotAskedAgainWhatCanNotChange) {
  EXPECT_EQ(search(TwoFrames(kCamera), {kCamera, kCamera, kCamera}).rounds, 0);
  EXPECT_EQ(search(TwoFrames(kCamera), {kCamera, {-8, 4}, {9, 1}}).rounds, 1);
  EXPECT_GT(search(TwoFrames({9, 1}), {kCamera, kCamera, {9, 1}}).rounds, 1);
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

TEST(OwnMotion, WhatIsExpectedToMoveIsTriedWithoutAVectorOfItsOwn) {
  const TwoFrames frames({9, 1});
  const auto at = [&](int time) {
    return scenes::paintGrey(kSize, [&](int x, int y) { return frames.levelAt(x, y, time); });
  };
  const Point o = frames.squareAt(1);
  const auto labels = scenes::label(at(1), 2, [&](int x, int y) {
    return Box{o.x, o.y, 16, 16}.contains({x, y}) ? 2 : 1;
  });
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, kCamera}), ElementsAre(0, 0));
  const objects::TrackIndex expected[] = {{}, objects::TrackIndex::ofIndex(0)};
  const objects::ExpectedMotion tracks[] = {{{9, 1}}};
  objects::OwnMotionRules rules;
  rules.expected = expected;
  rules.tracks = tracks;
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, kCamera}, rules), ElementsAre(0, 1));
}

/// The square goes along with the ground, three times as far, and so does enough else.
TEST(OwnMotion, WhatParallaxExplainsIsNotTriedButOfWhatWasFollowed) {
  const TwoFrames frames({3 * kCamera.x, 3 * kCamera.y});
  const auto at = [&](int time) {
    return scenes::paintGrey(kSize, [&](int x, int y) { return frames.levelAt(x, y, time); });
  };
  const Point o = frames.squareAt(1);
  const auto labels = scenes::label(at(1), 2, [&](int x, int y) {
    return Box{o.x, o.y, 16, 16}.contains({x, y}) ? 2 : 1;
  });
  const Point step{3 * kCamera.x, 3 * kCamera.y};
  const auto trees = scenes::label(at(1), 4, [](int x, int) { return 1 + x / 24; });
  objects::Parallax parallax;
  parallax.look(motionOf(trees, {step, kCamera, step, kCamera}), {}, 40'000'000, {});
  const objects::TrackIndex expected[] = {{}, objects::TrackIndex::ofIndex(0)};
  const objects::ExpectedMotion known[] = {{step, true}}, fresh[] = {{step, false}};
  objects::OwnMotionRules rules;
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, step}, rules), ElementsAre(0, 1));
  rules.parallax = &parallax;
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, step}, rules), ElementsAre(0, 0));
  rules.expected = expected;
  rules.tracks = fresh;
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, step}, rules), ElementsAre(0, 0));
  rules.tracks = known;
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, step}, rules), ElementsAre(0, 1));
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, kCamera}, rules), ElementsAre(0, 1));
}

TEST(OwnMotion, GroundDoesNotGoWithAnEndOfItThatMoves) {
  // A plain ground that was cut together with the head of what moves over it.
  const TwoFrames frames({9, 1});
  const auto at = [&](int time) {
    return scenes::paintGrey(kSize, [&](int x, int y) {
      const Point o = frames.squareAt(time);
      return Box{o.x, o.y, 16, 16}.contains({x, y}) ? frames.levelAt(x, y, time)
                                                    : 100 + frames.levelAt(x, y, time) / 32;
    });
  };
  const Point o = frames.squareAt(1);
  const auto labels = scenes::label(at(1), 3, [&](int x, int y) {
    if (Box{o.x, o.y + 4, 16, 12}.contains({x, y})) return 3;
    return Box{o.x - 4, 2, 24, 40}.contains({x, y}) ? 2 : 1;
  });
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, {9, 1}, {9, 1}}), ElementsAre(0, 0, 1));
}

TEST(OwnMotion, GroundDoesNotGoWithAFewPixelsOfStrongContrast) {
  // Half of what moves was cut together with twice as much ground of little contrast.
  const TwoFrames frames({9, 1});
  const auto at = [&](int time) {
    return scenes::paintGrey(kSize, [&](int x, int y) {
      const Point o = frames.squareAt(time);
      const int level = frames.levelAt(x, y, time);
      return Box{o.x, o.y, 16, 16}.contains({x, y}) ? level : 100 + level / 8;
    });
  };
  const Point o = frames.squareAt(1);
  const auto labels = scenes::label(at(1), 3, [&](int x, int y) {
    if (Box{o.x, o.y + 8, 16, 8}.contains({x, y})) return 3;
    return Box{o.x - 4, o.y - 8, 24, 16}.contains({x, y}) ? 2 : 1;
  });
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, {9, 1}, {9, 1}}), ElementsAre(0, 0, 1));
}

/// Of a square of 16x16.
int64_t gainIn(Size frame) {
  const TwoFrames frames({9, 1});
  const auto at = [&](int time) {
    return scenes::paintGrey(frame, [&](int x, int y) { return frames.levelAt(x, y, time); });
  };
  const Point o = frames.squareAt(1);
  const auto labels = scenes::label(at(1), 2, [&](int x, int y) {
    return Box{o.x, o.y, 16, 16}.contains({x, y}) ? 2 : 1;
  });
  return searchFor(*at(0), labels, {kCamera, {9, 1}}).own[1].gain;
}

TEST(OwnMotion, GainsAsALengthDoesFromFrameToFrameOfOtherSizes) {
  const int64_t gain = gainIn({96, 96});
  EXPECT_GT(gain, 0);
  EXPECT_NEAR(static_cast<double>(gainIn({192, 192})), static_cast<double>(gain) / 2, 1);
  EXPECT_NEAR(static_cast<double>(gainIn({96, 384})), static_cast<double>(gain) / 2, 1);
}

/// Of a square and of a piece of plain ground ahead of it, whose first pixels are half the
/// square's.
std::vector<uint8_t> moversBehindBlur(Point step) {
  const TwoFrames frames(step);
  const auto pieceAt = [&](int time) {
    const Point o = frames.squareAt(time);
    if (std::abs(step.x) >= std::abs(step.y))
      return Box{o.x + (step.x > 0 ? 16 : -12), o.y, 12, 16};
    return Box{o.x, o.y + (step.y > 0 ? 16 : -12), 16, 12};
  };
  const auto at = [&](int time) {
    return scenes::paintGrey(kSize, [&](int x, int y) {
      const Point o = frames.squareAt(time);
      if (Box{o.x, o.y, 16, 16}.contains({x, y})) return frames.levelAt(x, y, time) + 90;
      return Box{o.x - 1, o.y - 1, 18, 18}.contains({x, y}) ? 160 : 100;
    });
  };
  const Point o = frames.squareAt(1);
  const auto labels = scenes::label(at(1), 3, [&](int x, int y) {
    if (Box{o.x, o.y, 16, 16}.contains({x, y})) return 3;
    return pieceAt(1).contains({x, y}) ? 2 : 1;
  });
  return moversOf(*at(0), labels, {kCamera, step, step});
}

TEST(OwnMotion, GroundDoesNotGoWithTheBlurredEdgeOfAMover) {
  for (const Point step : {Point{9, 1}, Point{-5, 2}, Point{3, 7}, Point{2, -5}})
    EXPECT_THAT(moversBehindBlur(step), ElementsAre(0, 0, 1)) << step.x << ' ' << step.y;
}

TEST(OwnMotion, APlainMoverIsToldByItsEdges) {
  const TwoFrames frames({9, 1});
  const auto at = [&](int time) {
    return scenes::paintGrey(kSize, [&](int x, int y) {
      const Point o = frames.squareAt(time);
      return Box{o.x, o.y, 16, 16}.contains({x, y}) ? 200 : 100;
    });
  };
  const Point o = frames.squareAt(1);
  const auto labels = scenes::label(at(1), 2, [&](int x, int y) {
    return Box{o.x, o.y, 16, 16}.contains({x, y}) ? 2 : 1;
  });
  EXPECT_THAT(moversOf(*at(0), labels, {kCamera, {9, 1}}), ElementsAre(0, 1));
}

TEST(OwnMotion, WorkIsBoundedWhereAllOfALargeFrameMoves) {
  constexpr Size kLarge{2048, 1024};
  constexpr int kSide = 64, kAcross = kLarge.width / kSide, kTiles = kAcross * 16;
  const auto tileAt = [](int x, int y) { return y / kSide * kAcross + x / kSide; };
  const auto stepOf = [](int tile) { return Point{3 + tile % 5, tile % 3 - 1}; };
  const auto at = [&](int time) {
    return scenes::paintGrey(kLarge, [&](int x, int y) {
      const int tile = tileAt(x, y);
      const Point step = stepOf(tile);
      return texture(x - time * step.x + 50, y - time * step.y + 50,
                     100 + static_cast<uint32_t>(tile));
    });
  };
  const auto labels = scenes::label(at(1), kTiles, [&](int x, int y) { return tileAt(x, y) + 1; });
  std::vector<Point> vectors;
  for (int tile = 0; tile < kTiles; ++tile) vectors.push_back(stepOf(tile));
  motion::Motion motion = motionOf(labels, vectors);
  motion.camera = {};
  const std::vector<objects::ArcEnergy> arcs = energiesOf(motion);
  const auto previous = at(0);
  objects::OwnMotionScratch scratch;
  std::vector<objects::OwnMotion> own;
  objects::clearOwnMotion(motion.regions.size(), scratch, own);
  const Executor executor(1);
  objects::Operations operations(executor);
  objects::findOwnMotion(motion, since(*previous, motion), {arcs, {}, {}, {}}, operations, scratch,
                         own);
  EXPECT_GT(scratch.mostPixels, 200'000u);
  EXPECT_LT(scratch.mostPixels, 600'000u);
  EXPECT_EQ(std::count(scratch.moves.begin(), scratch.moves.end(), 1), kTiles);
}

/// The same pixel by pixel, over whole frames.
class Plainly {
 public:
  Plainly(const motion::Motion& motion, const Picture& previous, motion::RegionMotion camera)
      : motion_(motion),
        labels_(*motion.graph->labels),
        now_(labels_.picture->luma()),
        camera_(camera),
        before_(previous.luma()) {}

  std::vector<objects::OwnMotion> run() {
    const size_t count = motion_.regions.size();
    own_.assign(count, {});
    moves_.assign(count, 0);
    std::vector<Point> shifts;
    for (const motion::RegionMotion& m : motion_.regions) {
      const int64_t dx = m.dx - camera_.dx, dy = m.dy - camera_.dy;
      const auto whole = [](int64_t d) {
        return static_cast<int>(divideRounded(d, motion::kMotionUnit));
      };
      shifts.push_back(dx * dx + dy * dy > motion::kMotionUnit * motion::kMotionUnit
                           ? Point{whole(dx), whole(dy)}
                           : Point{});
    }
    for (int round = 0; round < 2; ++round) tryShifts(shifts, true);
    for (int round = 0; round < 2; ++round) tryShifts(neighboursShifts(), false);
    return own_;
  }

 private:
  struct Sums {
    int64_t still = 0, moved = 0, pixels = 0;
  };

  [[nodiscard]] int expected(int x, int y) const {
    const auto at = [&](int px, int py) {
      return int{before_.at(std::clamp(px, 0, before_.width() - 1),
                            std::clamp(py, 0, before_.height() - 1))};
    };
    const int fx = x * motion::kMotionUnit - camera_.dx, fy = y * motion::kMotionUnit - camera_.dy;
    const int px = fx >> 4, py = fy >> 4, u = fx & 15, v = fy & 15;
    const int top = at(px, py) * (16 - u) + at(px + 1, py) * u;
    const int low = at(px, py + 1) * (16 - u) + at(px + 1, py + 1) * u;
    return (top * (16 - v) + low * v + 128) >> 8;
  }

  [[nodiscard]] bool isShown(int x, int y) const {
    const auto isInside = [](int at, int shift, int length) {
      return at * motion::kMotionUnit >= shift &&
             at * motion::kMotionUnit < length * motion::kMotionUnit + (shift & ~15);
    };
    return boundsOf(labels_.size).contains({x, y}) && isInside(x, camera_.dx, labels_.size.width) &&
           isInside(y, camera_.dy, labels_.size.height);
  }

  [[nodiscard]] bool isHidden(int x, int y, size_t region) const {
    size_t by = moves_.size();
    for (size_t i = 0; i < moves_.size(); ++i) {
      const auto isOwn = [&](Point to) {
        return boundsOf(labels_.size).contains(to) && labels_.ids.at(to.x, to.y) == i + 1;
      };
      const Point shift = own_[i].shift, to{x + shift.x, y + shift.y};
      if (moves_[i] != 0 && (isOwn(to) || isOwn(behind(to, {-shift.x, -shift.y})))) by = i;
    }
    return by != moves_.size() && by != region;
  }

  [[nodiscard]] static Point behind(Point p, Point shift) {
    const auto towards = [](int from, int step) {
      return step == 0 ? from : step > 0 ? from - 1 : from + 1;
    };
    return {towards(p.x, shift.x), towards(p.y, shift.y)};
  }

  /// Whether the pixel behind one of a region is the region's, too.
  [[nodiscard]] bool isHeld(int x, int y, Point shift) const {
    const Point back = behind({x, y}, shift);
    return boundsOf(labels_.size).contains(back) &&
           labels_.ids.at(back.x, back.y) == labels_.ids.at(x, y);
  }

  /// Over six of eight bands along the shift.
  [[nodiscard]] Sums compare(size_t region, Point shift) const {
    const Box& box = motion_.graph->regions[region].box;
    std::array<Sums, 8> bands;
    Sums all;
    const auto add = [&](Sums& sums, int still, int moved) {
      sums.still += still;
      sums.moved += moved;
      ++sums.pixels;
    };
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x) {
        const Point from{x - shift.x, y - shift.y};
        if (labels_.ids.at(x, y) != region + 1 || !isShown(x, y) || !isShown(from.x, from.y) ||
            isHidden(x, y, region) || !isHeld(x, y, shift))
          continue;
        const int still = std::min(absDiff(now_.at(x, y), expected(x, y)), mostLevels_);
        const int moved = std::min(absDiff(now_.at(x, y), expected(from.x, from.y)), mostLevels_);
        size_t band = 0;
        if (std::abs(shift.x) >= std::abs(shift.y))
          band = static_cast<size_t>(8 * (y - box.y) / box.height);
        else
          while (x >= box.x + static_cast<int>(band + 1) * box.width / 8) ++band;
        add(bands[band], still, moved);
        add(all, still, moved);
      }
    Sums best = bands[0];
    int64_t most = INT64_MIN;
    for (size_t i = 0; i + 1 < bands.size(); ++i) {
      const Sums &a = bands[i], &b = bands[i + 1];
      const int64_t gain = a.still + b.still - a.moved - b.moved;
      if (gain > most) best = {a.still + b.still, a.moved + b.moved, a.pixels + b.pixels};
      most = std::max(most, gain);
    }
    if (best.pixels == all.pixels) return all;
    return {all.still - best.still, all.moved - best.moved, all.pixels - best.pixels};
  }

  void tryShifts(const std::vector<Point>& shifts, bool isSearched) {
    std::vector<Sums> sums(shifts.size());
    int64_t noise = 0, pixels = 0;
    for (size_t i = 0; i < shifts.size(); ++i) {
      if (shifts[i] == Point{}) continue;
      sums[i] = compare(i, shifts[i]);
      noise += std::min(sums[i].still, sums[i].moved);
      pixels += sums[i].pixels;
    }
    if (isSearched) {
      noise_ = std::max<int64_t>(16, 16 * noise / pixels);
      mostLevels_ = static_cast<int>(std::clamp<int64_t>(6 * noise_ / 16, 16, 255));
    }
    const auto before = moves_;
    for (size_t i = 0; i < shifts.size(); ++i) {
      if (shifts[i] == Point{}) continue;
      const Sums& s = sums[i];
      const int64_t gain =
          256 * 16 * (s.still - s.moved - s.pixels / 4) / noise_ -
          256 * (isSearched ? 4 : 1) * int64_t{integerSqrt(static_cast<uint64_t>(s.pixels))};
      const auto side = static_cast<int64_t>(std::sqrt(static_cast<double>(labels_.size.area())));
      own_[i] = {shifts[i], gain * 832 / side};
      int64_t sides = 0;  // What moving gains at the borders, less what it costs.
      for (size_t n = 0; n < energies_.size(); ++n) {
        const graph::Arc& arc = motion_.graph->arcs[n];
        const uint32_t a = arc.a.index(), b = arc.b.index();
        if (a == i || b == i)
          sides +=
              (before[a == i ? b : a] != 0 ? 1 : -1) * (energies_[n].border + energies_[n].arc);
      }
      const int64_t unexpected = 512 * int64_t{integerSqrt(motion_.graph->regions[i].areaPx)};
      moves_[i] = sides + own_[i].gain > unexpected;
    }
  }

  /// Of what moves and shares most of the border of what does not.
  [[nodiscard]] std::vector<Point> neighboursShifts() const {
    std::vector<Point> shifts(moves_.size());
    std::vector<uint32_t> longest(moves_.size());
    const auto see = [&](size_t region, size_t other, uint32_t border) {
      if (moves_[region] != 0 || moves_[other] == 0 || border <= longest[region]) return;
      longest[region] = border;
      shifts[region] = own_[other].shift;
    };
    for (const graph::Arc& arc : motion_.graph->arcs) {
      see(arc.a.index(), arc.b.index(), arc.borderPx);
      see(arc.b.index(), arc.a.index(), arc.borderPx);
    }
    return shifts;
  }

  const motion::Motion& motion_;
  const segmentation::Labels& labels_;
  ImageView<const uint8_t> now_;
  motion::RegionMotion camera_;
  ImageView<const uint8_t> before_;
  std::vector<objects::ArcEnergy> energies_ = energiesOf(motion_);
  std::vector<objects::OwnMotion> own_;
  std::vector<uint8_t> moves_;
  int64_t noise_ = 16;
  int mostLevels_ = 255;
};

/// Ragged tiles, some of which move otherwise than the camera, with vectors right and wrong.
TEST(OwnMotion, IsThatOfEachPixelOnEveryTargetAndNumberOfThreads) {
  constexpr Size kFrame{150, 67};
  constexpr int kAcross = 15, kTiles = kAcross * 7;
  int movers = 0;
  for (const motion::RegionMotion& camera :
       {motion::RegionMotion{0, 0, 0, 256}, motion::RegionMotion{37, -21, 0, 256}}) {
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
    motion::Motion motion;
    motion.size = kFrame;
    motion.status = Status::Ok;
    motion.camera = CameraMotion(Point{camera.dx, camera.dy});
    motion.graph = *graph::makeStage(scenes::contextWith(1))
                        ->process(scenes::label(current, kTiles,
                                                [&](int x, int y) { return tileAt(x, y) + 1; }),
                                  {});
    for (int tile = 0; tile < kTiles; ++tile) {
      const Point step = tile % 7 == 1 ? Point{-30 + tile, 4} : stepOf(tile);
      motion.regions.push_back({camera.dx + step.x * 16 + tile % 5, camera.dy + step.y * 16, 0, 9});
    }
    const auto expected = Plainly(motion, *previous, camera).run();
    movers +=
        static_cast<int>(std::count_if(expected.begin(), expected.end(),
                                       [](const objects::OwnMotion& own) { return own.gain > 0; }));
    const std::vector<objects::ArcEnergy> arcs = energiesOf(motion);
    test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
      objects::Operations operations(*executor);
      objects::OwnMotionScratch scratch;
      std::vector<objects::OwnMotion> own;
      for (int frame = 0; frame < 2; ++frame) {
        objects::clearOwnMotion(motion.regions.size(), scratch, own);
        objects::findOwnMotion(motion, since(*previous, motion), {arcs, {}, {}, {}}, operations,
                               scratch, own);
      }
      EXPECT_EQ(own, expected);
    });
  }
  EXPECT_GT(movers, 20);
}

}  // namespace
}  // namespace rg
