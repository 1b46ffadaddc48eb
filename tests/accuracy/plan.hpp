// SPDX-License-Identifier: LGPL-2.1-or-later
// Who moves where in a made-up scene, drawn from a seed.
#pragma once

#include "tests/accuracy/sprite.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace rg::truth {

/// A place at a time; between two of them everything moves at constant speed.
struct Waypoint {
  double frame = 0, x = 0, y = 0;
};

/// Where a way leads at `frame`; none before its start and after its end.
[[nodiscard]] std::optional<Waypoint> placeAt(const std::vector<Waypoint>& way, double frame);

struct Actor {
  Sprite sprite;
  std::vector<Waypoint> way;  ///< Of the middle of its lower edge, on the canvas.
  int act = 0;                ///< Actors of one act are meant to meet.

  /// Its body's box, unrounded: x, y are the upper left corner, whose size is the sprite's.
  [[nodiscard]] std::optional<Waypoint> cornerAt(double frame) const;
  /// Neither turns nor changes its speed within `margin` frames of `frame`.
  [[nodiscard]] bool isSteady(double frame, double margin) const;
};

/// Something that stands still in front of everything, with the texture of the ground elsewhere.
struct Obstacle {
  double x = 0, y = 0, width = 0,
         height = 0;              ///< On the canvas, while the camera is in its middle.
  double donorX = 0, donorY = 0;  ///< Where its texture comes from.
  Rgb tint{};
};

/// To and fro, as a pendulum swings.
struct Swing {
  double middle = 0, most = 0;  ///< From middle − most to middle + most.
  double perFrame = 0;          ///< Of the phase, in radians.
  double phase = 0;

  [[nodiscard]] double at(double frame) const;
};

struct Plan {
  Size frame, canvas;
  double scale = 1;  ///< Pixels by those of the plan as it was drawn.
  int frames = 0;
  double fps = 25;
  double noise = 4;
  std::vector<Actor> actors;
  std::vector<Box> pillars;      ///< Parts of the canvas that hide what has its feet above theirs.
  std::vector<Waypoint> camera;  ///< Of the frame's upper left corner on the canvas, were it
                                 ///< neither zoomed nor turned.
  std::vector<Obstacle> obstacles;
  double parallax = 0;  ///< Of the camera's way, the part by which obstacles move more than
                        ///< the ground.
  Swing zoom;           ///< Logarithm of how many times larger the picture is.
  Swing roll;           ///< How far the frame is turned, in radians.
};

/// Plans are drawn for 25 frames a second (sampling.hpp).
///
/// A camera that stands still: 1 to 13 actors, of whom some stop for 10 s, some are hidden for 1 s,
/// some cross others, also of their own colour, and some walk together for a while.
[[nodiscard]] Plan planStill(uint32_t seed, Size frame);

/// A camera that pans at up to 4 px per frame over a still ground on which 1 to 4 actors move.
[[nodiscard]] Plan planPan(uint32_t seed, Size frame);

}  // namespace rg::truth
