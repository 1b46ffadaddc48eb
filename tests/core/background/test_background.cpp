// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/background.hpp"
#include "tests/support/text_picture.hpp"
#include "tests/support/value_of.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace rg {
namespace {

using test::makePicture;
using test::Rgb;

constexpr Size kSize{120, 90};
constexpr int64_t kFrameNs = 40'000'000;

/// A wall with a coarse pattern, a little sensor noise, an object and a gain of the light.
struct Shot {
  int frame = 0;
  std::optional<Box> object;
  int gainPercent = 100;
};

std::shared_ptr<const Picture> shoot(const Shot& shot) {
  return makePicture(kSize, [&](int x, int y) {
    uint32_t noise = static_cast<uint32_t>(x * 7919 + y * 104729 + shot.frame * 1299709);
    noise = (noise ^ noise >> 13) * 0x5bd1e995u;
    int level = 110 + 30 * ((x / 15 + y / 12) % 3);
    int blue = level - 20;
    if (shot.object && shot.object->contains({x, y})) {
      level = 40 + 5 * ((x + y) / 4 % 2);
      blue = 160;
    }
    const auto lit = [&](int value, int shift) {
      const int off = static_cast<int>(noise >> shift & 7) - 3;
      return static_cast<uint8_t>(std::clamp(value * shot.gainPercent / 100 + off, 0, 255));
    };
    return Rgb{lit(level, 8), lit(level, 16), lit(blue, 24)};
  });
}

class Camera {
 public:
  explicit Camera(background::Params params = {}, int threads = 1)
      : stage_(background::makeStage({std::make_shared<const Executor>(threads), nullptr})),
        params_(params) {}

  std::shared_ptr<const background::Foreground> show(std::optional<Box> object,
                                                     int gainPercent = 100) {
    const auto picture = shoot({frame_, object, gainPercent});
    auto result = stage_->process(picture, params_, {frame_ * kFrameNs, true});
    ++frame_;
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    return *result;
  }
  std::shared_ptr<const background::Foreground> showFor(int frames,
                                                        std::optional<Box> object = {}) {
    for (int i = 1; i < frames; ++i) show(object);
    return show(object);
  }
  background::Stage& stage() { return *stage_; }

