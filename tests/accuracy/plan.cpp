// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/accuracy/plan.hpp"

#include <algorithm>
#include <cmath>

namespace rg::truth {
namespace {

constexpr int kEmptyFrames = 60;  // The background is learnt by then.
constexpr int kSecond = 25;       // Frames.
constexpr int kStop = 10 * kSecond;
constexpr int kTries = 400;

enum class Act { Plain, Stop, Hide, Cross, Twins, Together };
constexpr Act kActs[] = {Act::Stop, Act::Hide, Act::Cross, Act::Together, Act::Twins, Act::Plain};

int actorsIn(Act act) {
  return act == Act::Cross || act == Act::Twins || act == Act::Together ? 2 : 1;
}

struct Cast {
  std::vector<Actor> actors;
  std::vector<Box> pillars;
};

class StillPlanner {
 public:
  StillPlanner(uint32_t seed, Size frame)
      : dice_(seed, 2), plan_{frame, frame, 1, 0, kSecond, 4, {}, {}, {}, {}, 0, {}, {}} {
    plan_.camera = {{0, 0, 0}, {1e9, 0, 0}};
  }

  Plan make() {
    const int wanted = 1 + static_cast<int>(dice_.bits() % 13);
    std::vector<Act> acts(std::begin(kActs), std::end(kActs));
    dice_.shuffle(acts);
    for (size_t i = 0; static_cast<int>(plan_.actors.size()) < wanted; ++i) {
      const Act act = acts[i % acts.size()];
      const int room = wanted - static_cast<int>(plan_.actors.size());
      place(actorsIn(act) <= room ? act : Act::Plain);
    }
    double last = 0;
    for (const Actor& actor : plan_.actors) last = std::max(last, actor.way.back().frame);
    plan_.frames = static_cast<int>(last) + kSecond / 2;
    return std::move(plan_);
  }

 private:
  void place(Act act) {
    ++act_;
    for (int attempt = 0;; ++attempt) {
      start_ = kEmptyFrames + dice_.whole(0, 8 * kSecond + attempt);
      Cast cast = draw(act);
      if (attempt < kTries && !fits(cast)) continue;
      for (Actor& actor : cast.actors) plan_.actors.push_back(std::move(actor));
      for (const Box& pillar : cast.pillars) plan_.pillars.push_back(pillar);
      return;
    }
  }

  Cast draw(Act act) {
    if (act == Act::Hide) return hidden();
    if (act == Act::Together) return together();
    if (act == Act::Cross || act == Act::Twins) return crossing(act == Act::Twins);
    Cast cast;
    cast.actors.push_back(single(act == Act::Stop));
    return cast;
  }

  [[nodiscard]] double width() const { return plan_.frame.width; }
  [[nodiscard]] double height() const { return plan_.frame.height; }

  /// Clearly lighter, darker or more colourful than the grey of most grounds.
  Rgb colour() {
    for (;;) {
      Rgb drawn;
      float most = 0;
      for (float& part : drawn) {
        part = static_cast<float>(dice_.whole(10, 245));
        most = std::max(most, std::abs(part - 125));
      }
      if (most >= 90) return drawn;
    }
  }

  Sprite sprite() {
    const auto shape = static_cast<Shape>(dice_.whole(0, kShapes - 1));
    const int percent = shape == Shape::Person ? dice_.whole(14, 24) : dice_.whole(9, 17);
    return makeSprite(
        drawModel(shape, std::max(8, plan_.frame.height * percent / 100), colour(), dice_));
  }

  double lane(const Sprite& s) { return dice_.real(s.body.height + 10.0, height() - 6); }
  double speed() { return width() * dice_.real(1.5, 4.5) / 640; }  // Pixels per frame.

  /// From beyond one border to beyond the other, perhaps with a stop on the way.
  Actor single(bool stops) {
    Actor actor{sprite(), {}, act_};
    const double beyond = actor.sprite.size.width;
    const bool isVertical = !stops && dice_.whole(0, 4) == 0;
    Waypoint from{double(start_), -beyond, lane(actor.sprite)};
    Waypoint to{0, width() + beyond, 0};
    to.y = std::clamp(from.y + dice_.real(-40, 40), actor.sprite.body.height + 8.0, height() - 4);
    if (isVertical) {
      from.x = dice_.real(beyond, width() - beyond);
      to.x = std::clamp(from.x + dice_.real(-60, 60), beyond, width() - beyond);
      from.y = height() + actor.sprite.size.height + 4;
      to.y = -4;
    }
    if (dice_.flip()) {
      std::swap(from.x, to.x);
      std::swap(from.y, to.y);
    }
    const double frames = std::hypot(to.x - from.x, to.y - from.y) / speed();
    actor.way.push_back(from);
    if (stops) {
      const double part = dice_.real(0.3, 0.7);
      Waypoint stop{start_ + frames * part, from.x + part * (to.x - from.x),
                    from.y + part * (to.y - from.y)};
      actor.way.push_back(stop);
      stop.frame += kStop;
      actor.way.push_back(stop);
    }
    actor.way.push_back({start_ + frames + (stops ? kStop : 0), to.x, to.y});
    return actor;
  }

