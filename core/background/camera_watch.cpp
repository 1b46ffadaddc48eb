// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/camera_watch.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <utility>

namespace rg::background {
namespace {

// Shares of the frame's shorter side that the picture goes by at one of its corners.
constexpr int kOffShare = 100;  // Where the model does not hold any more.
constexpr int kNewShare = 24;   // Where there is none yet: what sways by less, all in all, stands.
constexpr int kStillShare = 200;  // Less than that within kStillS is standing still.
constexpr double kStillS = 1.0;
// Share of the picture that has to agree on a motion, so that it may be a camera's: waves agree on
// less, and so does a person before a bare wall.
constexpr double kLeastAgreement = .09;
constexpr int kLongWay = 1 << 24;  // 1/16 px; no more is added up.

constexpr int kUnit = 1 << CameraMotion::kMotionBits;

}  // namespace

void CameraWatch::show(std::shared_ptr<const Picture> picture) {
  if (!picture) return reset();
  previous_ = std::exchange(current_, std::move(picture));
}

void CameraWatch::reset() {
  previous_.reset();
  current_.reset();
  search_.reset();
  way_ = {};
  stillFrames_ = 0;
  isMoving_ = false;
}

void CameraWatch::look(const Executor& executor) {
  motion_ = previous_ ? search_.find(current_, previous_, executor) : CameraMotion();
}

void CameraWatch::addWay() {
  const Size size = current_->size();
  const auto add = [](int& sum, int by) { sum = std::clamp(sum + by, -kLongWay, kLongWay); };
  for (size_t i = 0; i < way_.size(); ++i) {
    const Point by = motion_.at(i % 2 == 0 ? 0 : size.width - 1, i < 2 ? 0 : size.height - 1);
    add(way_[i].x, std::clamp(by.x, -kLongWay, kLongWay));
    add(way_[i].y, std::clamp(by.y, -kLongWay, kLongWay));
  }
}

/// At least that share of the shorter side.
bool CameraWatch::hasGone(int share) const {
  const int side = std::min(current_->size().width, current_->size().height);
  return std::any_of(way_.begin(), way_.end(), [&](Point way) {
    const int64_t most = std::max(absDiff(way.x, 0), absDiff(way.y, 0));
    return most * share >= int64_t{side} * kUnit;
  });
}

bool CameraWatch::starts(bool differsEverywhere, const Executor& executor) {
  look(executor);
  if (search_.agreement() >= kLeastAgreement)
    addWay();
  else
    way_ = {};  // A step of it is missing.
  isMoving_ = hasGone(differsEverywhere ? kOffShare : kNewShare);
  if (isMoving_) {
    way_ = {};
    stillFrames_ = 0;
  }
  return isMoving_;
}

bool CameraWatch::stops(const FrameClock& clock, const Executor& executor) {
  look(executor);
  addWay();
  ++stillFrames_;
  if (hasGone(kStillShare)) {
    way_ = {};
    stillFrames_ = 0;
  }
  if (stillFrames_ >= clock.frames(kStillS)) isMoving_ = false;
  return !isMoving_;
}

}  // namespace rg::background
