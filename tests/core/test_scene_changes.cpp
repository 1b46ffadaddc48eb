// SPDX-License-Identifier: LGPL-2.1-or-later
// What bgremove makes of scenes that change as a whole, and of people who stop.
#include "tests/core/staged_scene.hpp"

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
  std::shared_ptr<const Foreground> last;
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
  BackgroundParams params;
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

}  // namespace
}  // namespace rg