  /// One that is behind a pillar for a second, all of it.
  Cast hidden() {
    Actor actor{sprite(), {}, act_};
    const Sprite& s = actor.sprite;
    const double foot = std::floor(dice_.real(s.body.height + 10.0, height() * 0.6));
    const double pace = speed(), frames = (width() + 2.0 * s.size.width) / pace;
    const bool isLeftward = dice_.flip();
    const double from = -s.size.width, to = width() + s.size.width;
    actor.way = {{double(start_), isLeftward ? to : from, foot},
                 {start_ + frames, isLeftward ? from : to, foot}};
    const int wide = s.size.width + static_cast<int>(std::ceil(pace * kSecond));
    const Box pillar{dice_.whole(plan_.frame.width / 4, plan_.frame.width * 3 / 4) - wide / 2,
                     static_cast<int>(foot) - s.size.height - 8, wide, s.size.height + 14};
    Cast cast;
    cast.actors.push_back(std::move(actor));
    cast.pillars.push_back(pillar);
    return cast;
  }

  /// Two that pass each other, one close behind the other.
  Cast crossing(bool areTwins) {
    Cast cast;
    const double middle = width() * dice_.real(0.35, 0.65);
    double foot = 0;
    for (int i = 0; i < 2; ++i) {
      Actor actor{i == 1 && areTwins ? cast.actors[0].sprite : sprite(), {}, act_};
      if (i == 0) foot = lane(actor.sprite);
      const double row = std::clamp(i == 0 ? foot : foot + dice_.real(-16, 16),
                                    actor.sprite.body.height + 6.0, height() - 4);
      const double beyond = actor.sprite.size.width, pace = speed();
      const double before = (middle + beyond) / pace, after = (width() - middle + beyond) / pace;
      const double meeting = start_ + (width() + 200) / (1.5 * width() / 640) / 2;
      if (i == 0)
        actor.way = {{meeting - before, -beyond, row}, {meeting + after, width() + beyond, row}};
      else
        actor.way = {{meeting - after, width() + beyond, row}, {meeting + before, -beyond, row}};
      cast.actors.push_back(std::move(actor));
    }
    return cast;
  }

  /// Two that come from both sides, walk side by side for three seconds, and part.
  Cast together() {
    Cast cast;
    Actor first{sprite(), {}, act_}, second{sprite(), {}, act_};
    const double foot = lane(first.sprite), pace = speed();
    const double row =
        std::clamp(foot + dice_.real(-8, 8), second.sprite.body.height + 6.0, height() - 4);
    const double apart =
        (first.sprite.body.width + second.sprite.body.width) * dice_.real(0.38, 0.5);
    const double meet = width() * dice_.real(0.35, 0.5), walk = pace * 3 * kSecond;
    const double a = -first.sprite.size.width, b = width() + second.sprite.size.width;
    const double meeting = start_ + std::max(meet - a, b - meet - apart) / pace;
    const double parting = meeting + 3 * kSecond;
    first.way = {{meeting - (meet - a) / pace, a, foot},
                 {parting + (width() - meet - walk - a) / pace, width() - a, foot}};
    const double back = meet + walk + apart;
    second.way = {{meeting - (b - meet - apart) / pace, b, row},
                  {meeting, meet + apart, row},
                  {parting, back, row},
                  {parting + (b - back) / (2 * pace), b, row}};
    cast.actors.push_back(std::move(first));
    cast.actors.push_back(std::move(second));
    return cast;
  }

  /// Whether nobody stays on somebody else's place for long, except as their act wants it.
  [[nodiscard]] bool fits(const Cast& cast) const {
    const auto isPillarFree = [](const Actor& actor, const Box& pillar) {
      for (double t = actor.way.front().frame; t < actor.way.back().frame; t += 5) {
        const auto corner = actor.cornerAt(t);
        if (!corner || corner->y + actor.sprite.body.height > pillar.bottom()) continue;
        const Box body{static_cast<int>(corner->x), static_cast<int>(corner->y),
                       actor.sprite.body.width, actor.sprite.body.height};
        if (10 * intersect(body, pillar).area() > body.area()) return false;
      }
      return true;
    };
    for (const Actor& fresh : cast.actors)
      for (const Box& pillar : plan_.pillars)
        if (!isPillarFree(fresh, pillar)) return false;
    for (const Actor& old : plan_.actors) {
      for (const Box& pillar : cast.pillars)
        if (!isPillarFree(old, pillar)) return false;
      for (const Actor& fresh : cast.actors)
        if (togetherFor(old, fresh) > 1.5 * kSecond) return false;
    }
    return true;
  }

