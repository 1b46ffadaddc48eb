// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/accuracy/sampling.hpp"

#include <cmath>

namespace rg::truth {
namespace {

constexpr int kPlannedHeight = 480;
constexpr double kPlannedFps = 25;

int scaled(int value, double scale) {
  return static_cast<int>(std::lround(value * scale));
}

}  // namespace

Size plannedFrame(Size size) {
  return {scaled(size.width, double(kPlannedHeight) / size.height), kPlannedHeight};
}

Plan sampled(Plan plan, const Sampling& sampling) {
  const double scale = double(sampling.size.height) / plan.frame.height;
  const double rate = sampling.fps / kPlannedFps;
  const auto scaleWay = [&](std::vector<Waypoint>& way) {
    for (Waypoint& place : way) place = {place.frame * rate, place.x * scale, place.y * scale};
  };
  for (Actor& actor : plan.actors) {
    actor.sprite = makeSprite(actor.sprite.model, scale);
    scaleWay(actor.way);
  }
  scaleWay(plan.camera);
  for (Box& pillar : plan.pillars) {
    const int x = scaled(pillar.x, scale), y = scaled(pillar.y, scale);
    pillar = {x, y, scaled(pillar.right(), scale) - x, scaled(pillar.bottom(), scale) - y};
  }
  for (Obstacle& o : plan.obstacles)
    for (double* length : {&o.x, &o.y, &o.width, &o.height, &o.donorX, &o.donorY}) *length *= scale;
  plan.zoom.perFrame /= rate;
  plan.roll.perFrame /= rate;
  plan.frame = sampling.size;
  plan.canvas = {scaled(plan.canvas.width, scale), scaled(plan.canvas.height, scale)};
  plan.scale = scale;
  plan.frames = scaled(plan.frames, rate);
  plan.fps = sampling.fps;
  plan.noise = sampling.noise;
  return plan;
}

}  // namespace rg::truth
