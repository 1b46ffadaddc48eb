// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/background.hpp"
#include "core/base/components.hpp"
#include "core/base/pixel.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <random>

namespace rg {
namespace {

using test::makeGreyPicture;
using test::makePicture;
using test::Rgb;

constexpr Size kSize{240, 180};
constexpr int64_t kFrameNs = 40'000'000;

std::unique_ptr<background::Stage> makeStage(int threads = 1) {
  return background::makeStage({std::make_shared<const Executor>(threads), nullptr});
}

background::Params paramsFor(background::SearchScope search) {
  background::Params params;
  params.method = background::Method::FrameDifference;
  params.search = search;
  return params;
}

/// A patterned wall with noise of up to two grey levels, and things of one colour before it.
std::shared_ptr<const Picture> shoot(int frame, const std::vector<Box>& things, Size size = kSize,
                                     int light = 256) {
  return makePicture(size, [&](int x, int y) {
    const uint32_t hash =
        mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(frame));
    const int noise = static_cast<int>(hash % 5) - 2;
    Rgb colour{90, 110, 100};
    if ((x / 12 + y / 10) % 2 == 0) colour = {120, 120, 140};
    for (size_t i = 0; i < things.size(); ++i)
      if (things[i].contains({x, y}))
        colour = {static_cast<uint8_t>(200 + 3 * i), static_cast<uint8_t>(30 + 5 * i), 40};
    const auto lit = [&](int level) {
      return static_cast<uint8_t>(std::clamp(level * light / 256 + noise, 0, 255));
    };
    return Rgb{lit(colour.red), lit(colour.green), lit(colour.blue)};
  });
}

class Camera {
 public:
  explicit Camera(background::Params params = paramsFor(background::SearchScope::Areas),
                  int threads = 1)
      : stage_(makeStage(threads)), params_(params) {}

  std::shared_ptr<const background::Foreground> show(std::shared_ptr<const Picture> picture) {
    auto result = stage_->process(std::move(picture), params_, {frame_++ * kFrameNs, true});
    EXPECT_TRUE(result);
    return *result;
  }
  std::shared_ptr<const background::Foreground> show(const std::vector<Box>& things,
                                                     int light = 256) {
    return show(shoot(frame_, things, kSize, light));
  }
  std::shared_ptr<const background::Foreground> showFor(int frames,
                                                        const std::vector<Box>& things) {
    for (int i = 1; i < frames; ++i) show(things);
    return show(things);
  }
  background::Stage& stage() { return *stage_; }
  background::Params& params() { return params_; }

