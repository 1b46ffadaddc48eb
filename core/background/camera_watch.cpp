// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/camera_watch.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <utility>

namespace rg::background {
namespace {

// Shares of the frame's shorter side that the picture goes by at one of its corners.
constexpr int kOffShare = 100;  // Where the model does not hold any more.
constexpr int kSwayShare = 24;  // Where there is none yet: what sways by less, all in all, stands.
constexpr int kStillShare = 200;               // Less than that within kStillS is standing still,
constexpr double kStillS = 1.0, kSwayS = 3.0;  // and less than a sway within kSwayS.
constexpr double kStartS = 1.0;                // What takes longer adds up by chance.
// Share of the picture that has to agree on a motion, so that it may be a camera's: waves agree on
// less, and so does a person before a bare wall.
constexpr double kLeastAgreement = .09;
constexpr double kOffAgreement = .03;  // Where the model says as well that nothing is where it was.
constexpr double kNoAgreement = .02;   // The picture tells nothing, as the sea's.
constexpr int kLongWay = 1 << 24;      // 1/16 px; no more is added up.

constexpr int kUnit = 1 << CameraMotion::kMotionBits;

}  // namespace

void CameraWatch::show(std::shared_ptr<const Picture> picture) {
  if (!picture) return reset();
  previous_ = std::exchange(current_, std::move(picture));
}

void CameraWatch::reset() {
  *this = {};
}

void CameraWatch::breakOff() {
  current_.reset();
  way_ = range_ = {};
}

void CameraWatch::passOver() {
  search_.reset();
  way_ = {};
}

/// False where there is nothing to compare with.
bool CameraWatch::look(const Executor& executor) {
  motion_ = previous_ ? search_.find(current_, previous_, executor) : CameraMotion();
  return previous_ != nullptr;
}

void CameraWatch::goOn(Way& way) const {
  const Size size = current_->size();
  const auto add = [](int& sum, int by) {
    sum = std::clamp(sum + std::clamp(by, -kLongWay, kLongWay), -kLongWay, kLongWay);
  };
  for (size_t i = 0; i < way.corners.size(); ++i) {
    const Point by = motion_.at(i % 2 == 0 ? 0 : size.width - 1, i < 2 ? 0 : size.height - 1);
    add(way.corners[i].x, by.x);
    add(way.corners[i].y, by.y);
  }
  ++way.frames;
}

/// Of the shorter side.
bool CameraWatch::isAtLeast(const Way& way, int share) const {
  const int side = std::min(current_->size().width, current_->size().height);
  return std::any_of(way.corners.begin(), way.corners.end(), [&](Point corner) {
    const int64_t most = std::max(absDiff(corner.x, 0), absDiff(corner.y, 0));
    return most * share >= int64_t{side} * kUnit;
  });
}

bool CameraWatch::starts(bool differsEverywhere, const FrameClock& clock,
                         const Executor& executor) {
  const double least = differsEverywhere ? kOffAgreement : kLeastAgreement;
  const bool isKnown = look(executor) && search_.agreement() >= least;
  if (!isKnown || way_.frames >= clock.frames(kStartS)) way_ = {};  // A step of it is missing.
  if (isKnown) goOn(way_);
  isMoving_ = isAtLeast(way_, differsEverywhere ? kOffShare : kSwayShare);
  if (isMoving_) way_ = range_ = {};
  return isMoving_;
}

bool CameraWatch::stops(const FrameClock& clock, const Executor& executor) {
  if (!look(executor)) return false;
  const bool tells = search_.agreement() >= kNoAgreement;
  for (Way* way : {&way_, &range_}) tells ? goOn(*way) : void(++way->frames);
  if (isAtLeast(way_, kStillShare)) way_ = {};
  if (isAtLeast(range_, kSwayShare)) range_ = {};
  isMoving_ = way_.frames < clock.frames(kStillS) && range_.frames < clock.frames(kSwayS);
  return !isMoving_;
}

}  // namespace rg::background
