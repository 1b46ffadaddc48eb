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
  void forget() { images_.known.fill(0); }
  void learn(const ColourPlanes& now, const Run& at);
  /// Sets out[x] to 255 where the scene is known and the picture differs from it by more than
  /// `threshold`.
  void addStrange(const ColourPlanes& now, const Run& at, int threshold, uint8_t* out) const {
    background::addStrange(now, planes(), at, threshold, images_.known.row(at.y) + at.begin, out);
  }

  [[nodiscard]] ColourPlanes planes() const;
  /// 255 where the scene has been seen, else 0.
  [[nodiscard]] ImageView<const uint8_t> known() const { return images_.known; }

  /// For who knows where the pixels are.
  struct Images {
    std::array<Image<uint8_t>, 3> seen;  ///< Green, red, blue; of grey pictures the first only.
    Image<uint8_t> known;
    int channels = 0;
  };
  [[nodiscard]] Images& images() { return images_; }
  [[nodiscard]] const Images& images() const { return images_; }

 private:
  Images images_;
};

}  // namespace rg::background
