// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/accuracy/hardships.hpp"

#include "tests/accuracy/view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace rg::truth {
namespace {

constexpr double kLargest = 1.5;    // The picture never shrinks: pixels between pixels are enough.
constexpr double kMostTurned = 30;  // Degrees.

constexpr int kLanes = 4;           // On the height of a frame.
constexpr double kLanePart = 0.85;  // Of a lane's height the largest actor.
constexpr double kGap = 0.05;       // Between two actors of a lane, of the frame's width.
constexpr double kStride = 40;      // Frames after which an actor's speed changes a little.
constexpr int kProbedFrames = 25;
constexpr int kProbesAcross = 48, kProbesDown = 36;

/// To and fro about `middle` at no more than `speed` a frame.
Swing swingOf(double middle, double most, double speed, Dice& dice) {
  return {middle, most, speed / most, dice.real(0, 2 * std::numbers::pi)};
}

/// Ground all around for a frame that is turned.
void widen(Plan& plan) {
  const double turn = kMostTurned * std::numbers::pi / 180;
  const double width = plan.frame.width, height = plan.frame.height;
  const auto margin = [](double turned, double upright) {
    return static_cast<int>(std::ceil(std::max(turned - upright, 0.0) / 2));
  };
  const int x = margin(width * std::cos(turn) + height * std::sin(turn), width);
  const int y = margin(width * std::sin(turn) + height * std::cos(turn), height);
  plan.canvas.width += 2 * x;
  plan.canvas.height += 2 * y;
  const auto move = [&](std::vector<Waypoint>& way) {
    for (Waypoint& place : way) place = {place.frame, place.x + x, place.y + y};
  };
  move(plan.camera);
  for (Actor& actor : plan.actors) move(actor.way);
}

/// Which share of the frame an actor covers on average.
double coverOf(const Actor& actor, const Plan& plan) {
  int covered = 0;
  for (int i = 0; i < kProbedFrames; ++i) {
    const double frame = (i + 0.5) * plan.frames / kProbedFrames;
    const Affine view = viewAt(plan, frame);
    const Waypoint corner = *actor.cornerAt(frame);
    const Sprite& sprite = actor.sprite;
    for (int y = 0; y < kProbesDown; ++y)
      for (int x = 0; x < kProbesAcross; ++x) {
        const Place place = view((x + 0.5) * plan.frame.width / kProbesAcross,
                                 (y + 0.5) * plan.frame.height / kProbesDown);
        const Point pixel{static_cast<int>(std::lround(place.x - corner.x + sprite.body.x)),
                          static_cast<int>(std::lround(place.y - corner.y + sprite.body.y))};
        if (boundsOf(sprite.size).contains(pixel))
          covered += sprite.cover[sprite.at(pixel.x, pixel.y)] > 0;
      }
  }
  return double(covered) / (kProbedFrames * kProbesAcross * kProbesDown);
}

/// All who pass the canvas in one lane, one behind the other.
class Lane {
 public:
  /// `foot` is its lower edge.
  Lane(const Plan& plan, double foot, double height, Dice& dice)
      : plan_(plan), foot_(foot), height_(height), dice_(dice) {
    const double speed = plan.frame.width * dice.real(2.5, 4.5) / 640;
    speed_ = dice.flip() ? speed : -speed;
  }

  void fill(std::vector<Actor>& actors) {
    const double way = speed_ * plan_.frames, gap = kGap * plan_.frame.width;
    double x = std::min(0.0, -way);
    while (x < std::max(0.0, -way) + plan_.canvas.width) {
      Actor actor{makeSprite(model()), {}, 0};
      const double middle = x + actor.sprite.body.width / 2.0;
      for (double frame = 0; frame < plan_.frames + kStride; frame += kStride)
        actor.way.push_back({frame, middle + speed_ * frame + gap * dice_.real(-0.3, 0.3),
                             foot_ - height_ * (1 - kLanePart) * dice_.real(0.2, 0.8)});
      x += actor.sprite.body.width + gap;
      actors.push_back(std::move(actor));
    }
  }

