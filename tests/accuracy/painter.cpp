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

/// Around what a sprite covers, in whole pixels' edges.
RealBox boxOf(const Sprite& sprite, const Affine& inFrame) {
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  const auto include = [&](int x, int y) {
    for (const double dx : {-0.5, 0.5})
      for (const double dy : {-0.5, 0.5}) {
        const Place corner = inFrame(x + dx, y + dy);
        left = std::min(left, corner.x);
        right = std::max(right, corner.x);
        top = std::min(top, corner.y);
        bottom = std::max(bottom, corner.y);
      }
  };
  const auto covers = [&](int x, int y) { return sprite.cover[sprite.at(x, y)] > 0; };
  // The ends of what is covered in each row; the sprite's margin is empty.
  for (int y = 1; y < sprite.size.height - 1; ++y)
    for (int x = 1; x < sprite.size.width - 1; ++x)
      if (covers(x, y) && (!covers(x - 1, y) || !covers(x + 1, y))) include(x, y);
  return {left + 0.5, top + 0.5, right - left, bottom - top};
}

/// Whole pixels around a rectangle and a pixel more, which it covers in part.
Box boxAround(const Affine& inFrame, double width, double height) {
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  for (const double x : {-1.0, width + 1})
    for (const double y : {-1.0, height + 1}) {
      const Place corner = inFrame(x, y);
      left = std::min(left, corner.x);
      right = std::max(right, corner.x);
      top = std::min(top, corner.y);
      bottom = std::max(bottom, corner.y);
    }
  const Point first{static_cast<int>(std::floor(left)), static_cast<int>(std::floor(top))};
  return {first.x, first.y, static_cast<int>(std::ceil(right)) + 1 - first.x,
          static_cast<int>(std::ceil(bottom)) + 1 - first.y};
}

}  // namespace

Painter::Painter(Plan plan, std::unique_ptr<CanvasSource> source, uint32_t seed)
    : plan_(std::move(plan)),
      source_(std::move(source)),
      seed_(seed),
      noise_(makeNoise(seed, plan_.noise)) {}

bool Painter::next(bench::RawFrame& frame, Scene& scene) {
  if (frame_ >= plan_.frames) return false;
  const Affine view = viewAt(plan_, frame_);
  scene.frame = plan_.frame;
  scene.facts.clear();
  tellCamera(scene);
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

  for (const Obstacle& obstacle : plan_.obstacles) paintObstacle(obstacle, canvas, view);

  std::vector<double> seen(plan_.actors.size());
  for (const int actor : top_)
    if (actor != kGround) ++seen[static_cast<size_t>(actor)];
  for (Fact& fact : scene.facts) {
    const std::vector<float>& cover = plan_.actors[static_cast<size_t>(fact.actor)].sprite.cover;
    const auto all = std::count(cover.begin(), cover.end(), 1.0f);
    const double size = static_cast<double>(all) / view.determinant();
    fact.visible = std::min(1.0, seen[static_cast<size_t>(fact.actor)] / size);
  }
  addNoise(frame);
  ++frame_;
  return true;
}

void Painter::tellCamera(Scene& scene) const {
  scene.before = groundBefore(plan_, frame_);
  const double middleX = plan_.frame.width / 2.0, middleY = plan_.frame.height / 2.0;
  // In an order in which nothing is rounded where all moves alike.
  const Affine& b = scene.before;
  scene.cameraDx = middleX - (b.xx * middleX + b.xy * middleY) - b.x0;
  scene.cameraDy = middleY - (b.yx * middleX + b.yy * middleY) - b.y0;
}

void Painter::skip(int frames) {
  for (; frames > 0; --frames, ++frame_) source_->next();
}

void Painter::paintGround(const Canvas& canvas, const Affine& view, const Box& box) {
  const Box inside = intersect(box, boundsOf(plan_.frame));
  for (int y = inside.y; y < inside.bottom(); ++y)
    for (int x = inside.x; x < inside.right(); ++x) {
      const size_t at = pixelAt({x, y});
      const Place place = view(x, y);
      pixels_[at] = canvas.sample(place.x, place.y);
      top_[at] = kGround;
    }
}

void Painter::paintActor(size_t index, const Affine& view, Scene& scene) {
  const Actor& actor = plan_.actors[index];
  const Sprite& s = actor.sprite;
  const Waypoint corner = *actor.cornerAt(frame_);
  const auto number = static_cast<int>(index);
  Fact fact;
  fact.actor = number;
  if (view.isShift()) {
    // Of the sprite's first pixel, in the frame.
    const double left = corner.x - view.x0 - s.body.x, top = corner.y - view.y0 - s.body.y;
    paintShifted(s, {left, top}, number);
    fact.box = {left + s.body.x, top + s.body.y, double(s.body.width), double(s.body.height)};
    fact.centroidX = left + s.centroidX;
    fact.centroidY = top + s.centroidY;
  } else {
    const Affine onCanvas{1, 0, corner.x - s.body.x, 0, 1, corner.y - s.body.y};
    const Affine inFrame = after(inverse(view), onCanvas);
    fact.box = boxOf(s, inFrame);
    paintTurned(s, inFrame, fact.box, number);
    const Place centroid = inFrame(s.centroidX, s.centroidY);
    fact.centroidX = centroid.x;
    fact.centroidY = centroid.y;
  }
  fact.isInside = fact.box.x >= 0 && fact.box.y >= 0 &&
                  fact.box.x + fact.box.width <= plan_.frame.width &&
                  fact.box.y + fact.box.height <= plan_.frame.height;
  fact.isSteady = actor.isSteady(frame_, plan_.fps);
  scene.facts.push_back(fact);
}