 private:
  std::unique_ptr<background::Stage> stage_;
  background::Params params_;
  int frame_ = 0;
};

void expectSame(const background::Foreground& a, const background::Foreground& b) {
  EXPECT_EQ(a.areas, b.areas);
  EXPECT_EQ(a.scene.event, b.scene.event);
  ASSERT_EQ(a.mask.size(), b.mask.size());
  for (int y = 0; y < a.mask.height(); ++y)
    ASSERT_EQ(std::memcmp(a.mask.row(y), b.mask.row(y), static_cast<size_t>(a.mask.width())), 0)
        << "row " << y;
}

using PictureAt = std::function<std::shared_ptr<const Picture>(int frame)>;

/// Runs both searches, and the areas on one to four threads, and compares every frame.
void expectAreasFindWhatFrameFinds(
    int frames, const PictureAt& pictureAt,
    background::Params params = paramsFor(background::SearchScope::Frame)) {
  params.search = background::SearchScope::Frame;
  Camera whole(params);
  params.search = background::SearchScope::Areas;
  std::vector<Camera> others;
  for (const int threads : {1, 2, 3, 4}) others.emplace_back(params, threads);
  for (int i = 0; i < frames; ++i) {
    SCOPED_TRACE("frame " + std::to_string(i));
    const auto picture = pictureAt(i);
    const auto expected = whole.show(picture);
    for (Camera& other : others) expectSame(*expected, *other.show(picture));
    if (::testing::Test::HasFailure()) return;
  }
}

/// Where a thing is that runs to and fro between 0 and `most`.
int bounce(int start, int step, int frame, int most) {
  const int p = (start + step * frame) % (2 * most);
  return p < most ? p : 2 * most - p;
}

std::vector<Box> runners(int count, int frame) {
  std::vector<Box> things;
  for (int i = 0; i < count; ++i) {
    const int x = bounce(17 * i + 5, 2 + i % 4, frame, kSize.width - 24);
    const int y = bounce(31 * i + 9, 1 + i % 3, frame, kSize.height - 24);
    things.push_back({x, y, 16 + i % 3 * 4, 16 + i % 2 * 8});
  }
  return things;
}

TEST(FrameDifference, AreasFindWhatTheFrameFindsForOneToThirteenThings) {
  for (const int count : {0, 1, 3, 5, 7, 10, 13}) {
    SCOPED_TRACE(std::to_string(count) + " things");
    expectAreasFindWhatFrameFinds(60, [&](int i) { return shoot(i, runners(count, i)); });
  }
}

TEST(FrameDifference, AreasFindWhatTheFrameFindsWhereThingsMeetAndPart) {
  expectAreasFindWhatFrameFinds(70, [](int i) {
    return shoot(i,
                 {{10 + 3 * i, 60, 24, 30}, {206 - 3 * i, 66, 24, 30}, {100, 170 - 2 * i, 20, 20}});
  });
}

TEST(FrameDifference, AreasFindWhatTheFrameFindsWhereThingsJumpAppearAndStop) {
  expectAreasFindWhatFrameFinds(80, [](int i) {
    std::vector<Box> things{{i / 10 * 53 % 200, i / 10 * 31 % 140, 30, 30}};
    if (i > 25) things.push_back({std::min(3 * (i - 25), 90), 80, 22, 40});
    return shoot(i, things);
  });
}

TEST(FrameDifference, AreasFindWhatTheFrameFindsInNoiseCheckersAndLightSwitches) {
  std::mt19937 random(7);
  expectAreasFindWhatFrameFinds(24, [&](int i) -> std::shared_ptr<const Picture> {
    if (i % 8 == 3)
      return makePicture(kSize, [&](int, int) {
        const auto bits = random();
        return Rgb{static_cast<uint8_t>(bits), static_cast<uint8_t>(bits >> 8),
                   static_cast<uint8_t>(bits >> 16)};
      });
    if (i % 8 == 5)
      return makePicture(kSize, [&](int x, int y) {
        const auto level = static_cast<uint8_t>((x + y + i) % 2 * 255);
        return Rgb{level, level, level};
      });
    return shoot(i, runners(4, i), kSize, i > 16 ? 128 : 256);
  });
}

TEST(FrameDifference, AreasFindWhatTheFrameFindsWithEveryInterval) {
  for (const int interval : {1, 2, 7, 64}) {
    SCOPED_TRACE("interval " + std::to_string(interval));
    background::Params params = paramsFor(background::SearchScope::Frame);
    params.searchInterval = interval;
    params.thresholdFrom = interval == 7 ? background::ThresholdSource::Frame
                                         : background::ThresholdSource::Difference;
    expectAreasFindWhatFrameFinds(
        30, [&](int i) { return shoot(i, runners(6, i)); }, params);
  }
}

TEST(FrameDifference, AreasFindWhatTheFrameFindsInFramesOfAnySize) {
  for (const Size size : {Size{1, 1}, {1, 40}, {40, 1}, {7, 9}, {17, 33}, {65, 31}, {257, 19}}) {
    SCOPED_TRACE(std::to_string(size.width) + "x" + std::to_string(size.height));
    expectAreasFindWhatFrameFinds(12, [&](int i) {
      return shoot(i, {{3 * i % size.width, 2 * i % size.height, 12, 12}}, size);
    });
    expectAreasFindWhatFrameFinds(6, [&](int i) {
      return makeGreyPicture(size, [&](int x, int y) {
        return mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y),
                       static_cast<uint32_t>(i)) %
               256;
      });
    });
  }
}

TEST(FrameDifference, FindsEachThingOnceAndWhole) {
  for (const int count : {1, 3, 5}) {
    Camera camera;
    camera.showFor(20, {});
    for (int i = 0; i < 40; ++i) {
      std::vector<Box> things;
      for (int k = 0; k < count; ++k) things.push_back({10 + 3 * i, 4 + 36 * k, 20, 16});
      const auto found = camera.show(things);
      if (i < 2) continue;
      ASSERT_EQ(found->areas.size(), things.size()) << "frame " << i;
      for (size_t k = 0; k < things.size(); ++k) {
        const Box common = intersect(found->areas[k], things[k]);
        // The place that it has just left has changed as well.
        EXPECT_GE(common.area() * 100, 95 * things[k].area());
        EXPECT_LE(found->areas[k].area() * 100, 145 * things[k].area());
      }
    }
  }
}

