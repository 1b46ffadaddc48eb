// SPDX-License-Identifier: LGPL-2.1-or-later
// Scenes that core's model has learnt, and the model in memory as a device has it.
#pragma once

#include "core/background/models/consensus_background.hpp"
#include "kernels/consensus_background.hpp"
#include "tests/kernels/parity.hpp"
#include "tests/kernels/pictures.hpp"

#include <utility>

namespace rg::test {

/// A model on the device, with core's contents or empty.
struct DeviceModel {
  Plane<uint8_t> samples, noise, unrest;
  int channels;
  DeviceModel(Size size, int count)
      : samples(
            {gpu::wordsOf(size.width) * kWordColumns * background::kSamples * count, size.height}),
        noise(size),
        unrest(size),
        channels(count) {}
  explicit DeviceModel(const background::ConsensusBackground& from)
      : samples(from.samples.view()),
        noise(from.noise.view()),
        unrest(from.unrest.view()),
        channels(from.channels) {}
  gpu::background::ModelView view() {
    return {noise.view().size, channels, samples, noise, unrest};
  }
  void expect(const background::ConsensusBackground& expected) {
    noise.expect(expected.noise.view(), "noise");
    unrest.expect(expected.unrest.view(), "unrest");
    samples.expect(expected.samples.view(), "samples");
  }
};

/// A scene that core has learnt for some frames, and the next frame's picture and verdicts.
struct LearntScene {
  Picture picture;
  background::SmoothPicture smooth;
  background::ConsensusBackground model;
  background::Verdicts verdicts;
  BitMask mask, near, previousRaw;
  uint32_t frame = 0;

  LearntScene(Size size, int fill, bool isGrey, int frames) : mask(size), previousRaw(size) {
    loadScene(size, fill, 0, isGrey, picture);
    background::smooth(picture, oneThread(), smooth);
    background::prepare(size, isGrey ? 1 : 3, model);
    background::fillFrom(smooth, oneThread(), model);
    previousRaw.clear();
    for (int i = 1; i <= frames; ++i) {
      if (i > 1) {
        background::learn(smooth, {mask, near, verdicts.raw, mask, previousRaw}, {frame, 2, false},
                          oneThread(), model);
        std::swap(verdicts.raw, previousRaw);
      }
      frame = static_cast<uint32_t>(i);
      loadScene(size, fill, i, isGrey, picture);
      background::smooth(picture, oneThread(), smooth);
      background::judge(smooth, model, {5, 20}, oneThread(), verdicts);
      mask = scattered(size, frame);
      near = scattered(size, frame);
    }
  }
};

template <class Check>
void forScenes(int frames, const Check& check) {
  forSizesAndFills([&](Size size, int fill) {
    for (const bool isGrey : {false, true}) {
      SCOPED_TRACE(isGrey ? "grey" : "colour");
      check(LearntScene(size, fill, isGrey, frames));
    }
  });
}

}  // namespace rg::test
