// SPDX-License-Identifier: LGPL-2.1-or-later
// What moves in a made-up scene: people, cars and plain shapes of two or three colours.
#pragma once

#include "tests/accuracy/canvas.hpp"
#include "tests/accuracy/dice.hpp"

namespace rg::truth {

enum class Shape { Person, Car, Block, Ball, Diamond, Corner };
inline constexpr int kShapes = 6;

/// What a sprite is drawn from, at any scale.
struct Model {
  Shape shape = Shape::Block;
  int height = 0;  ///< Of its body, in pixels of the plan.
  std::array<Rgb, 3> colours{};
  uint32_t grain = 0;
};

/// Seen from its upper left corner. A margin of one pixel is empty.
struct Sprite {
  Model model;
  Size size;
  std::vector<Rgb> colours;
  std::vector<float> cover;  ///< 0 or 1.
  Box body;                  ///< Around all pixels that it covers.
  double centroidX = 0, centroidY = 0;

  [[nodiscard]] size_t at(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(size.width) + static_cast<size_t>(x);
  }
};

/// `main` is its largest part's colour.
[[nodiscard]] Model drawModel(Shape shape, int height, const Rgb& main, Dice& dice);
[[nodiscard]] Sprite makeSprite(const Model& model, double scale = 1);

}  // namespace rg::truth