  /// Most frames in a row for which two overlap clearly.
  static double togetherFor(const Actor& p, const Actor& q) {
    constexpr double kStep = 5;
    double most = 0, length = 0;
    const double first = std::max(p.way.front().frame, q.way.front().frame);
    const double last = std::min(p.way.back().frame, q.way.back().frame);
    for (double t = first; t <= last; t += kStep) {
      const auto a = p.cornerAt(t), b = q.cornerAt(t);
      const auto boxOf = [](const Waypoint& corner, const Sprite& sprite) {
        return Box{static_cast<int>(corner.x), static_cast<int>(corner.y), sprite.body.width,
                   sprite.body.height};
      };
      const Box mine = boxOf(*a, p.sprite), other = boxOf(*b, q.sprite);
      const bool overlaps =
          10 * intersect(mine, other).area() > std::min(mine.area(), other.area());
      length = overlaps ? length + kStep : 0;
      most = std::max(most, length);
    }
    return most;
  }

  Dice dice_;
  Plan plan_;
  int act_ = 0;
  int start_ = 0;
};

}  // namespace

std::optional<Waypoint> placeAt(const std::vector<Waypoint>& way, double frame) {
  for (size_t i = 1; i < way.size(); ++i) {
    const Waypoint &p = way[i - 1], &q = way[i];
    if (frame < p.frame || frame > q.frame) continue;
    const double part = q.frame > p.frame ? (frame - p.frame) / (q.frame - p.frame) : 0;
    return Waypoint{frame, p.x + part * (q.x - p.x), p.y + part * (q.y - p.y)};
  }
  return std::nullopt;
}

double Swing::at(double frame) const {
  return middle + most * std::sin(perFrame * frame + phase);
}

std::optional<Waypoint> Actor::cornerAt(double frame) const {
  auto place = placeAt(way, frame);
  if (!place) return place;
  place->x -= sprite.body.width / 2.0;
  place->y -= sprite.body.height;
  return place;
}

bool Actor::isSteady(double frame, double margin) const {
  return std::none_of(way.begin() + 1, way.end() - 1,
                      [&](const Waypoint& p) { return std::abs(p.frame - frame) < margin; });
}

Plan planStill(uint32_t seed, Size frame) {
  return StillPlanner(seed, frame).make();
}

Plan planPan(uint32_t seed, Size frame) {
  Dice dice(seed, 3);
  Plan plan;
  plan.frame = frame;
  plan.canvas = {frame.width * 3 / 2, frame.height * 5 / 4};
  plan.frames = 250;
  const double roomX = plan.canvas.width - frame.width, roomY = plan.canvas.height - frame.height;
  Waypoint view{0, roomX * dice.real(0.2, 0.8), roomY * dice.real(0.3, 0.7)};
  plan.camera.push_back(view);
  while (view.frame < plan.frames) {
    const double frames = dice.whole(20, 50);
    const double paceX = dice.real(-4, 4), paceY = dice.real(-1, 1);
    view = {view.frame + frames, std::clamp(view.x + frames * paceX, 0.0, roomX),
            std::clamp(view.y + frames * paceY, 0.0, roomY)};
    plan.camera.push_back(view);
  }
  const int count = dice.whole(1, 4);
  for (int i = 0; i < count; ++i) {
    const Rgb colour{static_cast<float>(dice.whole(10, 245)),
                     static_cast<float>(dice.whole(10, 245)),
                     static_cast<float>(dice.flip() ? dice.whole(10, 40) : dice.whole(210, 245))};
    const auto shape = static_cast<Shape>(dice.whole(0, kShapes - 1));
    const int height = frame.height * dice.whole(12, 20) / 100;
    Actor actor{makeSprite(drawModel(shape, height, colour, dice)), {}, i};
    const double lane = roomY / 2 + frame.height * (i + 1.0) / (count + 1) +
                        actor.sprite.body.height / 2.0 + dice.real(-5, 5);
    const double left = roomX / 2 + frame.width * 0.25, right = roomX / 2 + frame.width * 0.75;
    bool isRightward = dice.flip();
    Waypoint place{0, dice.real(left, right), lane};
    actor.way.push_back(place);
    while (place.frame < plan.frames) {
      const double pace = frame.width * dice.real(2.5, 4.5) / 640;
      const double to = isRightward ? right : left;
      const double frames = std::max(1.0, std::abs(to - place.x) / pace);
      place = {place.frame + frames, to, lane + dice.real(-8, 8)};
      actor.way.push_back(place);
      isRightward = !isRightward;
    }
    plan.actors.push_back(std::move(actor));
  }
  return plan;
}

}  // namespace rg::truth
