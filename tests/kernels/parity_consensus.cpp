// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/kernels/parity.hpp"
#include "tests/kernels/scenes.hpp"

namespace rg::test {
using background::ConsensusBackground;
using background::SmoothPicture;

void parity_smooth() {
  forScenes(1, [](const LearntScene& scene) {
    DevicePlanes out(scene.smooth.size(), scene.smooth.channels);
    gpu::background::smooth(planesOf(scene.picture), out, nullptr);
    out.expect(scene.smooth.planes, "smooth");
  });
}

void parity_fillFrom() {
  forScenes(1, [](const LearntScene& scene) {
    ConsensusBackground expected;
    background::prepare(scene.smooth.size(), scene.smooth.channels, expected);
    background::fillFrom(scene.smooth, oneThread(), expected);
    DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
    DeviceModel model(scene.smooth.size(), scene.smooth.channels);
    gpu::background::fillFrom(smooth, model.view(), nullptr);
    model.expect(expected);
  });
}

void parity_judge() {
  forScenes(3, [](const LearntScene& scene) {
    DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
    DeviceModel model(scene.model);
    for (const background::Tolerance tolerance :
         {background::Tolerance{5, 20}, {0, 0}, {200, 255}}) {
      background::Verdicts expected;
      background::judge(scene.smooth, scene.model, tolerance, oneThread(), expected);
      const Size size = scene.smooth.size();
      Bits raw(size), strong(size), faint(size);
      gpu::background::judge(smooth, model.view(), tolerance, {raw, strong, faint}, nullptr);
      raw.expect(expected.raw, "raw");
      strong.expect(expected.strong, "strong");
      faint.expect(expected.faint, "faint");
    }
  });
}

void parity_smoothAndJudge() {
  forScenes(3, [](const LearntScene& scene) {
    DeviceModel model(scene.model);
    const Size size = scene.smooth.size();
    for (const background::Tolerance tolerance : {background::Tolerance{5, 20}, {200, 255}}) {
      SmoothPicture expected;
      background::Verdicts verdicts;
      background::smoothAndJudge(scene.picture, scene.model, tolerance, oneThread(),
                                 {expected, verdicts});
      DevicePlanes smooth(size, scene.smooth.channels);
      Bits raw(size), strong(size), faint(size);
      gpu::background::smoothAndJudge(planesOf(scene.picture), model.view(), tolerance,
                                      {smooth, {raw, strong, faint}}, nullptr);
      smooth.expect(expected.planes, "smooth");
      raw.expect(verdicts.raw, "raw");
      strong.expect(verdicts.strong, "strong");
      faint.expect(verdicts.faint, "faint");
    }
  });
}

void parity_learn() {
  for (const background::ConsensusRate rate :
       {background::ConsensusRate{16, 2, false}, {8, 3, true}, {1001, 16, false, 38}})
    forScenes(4, [&](LearntScene scene) {
      DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
      for (int y = 0; y < scene.model.unrest.height(); ++y)
        for (int x = 0; x < scene.model.unrest.width(); x += 3)
          scene.model.unrest.at(x, y) = static_cast<uint8_t>(hashOf(x, y, 5));
      DeviceModel model(scene.model);
      Bits mask(scene.mask), near(scene.near), raw(scene.verdicts.raw), before(scene.previousRaw);
      gpu::background::learn(smooth, {mask, near, raw, mask, before}, rate, model.view(), nullptr);
      background::learn(scene.smooth,
                        {scene.mask, scene.near, scene.verdicts.raw, scene.mask, scene.previousRaw},
                        rate, oneThread(), scene.model);
      model.expect(scene.model);
    });
}

void parity_replaceWhere() {
  forScenes(2, [](LearntScene scene) {
    DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
    DeviceModel model(scene.model);
    gpu::background::replaceWhere(Bits(scene.mask), smooth, model.view(), nullptr);
    background::replaceWhere(scene.mask, scene.smooth, oneThread(), scene.model);
    model.expect(scene.model);
  });
}

void parity_paintModel() {
  forScenes(4, [](const LearntScene& scene) {
    std::array<Image<uint8_t>, 3> expected;
    background::paintModel(scene.model, oneThread(), expected);
    DeviceModel model(scene.model);
    DevicePlanes out(scene.smooth.size(), scene.model.channels);
    gpu::background::paintModel(model.view(), out, nullptr);
    out.expect(expected, "model");
  });
}

void parity_paintModelAt() {
  forScenes(4, [](const LearntScene& scene) {
    const Size size = scene.smooth.size();
    BitMask places(size);
    places.clear();
    for (int y = 0; y < size.height; y += 3)
      places.set(hashOf(y, 0, 1) % 2 == 0 ? 0 : size.width - 1, y);
    std::array<Image<uint8_t>, 3> expected{Image<uint8_t>(size), Image<uint8_t>(size),
                                           Image<uint8_t>(size)};
    for (Image<uint8_t>& plane : expected) plane.fill(0xA5);
    background::paintModelAt(places, scene.model, oneThread(), expected);
    DeviceModel model(scene.model);
    DevicePlanes out(size, scene.model.channels);
    gpu::background::paintModelAt(Bits(places), model.view(), out, nullptr);
    out.expect(expected, "model");
  });
}

}  // namespace rg::test
