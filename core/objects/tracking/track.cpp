// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/track.hpp"

#include "core/base/pixel.hpp"

#include <cstdlib>
#include <utility>

namespace rg::objects {
namespace {

constexpr int64_t kSecondUs = 1'000'000;
constexpr int kUnit = kPositionUnit;

}  // namespace

Box Track::box() const {
  const auto px = [](int64_t v) { return static_cast<int>(divideRounded(v, kUnit)); };
  const int width = std::max(1, px(size.width)), height = std::max(1, px(size.height));
  return {px(int64_t{x} - size.width / 2), px(foot) - height, width, height};
}

Point Track::portraitCorner(Point camera) const {
  const auto px = [](int64_t v) { return static_cast<int>(divideRounded(v, kUnit)); };
  const Size sizePx = portrait.sizePx;
  return {px(x + camera.x - int64_t{sizePx.width} * kUnit / 2),
          px(int64_t{foot} + camera.y) - sizePx.height};
}

void Track::setStep(Point step, const CameraMotion& camera, int64_t stepNs) {
  const Point by = camera.since({x, foot - size.height / 2});
  const int64_t stepUs = std::max<int64_t>(stepNs / 1000, 1000);
  stepSpeed = Point{toInt((int64_t{step.x} - by.x) * kSecondUs / stepUs),
                    toInt((int64_t{step.y} - by.y) * kSecondUs / stepUs)};
}

Place placeOfPart(const Track& track, const Box& part, Size frame) {
  constexpr int64_t kUnseen = INT32_MAX;  // At the frame's border nothing says where it ends.
  const auto offset = [](int64_t low, int64_t high, int64_t expectedLow, int64_t expectedHigh) {
    const int64_t atLow = low - expectedLow, atHigh = high - expectedHigh;
    const int64_t nearest = std::abs(atLow) <= std::abs(atHigh) ? atLow : atHigh;
    return low == kUnseen && high == kUnseen ? 0 : nearest;
  };
  const int64_t left = int64_t{part.x} * kUnit, right = int64_t{part.right()} * kUnit;
  const int64_t top = int64_t{part.y} * kUnit, bottom = int64_t{part.bottom()} * kUnit;
  const int64_t expectedLeft = track.x - track.size.width / 2;
  const int64_t expectedTop = track.foot - track.size.height;
  return {
      track.x + offset(part.x > 0 ? left : kUnseen, part.right() < frame.width ? right : kUnseen,
                       expectedLeft, expectedLeft + track.size.width),
      track.foot + offset(part.y > 0 ? top : kUnseen,
                          part.bottom() < frame.height ? bottom : kUnseen, expectedTop,
                          track.foot)};
}

Point expectedStep(const Track& track, int64_t stepNs) {
  const auto step = [&](int32_t speed) {
    return toInt(int64_t{speed} * (stepNs / 1000) / kSecondUs);
  };
  const Point speed = track.stepSpeed.value_or(Point{track.speedX, track.speedY});
  return {step(speed.x), step(speed.y)};
}

Point expectedShift(const Track& track, const CameraMotion& camera, int64_t stepNs) {
  const Point step = expectedStep(track, stepNs);
  const Point by = camera.since({track.x, track.foot - track.size.height / 2});
  const auto px = [](int64_t v) { return static_cast<int>(divideRounded(v, kUnit)); };
  return {px(int64_t{step.x} + by.x), px(int64_t{step.y} + by.y)};
}

void moveWithCamera(Track& track, const CameraMotion& camera) {
  const LinearMap change =
      camera.around(track.x / kUnit, (track.foot - track.size.height / 2) / kUnit);
  const std::pair<int32_t*, int32_t*> places[] = {{&track.x, &track.foot},
                                                  {&track.stillX, &track.stillFoot},
                                                  {&track.originX, &track.originFoot},
                                                  {&track.learntX, &track.learntFoot}};
  for (const auto& [x, y] : places) {
    const Point by = camera.since({*x, *y});
    *x = toInt(int64_t{*x} + by.x);
    *y = toInt(int64_t{*y} + by.y);
  }
  const std::pair<int32_t*, int32_t*> directions[] = {{&track.speedX, &track.speedY},
                                                      {&track.steadyX, &track.steadyY},
                                                      {&track.centreX, &track.centreY}};
  for (const auto& [x, y] : directions) {
    const Point now = change.of({*x, *y});
    *x = now.x;
    *y = now.y;
  }
  const int64_t scale = change.scale();
  int32_t* const lengths[] = {&track.size.width, &track.size.height, &track.stillSize.width,
                              &track.stillSize.height};
  for (int32_t* length : lengths) *length = toInt(divideRounded(*length * scale, LinearMap::kOne));
}

}  // namespace rg::objects
