// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/light/exposure.hpp"
#include "core/background/light/light_switch.hpp"
#include "core/background/scene_watch.hpp"
#include "kernels/exposure.hpp"
#include "kernels/light_switch.hpp"
#include "kernels/scene_watch.hpp"
#include "tests/kernels/masks.hpp"
#include "tests/kernels/scenes.hpp"

#include <array>

namespace rg::test {

void parity_countLit() {
  forScenes(1, [](const LearntScene& scene) {
    DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
    for (const int level : {0, 12, 200}) {
      const background::LitPoints expected = background::countLit(scene.smooth, level);
      background::LitPoints points;
      gpu::background::countLit(smooth, level, &points, nullptr);
      ASSERT_EQ(points.all, expected.all);
      ASSERT_EQ(points.bright, expected.bright);
      ASSERT_EQ(points.lit, expected.lit);
      ASSERT_EQ(points.dim, expected.dim);
    }
  });
}

void parity_countVivid() {
  forScenes(2, [](const LearntScene& scene) {
    if (scene.smooth.channels == 1) return;
    DevicePlanes smooth(scene.smooth.planes, 3);
    DeviceModel model(scene.model);
    const background::VividPoints expected = background::countVivid(scene.smooth, scene.model);
    background::VividPoints points;
    gpu::background::countVivid(smooth, model.view(), &points, nullptr);
    ASSERT_EQ(points.all, expected.all);
    ASSERT_EQ(points.now, expected.now);
    ASSERT_EQ(points.before, expected.before);
  });
}

void parity_sumShifted() {
  forScenes(2, [](const LearntScene& scene) {
    DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
    DeviceModel model(scene.model);
    for (const Point wanted : {Point{}, Point{2, -9}, Point{-99, 99}}) {
      const Point centre = background::centreWithin(wanted, scene.smooth.size());
      const background::ShiftedSums expected =
          background::sumShifted(scene.smooth, scene.model, centre);
      background::ShiftedSums sums;
      gpu::background::sumShifted(smooth, model.view(), centre, &sums, nullptr);
      for (int i = 0; i < background::ShiftedSums::kShifts; ++i)
        ASSERT_EQ(sums.off[i], expected.off[i]) << i;
      ASSERT_EQ(sums.unmoved, expected.unmoved);
    }
  });
}

void parity_countFullFields() {
  forMasks([](const BitMask& mask) {
    int full = -1;
    gpu::background::countFullFields(Bits(mask), &full, nullptr);
    ASSERT_EQ(full, background::countFullFields(mask));
  });
}

void parity_shiftPicture() {
  forScenes(1, [](const LearntScene& scene) {
    for (const Point shift : {Point{0, 0}, Point{3, -2}, Point{-1, 3}}) {
      background::SmoothPicture moved, spare;
      background::smooth(scene.picture, oneThread(), moved);
      background::shiftPicture(shift, oneThread(), spare, moved);
      DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
      DevicePlanes out(scene.smooth.size(), scene.smooth.channels);
      gpu::background::shiftPicture(shift, smooth, out, nullptr);
      out.expect(moved.planes, "shifted");
    }
  });
}

namespace {

/// Maps that raise, lower and turn levels round.
background::LevelMaps someMaps() {
  background::LevelMaps maps;
  for (size_t i = 0; i < 256; ++i) {
    maps[0][i] = static_cast<uint8_t>(i / 2);
    maps[1][i] = static_cast<uint8_t>(255 - i);
    maps[2][i] = static_cast<uint8_t>(i < 200 ? i + 55 : 255);
  }
  return maps;
}

}  // namespace

void parity_countApart() {
  const background::LevelMaps maps = someMaps();
  forScenes(2, [&](const LearntScene& scene) {
    std::array<Image<uint8_t>, 3> shown;
    background::paintModel(scene.model, oneThread(), shown);
    DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
    DevicePlanes model(shown, scene.smooth.channels);
    for (const background::Tolerance tolerance : {background::Tolerance{5, 20}, {80, 0}}) {
      uint32_t pixels = 0xA5A5A5A5;
      gpu::background::countApart({model, smooth}, maps, DeviceModel(scene.model).view(), tolerance,
                                  &pixels, nullptr);
      ASSERT_EQ(pixels, background::countApart(shown, scene.smooth, maps, scene.model, tolerance));
    }
  });
}

void parity_relight() {
  const background::LevelMaps maps = someMaps();
  forScenes(2, [&](LearntScene scene) {
    DeviceModel model(scene.model);
    gpu::background::relight(maps, model.view(), nullptr);
    background::relight(maps, oneThread(), scene.model);
    model.expect(scene.model);
  });
}

void parity_sumGains() {
  forScenes(2, [](const LearntScene& scene) {
    DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
    DeviceModel model(scene.model);
    const background::GainSums expected = background::sumGains(scene.smooth, scene.model);
    background::GainSums sums;
    gpu::background::sumGains(smooth, model.view(), &sums, nullptr);
    for (int i = 0; i < background::GainSums::kGains; ++i)
      ASSERT_EQ(sums.weight[i], expected.weight[i]) << i;
  });
}

void parity_mapLevels() {
  forScenes(1, [](const LearntScene& scene) {
    for (const background::LevelMap& map : someMaps()) {
      background::SmoothPicture mapped;
      background::smooth(scene.picture, oneThread(), mapped);
      background::mapLevels(map, oneThread(), mapped);
      DevicePlanes picture(scene.smooth.planes, scene.smooth.channels);
      gpu::background::mapLevels(map, picture, nullptr);
      picture.expect(mapped.planes, "mapped");
    }
  });
}

}  // namespace rg::test
