// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/displaced_things.hpp"
#include "core/background/ghosts/ghosts.hpp"
#include "core/background/ghosts/mask_contour.hpp"
#include "core/background/ghosts/swaying_parts.hpp"
#include "tests/kernels/masks.hpp"
#include "tests/kernels/scenes.hpp"

#include <array>
#include <utility>
#include <vector>

namespace rg::test {
namespace {

using background::StillPixels;

/// What is known of still pixels, as a device has it.
struct DeviceStill {
  DevicePlanes colours;
  Plane<uint16_t> ages;
  Bits aged;
  Plane<uint8_t> fresh;
  explicit DeviceStill(const StillPixels& from, int channels)
      : colours(from.colours, channels),
        ages(from.ages.view()),
        aged(from.aged),
        fresh(from.fresh.view()) {}
  gpu::background::StillView view() { return {colours, ages, aged, fresh}; }
  void expect(const StillPixels& expected) {
    colours.expect(expected.colours, "kept colour");
    ages.expect(expected.ages.view(), "age");
    aged.expect(expected.aged, "aged");
    fresh.expect(expected.fresh.view(), "fresh");
  }
};

/// Ages of all sizes where `mask` is set, and places that are fresh.
StillPixels stillPixels(Size size, int channels, const BitMask& mask) {
  StillPixels still;
  background::prepare(size, channels, still);
  background::clear(still);
  for (int c = 0; c < channels; ++c)
    still.colours[static_cast<size_t>(c)].copyFrom(filled(size, 4).view());
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const uint32_t draw = hashOf(x / 9, y / 5, 31);
      if (mask.at(x, y))
        still.ages.at(x, y) = static_cast<uint16_t>(draw % 5 == 0   ? 65535
                                                    : draw % 5 == 1 ? 1
                                                                    : 3 + draw % 40);
      if (hashOf(x / 4, y / 4, 32) % 9 != 0) continue;
      still.fresh.at(x, y) = static_cast<uint8_t>(1 + draw % 250);
      uint8_t& most = still.freshRows[static_cast<size_t>(y)];
      most = std::max(most, still.fresh.at(x, y));
    }
  for (int y = 0; y < size.height; ++y)
    std::copy_n(mask.row(y), mask.wordsPerRow(), still.aged.row(y));
  return still;
}

/// The picture and the model are alike in places and differ in others, so that some parts are
/// ghosts and some are not.
template <class Check>
void forStill(const Check& check) {
  forScenes(3, [&](LearntScene scene) {
    const Size size = scene.smooth.size();
    const BitMask before = scattered(size, 40);
    const StillPixels still = stillPixels(size, scene.smooth.channels, before);
    check(scene, still, before);
  });
}

}  // namespace

void parity_followStill() {
  forStill([](LearntScene& scene, const StillPixels&, const BitMask& before) {
    const Size size = scene.smooth.size();
    for (const uint16_t mostAge : {uint16_t{4}, uint16_t{32768}, uint16_t{65535}}) {
      StillPixels expected = stillPixels(size, scene.smooth.channels, before);
      DeviceStill there(expected, scene.smooth.channels);
      DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
      DeviceModel model(scene.model);
      gpu::background::followStill(smooth, model.view(), {30, 20}, Bits(scene.mask), mostAge,
                                   there.view(), nullptr);
      background::followStill(scene.smooth, scene.model, {30, 20}, scene.mask, mostAge, oneThread(),
                              expected);
      there.expect(expected);
    }
  });
}

void parity_addAged() {
  forStill([](LearntScene& scene, const StillPixels& still, const BitMask& before) {
    for (const int leastAge : {2, 20, 65535}) {
      BitMask expected = scattered(before.size(), 50);
      Bits there(expected);
      DeviceStill ages(still, scene.smooth.channels);
      gpu::background::addAged(Bits(before), ages.view(), leastAge, there, nullptr);
      background::addAged(before, still, leastAge, expected);
      there.expect(expected, "aged");
    }
  });
}

void parity_findGhosts() {
  uint32_t ghostPixels = 0;
  forStill([&](LearntScene& scene, const StillPixels&, const BitMask& before) {
    const Size size = scene.smooth.size();
    for (const int leastAge : {1, 8}) {
      StillPixels expected = stillPixels(size, scene.smooth.channels, before);
      DeviceStill there(expected, scene.smooth.channels);
      DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
      DeviceModel model(scene.model);
      Bits still(size), ghosts(size);
      DeviceComponents parts(size);
      std::vector<background::ContourSums> contours(parts.runs.size());
      gpu::background::findGhosts(smooth, model.view(), Bits(before), there.view(), leastAge,
                                  {still, parts.view(), contours.data()}, ghosts, nullptr);
      background::StillScratch scratch;
      BitMask expectedGhosts(size);
      background::findGhosts(scene.smooth, scene.model, before, expected, leastAge, scratch,
                             expectedGhosts);
      ghosts.expect(expectedGhosts, "ghosts");
      there.expect(expected);
      ghostPixels += countSet(expectedGhosts);
    }
  });
  EXPECT_GT(ghostPixels, 0u);
}