TEST(FrameDifference, JoinsThingsThatTouchAndPartsThemAgain) {
  Camera camera;
  camera.showFor(20, {});
  std::vector<size_t> counts;
  for (int i = 0; i < 44; ++i)
    counts.push_back(
        camera.show({{10 + 4 * i, 60, 24, 30}, {200 - 4 * i, 64, 24, 30}})->areas.size());
  EXPECT_EQ(counts[5], 2u);
  EXPECT_EQ(counts[23], 1u);
  EXPECT_EQ(counts[42], 2u);
}

TEST(FrameDifference, RemembersAThingThatStopsUntilItsTimeIsOver) {
  background::Params params = paramsFor(background::SearchScope::Areas);
  params.absorbTimeS = 2;
  Camera camera(params);
  camera.showFor(20, {});
  for (int i = 0; i < 25; ++i) camera.show({{5 + 4 * i, 60, 24, 40}});
  const Box stopped{101, 60, 24, 40};
  const auto held = camera.showFor(40, {stopped});
  ASSERT_EQ(held->areas.size(), 1u);
  EXPECT_GE(intersect(held->areas[0], stopped).area() * 100, 95 * stopped.area());
  EXPECT_TRUE(camera.showFor(20, {stopped})->areas.empty());
}

TEST(FrameDifference, LeavesNoGhostWhereAThingStood) {
  Camera camera;
  const Box stood{100, 60, 24, 40};
  camera.showFor(30, {stood});
  for (int i = 0; i < 30; ++i) camera.show({{stood.x + 4 * i, stood.y, stood.width, stood.height}});
  EXPECT_TRUE(camera.showFor(12, {})->areas.empty());
}

TEST(FrameDifference, ForgetsAThingThatIsGone) {
  Camera camera;
  camera.showFor(20, {});
  for (int i = 0; i < 20; ++i) camera.show({{5 + 4 * i, 60, 24, 40}});
  EXPECT_EQ(camera.show(std::vector<Box>{})->areas.size(), 1u);  // It changed: it went.
  EXPECT_TRUE(camera.showFor(2, {})->areas.empty());
}

TEST(FrameDifference, IsNotDeceivedByNoiseOrByALamp) {
  Camera camera;
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(camera.show(std::vector<Box>{})->areas.empty());
  const std::vector<Box> lamp{{50, 50, 30, 30}};
  camera.showFor(12, lamp);
  EXPECT_TRUE(camera.showFor(5, lamp)->areas.empty());
}

TEST(FrameDifference, TellsALightSwitchAndGoesOn) {
  Camera camera;
  camera.showFor(40, {});
  const auto dark = camera.show(std::vector<Box>{}, 128);
  EXPECT_EQ(dark->scene.event, background::SceneEvent::LightSwitched);
  EXPECT_TRUE(dark->areas.empty());
  for (int i = 0; i < 6; ++i) camera.show({{20 + 4 * i, 60, 24, 40}}, 128);
  EXPECT_GE(camera.show({{48, 60, 24, 40}}, 128)->areas.size(), 1u);
}

TEST(FrameDifference, KeepsItsMemoryOverAGap) {
  Camera camera;
  camera.showFor(20, {});
  for (int i = 0; i < 20; ++i) camera.show({{5 + 4 * i, 60, 24, 40}});
  camera.stage().reset(Reset::Gap);
  EXPECT_EQ(camera.show({{81, 60, 24, 40}})->areas.size(), 1u);
}

TEST(FrameDifference, StartsAnewAfterAnotherStream) {
  Camera camera;
  camera.showFor(20, {});
  camera.stage().reset(Reset::Stream);
  const auto first = camera.show(shoot(0, {{10, 10, 30, 30}}, {64, 48}));
  EXPECT_EQ(first->status, Status::Training);
  EXPECT_TRUE(first->areas.empty());
}

}  // namespace
}  // namespace rg
