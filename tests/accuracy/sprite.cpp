// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/accuracy/sprite.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace rg::truth {
namespace {

constexpr int kNothing = -1;
constexpr int kLeastHeight = 4;
constexpr int kGrainPx = 3;  ///< In pixels of the plan.

uint32_t grainAt(int place, double scale) {
  return static_cast<uint32_t>(place / (kGrainPx * scale));
}

/// Width in percent of the height.
int widthOf(Shape shape) {
  switch (shape) {
    case Shape::Person:
      return 38;
    case Shape::Car:
      return 210;
    case Shape::Block:
      return 60;
    case Shape::Corner:
      return 80;
    case Shape::Ball:
    case Shape::Diamond:
      return 100;
  }
  return 100;
}

bool isInBall(int x, int y, int centreX, int centreY, int radiusX, int radiusY) {
  const int64_t dx = int64_t{x - centreX} * radiusY, dy = int64_t{y - centreY} * radiusX;
  return dx * dx + dy * dy <= int64_t{radiusX} * radiusX * radiusY * radiusY;
}

/// Which of three colours is at (x, y), both 0 … 1000 from the body's upper left corner.
int partAt(Shape shape, int x, int y) {
  switch (shape) {
    case Shape::Person:
      if (y < 170) return isInBall(x, y, 500, 90, 230, 90) ? 2 : kNothing;
      if (y < 560) return x > 40 && x < 960 ? 0 : kNothing;
      return std::abs(x - 280) < 190 || std::abs(x - 720) < 190 || y < 640 ? 1 : kNothing;
    case Shape::Car:
      if (isInBall(x, y, 200, 850, 72, 150) || isInBall(x, y, 800, 850, 72, 150)) return 1;
      if (y < 420) return x > 200 + (420 - y) / 5 && x < 780 - (420 - y) / 5 ? 2 : kNothing;
      return y < 880 ? 0 : kNothing;
    case Shape::Block:
      return y / 250 % 2;
    case Shape::Ball:
      if (!isInBall(x, y, 500, 500, 500, 500)) return kNothing;
      return std::abs(y - 500) < 120 ? 1 : 0;
    case Shape::Diamond:
      if (std::abs(x - 500) + std::abs(y - 500) > 500) return kNothing;
      return std::abs(x - 500) + std::abs(y - 500) < 220 ? 1 : 0;
    case Shape::Corner:
      return x < 420 || y > 600 ? (y < 300 ? 1 : 0) : kNothing;
  }
  return kNothing;
}

}  // namespace

Model drawModel(Shape shape, int height, const Rgb& main, Dice& dice) {
  const auto part = [&] { return static_cast<float>(dice.whole(15, 240)); };
  Model model{shape, height, {main, {part(), part(), part()}, {part(), part(), part()}}, 0};
  model.grain = dice.bits();
  return model;
}

Sprite makeSprite(const Model& model, double scale) {
  const int height = std::max(kLeastHeight, static_cast<int>(std::lround(model.height * scale)));
  const Size body{height * widthOf(model.shape) / 100, height};
  Sprite sprite{model, {body.width + 2, body.height + 2}, {}, {}, {}, 0, 0};
  double count = 0;
  for (int y = 0; y < sprite.size.height; ++y)
    for (int x = 0; x < sprite.size.width; ++x) {
      const bool isInside = boundsOf(body).contains({x - 1, y - 1});
      const int found = isInside ? partAt(model.shape, (2 * x - 1) * 500 / body.width,
                                          (2 * y - 1) * 500 / body.height)
                                 : kNothing;
      Rgb colour = model.colours[static_cast<size_t>(std::max(found, 0))];
      const uint32_t hash = mixHash(grainAt(x, scale), grainAt(y, scale), model.grain);
      for (float& channel : colour)
        channel = std::clamp(channel + static_cast<float>(hash % 25) - 12, 0.0f, 255.0f);
      sprite.colours.push_back(colour);
      sprite.cover.push_back(found == kNothing ? 0.0f : 1.0f);
      if (found == kNothing) continue;
      sprite.body = unite(sprite.body, {x, y, 1, 1});
      sprite.centroidX += x;
      sprite.centroidY += y;
      ++count;
    }
  sprite.centroidX /= count;
  sprite.centroidY /= count;
  return sprite;
}

}  // namespace rg::truth