void Painter::paintShifted(const Sprite& s, Place corner, int number) {
  const int firstX = static_cast<int>(std::floor(corner.x));
  const int firstY = static_cast<int>(std::floor(corner.y));
  const auto u = static_cast<float>(corner.x - firstX), v = static_cast<float>(corner.y - firstY);
  for (int y = 0; y <= s.size.height; ++y)
    for (int x = 0; x <= s.size.width; ++x)
      blend({firstX + x, firstY + y}, s, {x - 1, y - 1}, {u, v}, number);
}

void Painter::paintTurned(const Sprite& s, const Affine& inFrame, const RealBox& box, int number) {
  const Affine onSprite = inverse(inFrame);
  // A pixel around it is covered in part.
  const int left = static_cast<int>(std::floor(box.x)) - 2;
  const int top = static_cast<int>(std::floor(box.y)) - 2;
  const int right = static_cast<int>(std::ceil(box.x + box.width)) + 2;
  const int bottom = static_cast<int>(std::ceil(box.y + box.height)) + 2;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const Place place = onSprite(x, y);
      const double column = std::floor(place.x), row = std::floor(place.y);
      blend({x, y}, s, {static_cast<int>(column), static_cast<int>(row)},
            {static_cast<float>(column + 1 - place.x), static_cast<float>(row + 1 - place.y)},
            number);
    }
}

void Painter::paintObstacle(const Obstacle& o, const Canvas& canvas, const Affine& view) {
  const Waypoint corner = *placeAt(plan_.camera, frame_);
  const double left =
      o.x - plan_.parallax * (corner.x - (plan_.canvas.width - plan_.frame.width) / 2.0);
  const double top =
      o.y - plan_.parallax * (corner.y - (plan_.canvas.height - plan_.frame.height) / 2.0);
  // How much of the pixel at `place` lies within 0 … length.
  const auto partWithin = [](double place, double length) {
    return std::clamp(std::min(place, length - place) + 0.5, 0.0, 1.0);
  };
  const Box seen =
      intersect(boxAround(after(inverse(view), {1, 0, left, 0, 1, top}), o.width, o.height),
                boundsOf(plan_.frame));
  for (int y = seen.y; y < seen.bottom(); ++y)
    for (int x = seen.x; x < seen.right(); ++x) {
      const Place place = view(x, y);
      const double dx = place.x - left, dy = place.y - top;
      const auto cover = static_cast<float>(partWithin(dx, o.width) * partWithin(dy, o.height));
      if (cover == 0) continue;
      const Rgb colour = canvas.sample(o.donorX + dx, o.donorY + dy);
      const size_t at = pixelAt({x, y});
      for (size_t c = 0; c < 3; ++c)
        pixels_[at][c] =
            pixels_[at][c] * (1 - cover) + std::clamp(colour[c] + o.tint[c], 8.0f, 247.0f) * cover;
      if (cover >= 0.5f) top_[at] = kGround;
    }
}

void Painter::blend(Point at, const Sprite& s, Point from, Parts part, int number) {
  if (!boundsOf(plan_.frame).contains(at)) return;
  float cover = 0;
  Rgb colour{};
  const auto take = [&](int x, int y, float weight) {
    if (!boundsOf(s.size).contains({x, y})) return;
    const float share = weight * s.cover[s.at(x, y)];
    cover += share;
    for (size_t c = 0; c < 3; ++c) colour[c] += share * s.colours[s.at(x, y)][c];
  };
  take(from.x + 1, from.y + 1, (1 - part.x) * (1 - part.y));
  take(from.x, from.y + 1, part.x * (1 - part.y));
  take(from.x + 1, from.y, (1 - part.x) * part.y);
  take(from.x, from.y, part.x * part.y);
  const size_t pixel = pixelAt(at);
  for (size_t c = 0; c < 3; ++c) pixels_[pixel][c] = pixels_[pixel][c] * (1 - cover) + colour[c];
  if (cover >= 0.5f) top_[pixel] = number;
}

size_t Painter::pixelAt(Point at) const {
  return static_cast<size_t>(at.y) * static_cast<size_t>(plan_.frame.width) +
         static_cast<size_t>(at.x);
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