 private:
  Model model() {
    const auto grey = [&](int least, int most) {
      return static_cast<float>(dice_.whole(least, most));
    };
    const Rgb colour{grey(10, 245), grey(10, 245), dice_.flip() ? grey(10, 40) : grey(210, 245)};
    const auto shape = static_cast<Shape>(dice_.whole(0, kShapes - 1));
    const auto most = static_cast<int>(height_ * kLanePart);
    return drawModel(shape, dice_.whole(most * 4 / 5, most), colour, dice_);
  }

  const Plan& plan_;
  double foot_, height_, speed_ = 0;
  Dice& dice_;
};

/// As many of those who fill the lanes as are needed, all smaller by what would be too much.
void cover(Plan& plan, double share, Dice& dice) {
  const double height = double(plan.frame.height) / kLanes;
  std::vector<Actor> actors;
  for (double foot = height; foot < plan.canvas.height; foot += height)
    Lane(plan, foot, height, dice).fill(actors);
  dice.shuffle(actors);
  plan.actors.clear();
  double covered = 0;
  for (Actor& actor : actors) {
    if (covered >= share) break;
    covered += coverOf(actor, plan);
    actor.act = static_cast<int>(plan.actors.size());
    plan.actors.push_back(std::move(actor));
  }
  const double size = std::sqrt(std::min(1.0, share / covered));
  for (Actor& actor : plan.actors) {
    Model model = actor.sprite.model;
    model.height = static_cast<int>(std::lround(model.height * size));
    actor.sprite = makeSprite(model);
  }
}

/// Posts and hedges in front of everything, wherever the camera looks.
void obstruct(Plan& plan, double share, Dice& dice) {
  plan.parallax = share;
  const double width = plan.frame.width, height = plan.frame.height;
  // The camera sees the canvas end sooner where it moves faster.
  const double beyondX = share * plan.canvas.width / 2, beyondY = share * plan.canvas.height / 2;
  bool isPost = dice.flip();
  for (double y = -beyondY; y < plan.canvas.height + beyondY; y += height / 2)
    for (double x = -beyondX; x < plan.canvas.width + beyondX; x += width / 2) {
      Obstacle o;
      o.width = width * (isPost ? dice.real(0.025, 0.045) : dice.real(0.12, 0.2));
      o.height = height * (isPost ? dice.real(0.2, 0.35) : dice.real(0.05, 0.08));
      o.x = x + dice.real(0, width / 2 - o.width);
      o.y = y + dice.real(0, height / 2 - o.height);
      o.donorX = dice.real(0, plan.canvas.width - o.width);
      o.donorY = dice.real(0, plan.canvas.height - o.height);
      const double spread = dice.flip() ? 70 : 0;
      for (float& part : o.tint) part = static_cast<float>(dice.real(-spread, spread));
      plan.obstacles.push_back(o);
      isPost = !isPost;
    }
}

}  // namespace

Plan hardened(Plan plan, uint32_t seed, const Hardships& hardships) {
  if (hardships.isPlain()) return plan;
  Dice camera(seed, 4), actors(seed, 5), obstacles(seed, 6);
  widen(plan);
  const double half = std::log(kLargest) / 2;
  const double degree = std::numbers::pi / 180;
  const Swing zoom = swingOf(half, half, std::log1p(hardships.zoomPercent / 100), camera);
  const Swing roll = swingOf(0, kMostTurned * degree, hardships.rollDegrees * degree, camera);
  if (hardships.zoomPercent > 0) plan.zoom = zoom;
  if (hardships.rollDegrees > 0) plan.roll = roll;
  if (hardships.coverPercent > 0) cover(plan, hardships.coverPercent / 100, actors);
  if (hardships.parallaxPercent > 0) obstruct(plan, hardships.parallaxPercent / 100, obstacles);
  return plan;
}

}  // namespace rg::truth