void parity_addDisplaced() {
  uint32_t displacedPixels = 0;
  // Parts of at least 30 pixels, more of them than are looked at.
  for (const Size size : {Size{31, 9}, Size{131, 67}, Size{257, 90}})
    for (const int fill : {4, 5}) {
      SCOPED_TRACE(std::to_string(size.width) + ", fill " + std::to_string(fill));
      LearntScene scene(size, fill, false, 2);
      BitMask mask(size);
      mask.clear();
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
          if (x % 12 < 10 && y % 8 < 6 && hashOf(x / 12, y / 8, 60) % 4 != 0) mask.set(x, y);
      const StillPixels still = stillPixels(size, 3, mask);
      DeviceStill there(still, 3);
      DevicePlanes smooth(scene.smooth.planes, 3);
      DeviceModel model(scene.model);
      DeviceComponents parts(size);
      std::vector<uint32_t> stillPx(parts.runs.size(), 0xA5A5A5A5);
      std::vector<uint32_t> colours(2 * background::kMostDisplaced * background::kColours, 7);
      std::vector<uint32_t> shared(background::kMostDisplaced, 7);
      BitMask expected = scattered(size, 61);
      Bits moved(expected);
      gpu::background::addDisplaced(smooth, model.view(), Bits(mask), there.view(), 3,
                                    {parts.view(), stillPx.data(), colours.data(), shared.data()},
                                    moved, nullptr);
      background::DisplacedScratch scratch;
      background::addDisplaced(scene.smooth, scene.model, mask, still, 3, scratch, expected);
      moved.expect(expected, "displaced");
      displacedPixels += countSet(expected) - countSet(scattered(size, 61));
    }
  EXPECT_GT(displacedPixels, 0u);
}

void parity_growFaint() {
  uint32_t grownPixels = 0;
  forScenes(3, [&](LearntScene scene) {
    const Size size = scene.smooth.size();
    std::array<Image<uint8_t>, 3> shown{Image<uint8_t>(size), Image<uint8_t>(size),
                                        Image<uint8_t>(size)};
    const BitMask faint = scattered(size, 70);
    Bits there(scene.mask), near(size), candidates(size), across(size);
    DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
    DeviceModel model(scene.model);
    gpu::background::growFaint(smooth, model.view(), Bits(faint), {near, candidates, across}, there,
                               nullptr);
    background::CleaningScratch cleaning;
    background::ContourScratch scratch;
    grownPixels -= countSet(scene.mask);
    background::growFaint({scene.smooth, scene.model, faint, shown}, oneThread(), cleaning, scratch,
                          scene.mask);
    there.expect(scene.mask, "grown");
    grownPixels += countSet(scene.mask);
  });
  EXPECT_GT(grownPixels, 0u);
}

void parity_dropSwaying() {
  uint32_t droppedPixels = 0, keptPixels = 0;
  forScenes(3, [&](LearntScene scene) {
    const Size size = scene.smooth.size();
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        scene.model.unrest.at(x, y) = static_cast<uint8_t>((7 * x + y) % 256 >> x / 16 % 2 * 4);
    for (const background::Tolerance tolerance : {background::Tolerance{0, 0}, {10, 20}})
      for (const int share : {30, 60}) {
        BitMask expected = scattered(size, share);
        Bits there(expected), restless(size);
        DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
        DeviceModel model(scene.model);
        DeviceComponents parts(size);
        std::vector<background::PartCount> counts(parts.runs.size(), {9, 9, 9});
        gpu::background::dropSwaying(smooth, model.view(), tolerance,
                                     {restless, parts.view(), counts.data()}, there, nullptr);
        background::SwayScratch scratch;
        background::dropSwaying(scene.smooth, scene.model, tolerance, scratch, expected);
        there.expect(expected, "without what sways");
        droppedPixels += countSet(scattered(size, share)) - countSet(expected);
        keptPixels += countSet(expected);
      }
  });
  EXPECT_GT(droppedPixels, 0u);
  EXPECT_GT(keptPixels, 0u);
}

void compareBorders(background::BorderLayer layer) {
  uint32_t trimmedPixels = 0;
  forScenes(3, [&](LearntScene scene) {
    const Size size = scene.smooth.size();
    for (const background::Tolerance tolerance : {background::Tolerance{0, 0}, {10, 20}}) {
      BitMask expected = maskOf(size, 6);
      Bits there(expected), out(size);
      DevicePlanes smooth(scene.smooth.planes, scene.smooth.channels);
      DeviceModel model(scene.model);
      std::array<Image<uint8_t>, 3> painted;
      background::paintModel(scene.model, oneThread(), painted);
      DevicePlanes shown(painted, scene.model.channels);
      gpu::background::trimBorder(
          {planesOf(scene.picture), smooth.planes[0], model.view(), shown, tolerance}, layer, there,
          out, nullptr);
      background::ContourScratch scratch;
      background::trimBorder({scene.picture, scene.smooth, scene.model, painted, tolerance}, layer,
                             oneThread(), scratch, expected);
      out.expect(expected, "trimmed");
      trimmedPixels += countSet(maskOf(size, 6)) - countSet(expected);
    }
  });
  EXPECT_GT(trimmedPixels, 0u);
}

void parity_trimBorder() {
  compareBorders(background::BorderLayer::DrawnIn);
  compareBorders(background::BorderLayer::Blurred);
}

}  // namespace rg::test
