// SPDX-License-Identifier: LGPL-2.1-or-later
// What bgremove makes of scenes that change as a whole, and of people who stop.
#include "tests/core/staged_scene.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace rg {
namespace {

using test::marksOf;
using test::Stage;
using test::StagedScene;
using test::Take;
using test::Texture;
using test::walkerAt;

std::vector<Stage> stages() {
  std::vector<Stage> all;
  for (const Texture texture : {Texture::Tiles, Texture::Stone, Texture::Ramp, Texture::Stripes})
    for (const int noise : {1, 3, 7})
      all.push_back({texture, noise, static_cast<uint32_t>(all.size() + 1)});
  return all;
}

class SceneChanges : public ::testing::TestWithParam<Stage> {};
INSTANTIATE_TEST_SUITE_P(Stages, SceneChanges, ::testing::ValuesIn(stages()));

/// 3 s after the light has changed, with a walker who never stops.
void expectRecovered(StagedScene& scene, int gainPercent) {
  std::shared_ptr<const background::Foreground> last;
  for (int i = 0; i < 76; ++i) last = scene.show({walkerAt(i % 60), gainPercent, {}, false});
  const auto marks = marksOf(*last, walkerAt(75 % 60));
  EXPECT_LT(marks.falsePercent, 2) << "gain " << gainPercent;
  EXPECT_GE(marks.foundPercent, 80) << "gain " << gainPercent;
}

TEST_P(SceneChanges, ALightSwitchLeavesNoFalseForegroundAfterThreeSeconds) {
  StagedScene scene(GetParam());
  scene.showFor(100, {{}, 40, {}, false});
  expectRecovered(scene, 100);
  expectRecovered(scene, 40);
}

TEST_P(SceneChanges, AStoppedPersonStaysForAbsorbTimeThenFadesAndLeavesNoGhost) {
  background::Params params;
  params.absorbTimeS = 5;
  StagedScene scene(GetParam(), params);
  scene.showFor(75, {});
  for (int i = 0; i < 25; ++i) scene.show({walkerAt(i), 100, {}, false});
  const auto stopped = walkerAt(25);
  EXPECT_GE(marksOf(*scene.showFor(110, {stopped, 100, {}, false}), stopped).foundPercent, 90);
  EXPECT_EQ(scene.showFor(65, {stopped, 100, {}, false})->scene.foregroundPx, 0u);
  for (int i = 25; i < 50; ++i) scene.show({walkerAt(i), 100, {}, false});
  for (int i = 50; i < 60; ++i) scene.show({walkerAt(i), 100, {}, false});
  const auto marks = marksOf(*scene.show({walkerAt(60), 100, {}, false}), walkerAt(60));
  EXPECT_GE(marks.foundPercent, 90);
  EXPECT_LT(marks.falsePercent, 0.1);
}

/// From the first frame on: a thing differs as little as all else does, so that grey levels alone
/// don't tell how little is noise.
TEST(WeakContrast, AWalkerIsFoundInFogAndAtNight) {
  for (const Texture texture : {Texture::Tiles, Texture::Stone, Texture::Ramp, Texture::Stripes})
    for (const Take& weather : {Take{{}, 100, {}, false, 70}, Take{{}, 25, {}, false, 0}}) {
      SCOPED_TRACE(weather.fogPercent > 0 ? "fog" : "night");
      StagedScene scene({texture, 1, 5});
      scene.showFor(25, weather);
      int found = 0;
      double wrong = 0;
      constexpr int kSteps = 50;
      for (int i = 0; i < kSteps; ++i) {
        Take take = weather;
        take.walker = walkerAt(i);
        const auto marks = marksOf(*scene.show(take), take.walker);
        found += marks.foundPercent;
        wrong += marks.falsePercent;
      }
      EXPECT_GE(found, 85 * kSteps) << "texture " << static_cast<int>(texture);
      EXPECT_LT(wrong, 0.1 * kSteps) << "texture " << static_cast<int>(texture);
    }
}

Box seenFrom(const Point& push, const Box& box) {
  return {box.x - push.x, box.y - push.y, box.width, box.height};
}

TEST_P(SceneChanges, AShakenCameraDoesNotFloodTheMask) {
  StagedScene scene(GetParam());
  scene.showFor(100, {});
  int told = 0, followed = 0;
  for (int i = 0; i < 60; ++i) {
    const auto dice = static_cast<int>(mixHash(static_cast<uint32_t>(i), 7, 7) >> 8);
    const Point push{dice % 7 - 3, dice / 7 % 7 - 3};
    const auto foreground = scene.show({walkerAt(i), 100, push, false});
    const auto marks = marksOf(*foreground, seenFrom(push, walkerAt(i)));
    EXPECT_LT(marks.falsePercent, 1) << "frame " << i;
    EXPECT_GE(marks.foundPercent, 80) << "frame " << i;
    told += foreground->scene.event == background::SceneEvent::CameraShaken;
    EXPECT_FALSE(background::isAnotherView(foreground->scene.event));
    // A pixel's shift may do no harm, so that nobody looks for it.
    const Point seen = foreground->scene.shift;
    EXPECT_TRUE(GetParam().texture > Texture::Stone || seen == push || seen == Point{});
    followed += seen == push;
  }
  EXPECT_TRUE(GetParam().texture > Texture::Stone || followed >= 40);
  // A ramp looks nearly the same from everywhere.
  EXPECT_LE(told, 1);
  EXPECT_TRUE(GetParam().texture == Texture::Ramp || told == 1);
}

/// On a pole in the wind, from the first frame on: farther than is looked for at once.
TEST(Sway, ACameraIsFollowedAsFarAsItGoes) {
  for (const Texture texture : {Texture::Tiles, Texture::Stone})
    for (const int noise : {1, 3, 7}) {
      SCOPED_TRACE("texture " + std::to_string(static_cast<int>(texture)) + ", noise " +
                   std::to_string(noise));
      StagedScene scene({texture, noise, 5});
      Point home;  // Of the model: where the camera was in one of the first frames.
      int followed = 0;
      constexpr int kFirst = 25, kFrames = 125;
      for (int i = 0; i < kFrames; ++i) {
        const double phase = .4 * i;
        const Point push{static_cast<int>(std::lround(6 * std::sin(phase))),
                         static_cast<int>(std::lround(2 * std::sin(.7 * phase)))};
        const Take take{i < kFirst ? std::nullopt : std::optional{walkerAt(i % 60)}, 100, push};
        const auto foreground = scene.show(take);
        const Point shift = foreground->scene.shift;
        if (i < kFirst) {
          home = {push.x - shift.x, push.y - shift.y};
          continue;
        }
        const auto marks = marksOf(*foreground, seenFrom(push, *take.walker));
        EXPECT_LT(marks.falsePercent, 1) << "frame " << i;
        EXPECT_GE(marks.foundPercent, 80) << "frame " << i;
        EXPECT_FALSE(background::isAnotherView(foreground->scene.event));
        followed += shift == Point{push.x - home.x, push.y - home.y};
      }
      EXPECT_GE(followed, 90);
    }
}

/// Nobody has seen it at rest.
TEST(Sway, IsToldOfACameraThatSwaysFromTheFirstFrame) {
  for (const Texture texture : {Texture::Tiles, Texture::Stone}) {
    StagedScene scene({texture, 3, 5});
    int told = 0;
    for (int i = 0; i < 125; ++i) {
      const Point push{static_cast<int>(std::lround(6 * std::sin(.4 * i))), 0};
      told += scene.show({{}, 100, push})->scene.event == background::SceneEvent::CameraShaken;
    }
    EXPECT_EQ(told, 1) << "texture " << static_cast<int>(texture);
  }
}

TEST(Sway, APushOutOfRestIsFollowedBeyondWhatIsLookedAtFirst) {
  StagedScene scene({Texture::Tiles, 3, 5});
  scene.showFor(100, {});
  int told = 0;
  for (int i = 0; i < 20; ++i) {
    const Point push{i % 4 < 2 ? 7 : -6, i % 4 < 2 ? 4 : -5};
    const auto foreground = scene.show({walkerAt(i), 100, push});
    const auto marks = marksOf(*foreground, seenFrom(push, walkerAt(i)));
    EXPECT_EQ(foreground->scene.shift, push) << "frame " << i;
    EXPECT_LT(marks.falsePercent, 1) << "frame " << i;
    EXPECT_GE(marks.foundPercent, 80) << "frame " << i;
    told += foreground->scene.event == background::SceneEvent::CameraShaken;
  }
  EXPECT_EQ(told, 1);
}

TEST_P(SceneChanges, ACameraThatWasTurnedStartsAnew) {
  StagedScene scene(GetParam());
  scene.showFor(100, {});
  const Point push{410, 303};  // Half of a period of the stripes: none of their places is near.
  int told = 0;
  std::shared_ptr<const background::Foreground> last;
  for (int i = 0; i < 130; ++i) {
    last = scene.show({seenFrom({-push.x, -push.y}, walkerAt(i % 60)), 100, push, false});
    told += background::isAnotherView(last->scene.event);
  }
  // On fine grain what is left of the old scene goes as ghosts before there is something to tell.
  EXPECT_LE(told, 1);
  EXPECT_TRUE(told == 1 || GetParam().texture == Texture::Stone);
  const auto marks = marksOf(*last, walkerAt(129 % 60));
  EXPECT_LT(marks.falsePercent, 2);
  EXPECT_GE(marks.foundPercent, 80);
}

TEST_P(SceneChanges, InTheDarkNothingIsFoundAndNothingForgotten) {
  StagedScene scene(GetParam());
  scene.showFor(100, {});
  EXPECT_EQ(scene.show({{}, 2, {}, false})->scene.event, background::SceneEvent::TooDark);
  const auto dark = scene.showFor(200, {walkerAt(10), 2, {}, false});
  EXPECT_TRUE(dark->scene.isDark);
  EXPECT_EQ(dark->scene.event, background::SceneEvent::None);
  EXPECT_EQ(dark->scene.foregroundPx, 0u);
  const auto bright = scene.show({walkerAt(20), 100, {}, false});
  EXPECT_EQ(bright->scene.event, background::SceneEvent::BrightAgain);
  EXPECT_FALSE(bright->scene.isDark);
  EXPECT_GE(marksOf(*bright, walkerAt(20)).foundPercent, 90);
  EXPECT_LT(marksOf(*bright, walkerAt(20)).falsePercent, 1);
}

TEST_P(SceneChanges, AStreamThatStartsInTheDarkLearnsWhenItIsBright) {
  StagedScene scene(GetParam());
  const auto dark = scene.showFor(50, {{}, 2, {}, false});
  EXPECT_EQ(dark->status, Status::Training);
  EXPECT_TRUE(dark->scene.isDark);
  EXPECT_EQ(scene.show({})->scene.event, background::SceneEvent::BrightAgain);
  scene.showFor(60, {});
  const auto marks = marksOf(*scene.show({walkerAt(9), 100, {}, false}), walkerAt(9));
  EXPECT_GE(marks.foundPercent, 90);
  EXPECT_LT(marks.falsePercent, 1);
}

TEST_P(SceneChanges, NightViewAndBackAreToldAndFollowed) {
  StagedScene scene(GetParam());
  scene.showFor(100, {});
  for (const bool isGrey : {true, false}) {
    int told = 0;
    std::shared_ptr<const background::Foreground> last;
    for (int i = 0; i < 76; ++i) {
      last = scene.show({walkerAt(i % 60), isGrey ? 120 : 100, {}, isGrey});
      told += last->scene.event == background::SceneEvent::ColourSwitched;
    }
    EXPECT_EQ(told, 1);
    EXPECT_LT(marksOf(*last, walkerAt(75 % 60)).falsePercent, 2);
    EXPECT_GE(marksOf(*last, walkerAt(75 % 60)).foundPercent, 80);
  }
}

}  // namespace
}  // namespace rg
