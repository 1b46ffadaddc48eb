// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/accuracy/painter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rg::truth {
namespace {

constexpr uint32_t kNoiseValues = 1 << 16;
constexpr int kGround = -1;

/// Normally distributed but for its tails: sums of twelve bytes.
std::vector<float> makeNoise(uint32_t seed, double sigma) {
  constexpr double kMean = 12 * 127.5, kDeviation = 255.9980;
  std::vector<float> values;
  for (uint32_t i = 0; i < kNoiseValues; ++i) {
    uint32_t sum = 0;
    for (uint32_t j = 0; j < 3; ++j) {
      const uint32_t bits = mixHash(i, j, seed);
      sum += (bits & 255) + (bits >> 8 & 255) + (bits >> 16 & 255) + (bits >> 24);
    }
    values.push_back(static_cast<float>((sum - kMean) * sigma / kDeviation));
  }
  return values;
}

}  // namespace

Painter::Painter(Plan plan, std::unique_ptr<CanvasSource> source, uint32_t seed)
    : plan_(std::move(plan)),
      source_(std::move(source)),
      seed_(seed),
      noise_(makeNoise(seed, plan_.noise)) {}

bool Painter::next(bench::RawFrame& frame, Scene& scene) {
  if (frame_ >= plan_.frames) return false;
  const Waypoint view = *placeAt(plan_.camera, frame_);
  const Waypoint before = *placeAt(plan_.camera, std::max(frame_ - 1, 0));
  scene.facts.clear();
  scene.cameraDx = before.x - view.x;
  scene.cameraDy = before.y - view.y;
  pixels_.resize(static_cast<size_t>(plan_.frame.area()));
  top_.assign(pixels_.size(), kGround);
  const Canvas& canvas = source_->next();
  paintGround(canvas, view, boundsOf(plan_.frame));

  // What has its feet lower stands in front. Pillars come after the actors in the list.
  std::vector<std::pair<double, size_t>> order;
  for (size_t i = 0; i < plan_.actors.size(); ++i)
    if (const auto place = placeAt(plan_.actors[i].way, frame_)) order.push_back({place->y, i});
  for (size_t i = 0; i < plan_.pillars.size(); ++i)
    order.push_back({plan_.pillars[i].bottom(), plan_.actors.size() + i});
  std::sort(order.begin(), order.end());
  for (const auto& [foot, index] : order)
    if (index < plan_.actors.size())
      paintActor(index, view, scene);
    else
      paintGround(canvas, view, plan_.pillars[index - plan_.actors.size()]);

  std::vector<double> seen(plan_.actors.size());
  for (const int actor : top_)
    if (actor != kGround) ++seen[static_cast<size_t>(actor)];
  for (Fact& fact : scene.facts) {
    const std::vector<float>& cover = plan_.actors[static_cast<size_t>(fact.actor)].sprite.cover;
    const auto all = std::count(cover.begin(), cover.end(), 1.0f);
    fact.visible = std::min(1.0, seen[static_cast<size_t>(fact.actor)] / static_cast<double>(all));
  }
  addNoise(frame);
  ++frame_;
  return true;
}

void Painter::skip(int frames) {
  for (; frames > 0; --frames, ++frame_) source_->next();
}

void Painter::paintGround(const Canvas& canvas, const Waypoint& view, const Box& box) {
  const Box inside = intersect(box, boundsOf(plan_.frame));
  for (int y = inside.y; y < inside.bottom(); ++y)
    for (int x = inside.x; x < inside.right(); ++x) {
      const size_t at =
          static_cast<size_t>(y) * static_cast<size_t>(plan_.frame.width) + static_cast<size_t>(x);
      pixels_[at] = canvas.sample(x + view.x, y + view.y);
      top_[at] = kGround;
    }
}

void Painter::paintActor(size_t index, const Waypoint& view, Scene& scene) {
  const Actor& actor = plan_.actors[index];
  const Sprite& s = actor.sprite;
  const Waypoint corner = *actor.cornerAt(frame_);
  // Of the sprite's first pixel, in the frame.
  const double left = corner.x - view.x - s.body.x, top = corner.y - view.y - s.body.y;
  const int firstX = static_cast<int>(std::floor(left)), firstY = static_cast<int>(std::floor(top));
  const auto u = static_cast<float>(left - firstX), v = static_cast<float>(top - firstY);
  const auto number = static_cast<int>(index);
  for (int y = 0; y <= s.size.height; ++y)
    for (int x = 0; x <= s.size.width; ++x) {
      const Point at{firstX + x, firstY + y};
      if (!boundsOf(plan_.frame).contains(at)) continue;
      float cover = 0;
      Rgb colour{};
      const auto take = [&](int sx, int sy, float weight) {
        if (!boundsOf(s.size).contains({sx, sy})) return;
        const float share = weight * s.cover[s.at(sx, sy)];
        cover += share;
        for (size_t c = 0; c < 3; ++c) colour[c] += share * s.colours[s.at(sx, sy)][c];
      };
      take(x, y, (1 - u) * (1 - v));
      take(x - 1, y, u * (1 - v));
      take(x, y - 1, (1 - u) * v);
      take(x - 1, y - 1, u * v);
      const size_t pixel = static_cast<size_t>(at.y) * static_cast<size_t>(plan_.frame.width) +
                           static_cast<size_t>(at.x);
      for (size_t c = 0; c < 3; ++c)
        pixels_[pixel][c] = pixels_[pixel][c] * (1 - cover) + colour[c];
      if (cover >= 0.5f) top_[pixel] = number;
    }
  Fact fact;
  fact.actor = number;
  fact.box = {left + s.body.x, top + s.body.y, double(s.body.width), double(s.body.height)};
  fact.centroidX = left + s.centroidX;
  fact.centroidY = top + s.centroidY;
  fact.isInside = fact.box.x >= 0 && fact.box.y >= 0 &&
                  fact.box.x + fact.box.width <= plan_.frame.width &&
                  fact.box.y + fact.box.height <= plan_.frame.height;
  fact.isSteady = actor.isSteady(frame_, plan_.fps);
  scene.facts.push_back(fact);
}

void Painter::addNoise(bench::RawFrame& frame) {
  frame.layout.format = PixelFormat::Rgb;
  frame.layout.size = plan_.frame;
  frame.bytes.resize(pixels_.size() * 3);
  const auto number = static_cast<uint32_t>(frame_);
  for (int y = 0; y < plan_.frame.height; ++y) {
    uint32_t next = mixHash(number, static_cast<uint32_t>(y), seed_);
    for (int x = 0; x < plan_.frame.width; ++x) {
      const size_t at =
          static_cast<size_t>(y) * static_cast<size_t>(plan_.frame.width) + static_cast<size_t>(x);
      for (size_t c = 0; c < 3; ++c) {
        const float value = pixels_[at][c] + noise_[next++ % kNoiseValues] + 0.5f;
        frame.bytes[at * 3 + c] = static_cast<uint8_t>(std::clamp(value, 0.0f, 255.0f));
      }
    }
  }
}

}  // namespace rg::truth
