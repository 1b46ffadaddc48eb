// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_search.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace rg {
namespace {

constexpr Size kSize{480, 270};

struct Place {
  double x, y;
};
using Way = std::function<Place(double, double)>;  ///< From now to before, from the middle.

/// A ground with features of all sizes.
double groundAt(double u, double v) {
  return 128 + 30 * std::sin(u * .051 + 2 * std::cos(v * .04)) +
         25 * std::sin(v * .083 + u * .013) + 20 * std::sin(u * .37) * std::cos(v * .31) +
         15 * std::sin(u * .9 + v * .7);
}

using Covering = std::function<bool(int x, int y)>;

/// The ground seen by a camera before (`isNow` false) and after it has moved, with noise, and
/// things of strong contrast before it that move by (−9, 4).
std::shared_ptr<const Picture> view(bool isNow, const Way& before, const Covering& covers,
                                    double contrast = 1) {
  std::mt19937 random(isNow ? 1 : 2);
  std::normal_distribution<double> noise(0, 3);
  return scenes::paintGrey(kSize, [&](int x, int y) {
    const double u = x - (kSize.width - 1) / 2.0, v = y - (kSize.height - 1) / 2.0;
    const Place at = isNow ? before(u, v) : Place{u, v};
    double level = 128 + contrast * (groundAt(at.x, at.y) - 128);
    const int tx = isNow ? x + 9 : x, ty = isNow ? y - 4 : y;
    if (covers && covers(tx, ty)) level = ((tx / 7 + ty / 7) % 2 != 0) ? 230 : 20;
    return static_cast<int>(std::clamp(level + noise(random), 0.0, 255.0));
  });
}

double worstAtCorners(const CameraMotion& camera, const Way& before) {
  double worst = 0;
  for (const int x : {0, kSize.width - 1})
    for (const int y : {0, kSize.height - 1}) {
      const Point found = camera.before(x, y);
      const double middleX = (kSize.width - 1) / 2.0, middleY = (kSize.height - 1) / 2.0;
      const Place is = before(x - middleX, y - middleY);
      worst = std::max(
          worst, std::hypot(found.x / 256.0 - middleX - is.x, found.y / 256.0 - middleY - is.y));
    }
  return worst;
}

CameraMotion find(const Way& before, const Covering& covers = {}, double contrast = 1) {
  CameraSearch search;
  return search.find(view(true, before, covers, contrast), view(false, before, covers, contrast),
                     Executor(1));
}

Way turned(double scale, double degrees, double dx, double dy) {
  const double angle = degrees * .017453292519943295;
  return [=](double x, double y) {
    return Place{scale * (x * std::cos(angle) - y * std::sin(angle)) + dx,
                 scale * (x * std::sin(angle) + y * std::cos(angle)) + dy};
  };
}

TEST(CameraSearch, WhatStandsStillHasNoMotion) {
  EXPECT_EQ(find(turned(1, 0, 0, 0)), CameraMotion());
  const auto flat = scenes::paintGrey(kSize, [](int, int) { return 90; });
  CameraSearch search;
  EXPECT_EQ(search.find(flat, flat, Executor(1)), CameraMotion());
}

TEST(CameraSearch, FindsAPanOfAnyLengthAsAShift) {
  for (const Place by : {Place{2.25, 0}, Place{-13, 5.5}, Place{70, -30}}) {
    const Way before = turned(1, 0, -by.x, -by.y);
    const CameraMotion camera = find(before);
    EXPECT_TRUE(camera.isShift()) << by.x;
    EXPECT_LT(worstAtCorners(camera, before), .15) << by.x;
  }
}

TEST(CameraSearch, FindsZoomAndRollAtTheCorners) {
  for (const double zoom : {.98, 1.02})
    for (const double roll : {-2.0, 2.0}) {
      const Way before = turned(zoom, roll, 6, -3);
      EXPECT_LT(worstAtCorners(find(before), before), .25) << zoom << ' ' << roll;
    }
}

TEST(CameraSearch, FindsASlantAndARollingShuttersShear) {
  const Way slanted = [](double x, double y) {
    const double w = 1 + 4e-5 * x - 3e-5 * y;
    return Place{(1.01 * x + .004 * y - 5) / w, (.002 * x + .99 * y + 2) / w};
  };
  EXPECT_LT(worstAtCorners(find(slanted), slanted), .25);
  const Way sheared = [](double x, double y) { return Place{x + .03 * y - 8, y}; };
  EXPECT_LT(worstAtCorners(find(sheared), sheared), .25);
}

TEST(CameraSearch, AThirdThatMovesOtherwiseIsNotTheCameraHoweverLoud) {
  const Covering third = [](int x, int y) {
    return std::hypot(x - 200, y - 130) < 75 || (x > 330 && y > 120 && x < 450);
  };
  for (const double contrast : {1.0, .4}) {
    const Way before = turned(.98, 2, 6, -3);
    EXPECT_LT(worstAtCorners(find(before, third, contrast), before), .3) << contrast;
  }
}

TEST(CameraSearch, FindsWhatBeginsWhileMuchOfThePictureFlickers) {
  std::mt19937 random(3);
  CameraSearch search;
  std::shared_ptr<const Picture> previous;
  Place at{};
  int step = 0;
  for (const Place by : {Place{}, Place{}, Place{}, Place{}, Place{-13, 5.5}, Place{-13, 5.5},
                         Place{}, Place{}, Place{1.5, 0}, Place{20, -9}}) {
    SCOPED_TRACE(step++);
    at = {at.x + by.x, at.y + by.y};
    const auto now = scenes::paintGrey(kSize, [&](int x, int y) {
      return x % 96 < 42 ? static_cast<int>(random() % 256)
                         : static_cast<int>(groundAt(x + at.x, y + at.y));
    });
    if (previous) {
      const CameraMotion camera = search.find(now, previous, Executor(1));
      EXPECT_LT(worstAtCorners(camera, turned(1, 0, by.x, by.y)), .7);
    }
    previous = now;
  }
}

TEST(CameraSearch, IsTheSameOnAllTargetsAndThreads) {
  const Way before = turned(1.01, -1, 9, 2);
  const CameraMotion expected = find(before);
  const auto now = view(true, before, {}), then = view(false, before, {});
  test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
    CameraSearch search;
    EXPECT_EQ(search.find(now, then, *executor), expected);
  });
}

TEST(CameraSearch, TakesPicturesOfAnySizeOneAfterAnother) {
  CameraSearch search;
  for (const Size size : {Size{480, 270}, Size{1, 1}, Size{7, 300}, Size{900, 2}, Size{16, 16},
                          Size{2000, 9}, Size{33, 47}, Size{480, 270}}) {
    const CameraMotion camera =
        search.find(scenes::greyNoise(size, 1), scenes::greyNoise(size, 2), Executor(1));
    EXPECT_TRUE(camera.isSafe());
  }
}

}  // namespace
}  // namespace rg
