// SPDX-License-Identifier: LGPL-2.1-or-later
// The scene as it looks without the things that move in it: the memory by which a thing that
// stopped is still seen, and a thing of one colour is seen whole (paper, section 2.1 and 4).
//
// Each pixel is taken over as it is whenever it is looked at and nothing is there: no model, no
// statistics. Determinism: per pixel.
#pragma once

#include "core/background/changed_pixels.hpp"
#include "core/base/geometry.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"

#include <array>
#include <cstdint>

namespace rg::background {

class SceneMemory {
 public:
  /// Allocates for such pictures; a picture of another kind forgets everything.
  void prepare(const Picture& picture);
  void forget() { known_.fill(0); }
  void learn(const ColourPlanes& now, const Run& at);
  /// Sets out[x] to 255 where the scene is known and the picture differs from it by more than
  /// `threshold`.
  void addStrange(const ColourPlanes& now, const Run& at, int threshold, uint8_t* out) const {
    background::addStrange(now, planes(), at, threshold, known_.row(at.y) + at.begin, out);
  }

  [[nodiscard]] ColourPlanes planes() const;
  /// 255 where the scene has been seen, else 0.
  [[nodiscard]] ImageView<const uint8_t> known() const { return known_; }

 private:
  int channels_ = 0;
  std::array<Image<uint8_t>, 3> seen_;  ///< Green, red, blue; of grey pictures the first only.
  Image<uint8_t> known_;
};

}  // namespace rg::background