 private:
  std::unique_ptr<background::Stage> stage_;
  background::Params params_;
  int frame_ = 0;
};

struct Score {
  int inside = 0;   ///< Foreground in the object, percent of it.
  int outside = 0;  ///< Foreground elsewhere, pixels.
};

Score scoreOf(const background::Foreground& foreground, const Box& object) {
  int in = 0, out = 0;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      if (foreground.mask.at(x, y) == background::kForegroundPixel)
        ++(object.contains({x, y}) ? in : out);
  return {static_cast<int>(100 * in / std::max<int64_t>(1, object.area())), out};
}

Box walker(int step) {
  return {10 + 2 * step, 30, 14, 36};
}

background::Params paper(int trainingFrames) {
  background::Params params;
  params.method = background::Method::Paper;
  params.trainingFrames = trainingFrames;
  return params;
}

TEST(Background, PaperTrainsThenFinds) {
  Camera camera(paper(20));
  for (int i = 0; i < 20; ++i) {
    const auto foreground = camera.show({});
    EXPECT_EQ(foreground->status, Status::Training);
    EXPECT_EQ(foreground->scene.foregroundPx, 0u);
  }
  EXPECT_EQ(camera.show({})->status, Status::Ok);
  for (int i = 0; i < 10; ++i) camera.show(walker(i));
  const auto foreground = camera.show(walker(10));
  const Score score = scoreOf(*foreground, walker(10));
  EXPECT_GE(score.inside, 95);
  EXPECT_LE(score.outside, 40);
}

TEST(Background, HybridFindsAWalkerWhole) {
  Camera camera;
  camera.showFor(30);
  std::shared_ptr<const background::Foreground> foreground;
  for (int i = 0; i < 30; ++i) foreground = camera.show(walker(i));
  const Score score = scoreOf(*foreground, walker(29));
  EXPECT_GE(score.inside, 95);
  EXPECT_LE(score.outside, 120);  // A rim of a pixel is 104.
  ASSERT_EQ(foreground->areas.size(), 1u);
  EXPECT_EQ(intersect(foreground->areas[0], walker(29)), walker(29));
}

TEST(Background, HybridNeedsNoEmptyScene) {
  Camera camera;
  EXPECT_EQ(camera.show(walker(0))->status, Status::Training);
  std::shared_ptr<const background::Foreground> foreground;
  for (int i = 1; i < 12; ++i) {
    foreground = camera.show(walker(i));
    EXPECT_EQ(foreground->status, Status::Ok);
  }
  EXPECT_GE(scoreOf(*foreground, walker(11)).inside, 60);
  for (int i = 12; i < 40; ++i) foreground = camera.show(walker(i));
  const Score score = scoreOf(*foreground, walker(39));
  EXPECT_GE(score.inside, 95);
  EXPECT_LE(score.outside, 130);  // The ghost of the first frame has gone.
}

TEST(Background, AnEmptySceneStaysEmpty) {
  Camera camera;
  camera.showFor(5);
  for (int i = 0; i < 60; ++i) EXPECT_EQ(camera.show({})->scene.foregroundPx, 0u);
}

TEST(Background, AStoppedThingStaysForAbsorbTimeThenFades) {
  background::Params params;
  params.absorbTimeS = 4;
  Camera camera(params);
  camera.showFor(60);
  for (int i = 0; i < 20; ++i) camera.show(walker(i));
  const auto stopped = walker(20);
  EXPECT_GE(scoreOf(*camera.showFor(75, stopped), stopped).inside, 95);
  EXPECT_EQ(camera.showFor(60, stopped)->scene.foregroundPx, 0u);
  // It walks away; the place that it leaves must not stay behind.
  for (int i = 20; i < 45; ++i) camera.show(walker(i));
  const Score score = scoreOf(*camera.show(walker(45)), walker(45));
  EXPECT_GE(score.inside, 95);
  EXPECT_LE(score.outside, 130);
}

// 44 minutes at 25 frames a second are more frames than 16 bits count.
TEST(Background, AStoppedThingStaysForAnHourIfAsked) {
  const Size size{32, 24};
  const auto stage = background::makeStage({std::make_shared<Executor>(1), nullptr});
  background::Params params;
  params.absorbTimeS = 3600;
  const auto paint = [&](bool isThere) {
    return makePicture(size, [&](int x, int y) {
      const auto level = static_cast<uint8_t>(90 + x % 5 * 6 + y % 3 * 9);
      return isThere && x >= 12 && x < 18 && y >= 8 && y < 16 ? Rgb{200, 60, 60}
                                                              : Rgb{level, level, 80};
    });
  };
  const auto empty = paint(false), there = paint(true);
  constexpr int kHour = 3600 * 25, kStart = 100;
  int frame = 0;
  const auto foregroundAt = [&](int last) {
    uint32_t pixels = 0;
    for (; frame <= last; ++frame) {
      const FrameTime time{int64_t{frame} * 40'000'000, true};
      const auto picture = frame < kStart ? empty : there;
      pixels = valueOf(stage->process(picture, params, time))->scene.foregroundPx;
    }
    return pixels;
  };
  EXPECT_GE(foregroundAt(kStart + kHour - 1000), 30u);
  EXPECT_EQ(foregroundAt(kStart + kHour + 1000), 0u);
}

TEST(Background, ALightSwitchIsFollowedAndReported) {
  Camera camera;
  camera.showFor(60);
  for (int i = 0; i < 10; ++i) camera.show(walker(i));
  EXPECT_EQ(camera.show(walker(10), 40)->scene.event, background::SceneEvent::LightSwitched);
  std::shared_ptr<const background::Foreground> foreground;
  for (int i = 11; i < 30; ++i) {
    foreground = camera.show(walker(i), 40);
    EXPECT_EQ(foreground->scene.event, background::SceneEvent::None);
  }
  EXPECT_GE(scoreOf(*foreground, walker(29)).inside, 80);
  EXPECT_LE(scoreOf(*foreground, walker(29)).outside, 216);
  EXPECT_EQ(camera.show(walker(30))->scene.event, background::SceneEvent::LightSwitched);
  for (int i = 31; i < 50; ++i) foreground = camera.show(walker(i));
  EXPECT_GE(scoreOf(*foreground, walker(49)).inside, 80);
  EXPECT_LE(scoreOf(*foreground, walker(49)).outside, 216);
}

TEST(Background, AnotherSceneStartsAnew) {
  Camera camera;
  camera.showFor(30);
  const auto other = makePicture(kSize, [](int x, int y) {
    return (x / 7 + y / 5) % 2 == 0 ? Rgb{250, 10, 30} : Rgb{0, 240, 90};
  });
  const auto foreground = camera.stage().process(other, {}, {30 * kFrameNs, true});
  ASSERT_TRUE(foreground);
  EXPECT_EQ((*foreground)->scene.event, background::SceneEvent::CameraMoved);
  const auto next = camera.stage().process(other, {}, {31 * kFrameNs, true});
  EXPECT_EQ((*next)->scene.foregroundPx, 0u);
}

void expectSameMasks(const background::Foreground& a, const background::Foreground& b) {
  for (int y = 0; y < a.size.height; ++y)
    ASSERT_EQ(std::memcmp(a.mask.row(y), b.mask.row(y), static_cast<size_t>(a.size.width)), 0);
  EXPECT_EQ(a.areas, b.areas);
}

TEST(Background, ThreadsChangeNothing) {
  for (const auto& params : {background::Params{}, paper(10)}) {
    Camera one(params, 1), two(params, 2);
    for (int i = 0; i < 45; ++i) {
      const int gain = i < 30 ? 100 : 60;
      expectSameMasks(*one.show(walker(i), gain), *two.show(walker(i), gain));
    }
  }
}

TEST(Background, TheSmallestFramesAndNoiseWork) {
  uint32_t state = 5;
  const auto noise = [&](int, int) {
    state = state * 1664525u + 1013904223u;
    return static_cast<int>(state >> 24);
  };
  for (const auto& params : {background::Params{}, paper(2)})
    for (const Size size : {Size{1, 1}, Size{1, 37}, Size{37, 1}, Size{2, 2}, Size{257, 3}}) {
      const auto stage = background::makeStage({std::make_shared<const Executor>(2), nullptr});
      for (int frame = 0; frame < 12; ++frame) {
        const auto result =
            stage->process(test::makeGreyPicture(size, noise), params, {frame * kFrameNs, true});
        ASSERT_TRUE(result);
        EXPECT_EQ((*result)->mask.size(), size);
      }
    }
}

TEST(Background, AnotherSizeIsRefusedUntilTheStreamIsReset) {
  const auto stage = background::makeStage({std::make_shared<const Executor>(1), nullptr});
  const auto flat = [](Size size) {
    return test::makeGreyPicture(size, [](int, int) { return 100; });
  };
  ASSERT_TRUE(stage->process(flat({8, 8}), {}, {}));
  EXPECT_FALSE(stage->process(flat({8, 9}), {}, {}));
  EXPECT_FALSE(stage->process(nullptr, {}, {}));
  stage->reset(Reset::Gap);
  EXPECT_FALSE(stage->process(flat({8, 9}), {}, {}));
  EXPECT_TRUE(stage->process(flat({8, 8}), {}, {}));
  stage->reset(Reset::Stream);
  EXPECT_TRUE(stage->process(flat({8, 9}), {}, {}));
}

TEST(Background, AFlushKeepsTheModel) {
  Camera camera;
  camera.showFor(30);
  camera.stage().reset(Reset::Flush);
  const auto foreground = camera.show(walker(5));
  EXPECT_EQ(foreground->status, Status::Ok);
  EXPECT_GE(scoreOf(*foreground, walker(5)).inside, 90);
}

TEST(Background, ResultsLiveOnAfterTheStage) {
  std::shared_ptr<const background::Foreground> kept;
  {
    Camera camera;
    camera.showFor(30);
    kept = camera.show(walker(3));
    camera.showFor(10);
  }
  EXPECT_GE(scoreOf(*kept, walker(3)).inside, 90);
}

}  // namespace
}  // namespace rg
