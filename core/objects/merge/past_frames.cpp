// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/past_frames.hpp"

#include "core/base/camera/camera_place.hpp"
#include "core/base/time/time.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace rg::objects {

void PastFrames::clear() {
  forget(count_);
}

void PastFrames::forget(size_t count) {
  std::move(frames_.begin() + static_cast<std::ptrdiff_t>(count),
            frames_.begin() + static_cast<std::ptrdiff_t>(count_), frames_.begin());
  for (size_t i = count_ - count; i < count_; ++i) frames_[i] = {};
  count_ -= count;
}

void PastFrames::advance(const CameraMotion& camera, int64_t stepNs) {
  for (size_t i = 0; i < count_; ++i) {
    frames_[i].camera = followed(camera, frames_[i].camera);
    frames_[i].ageNs = addTimes(frames_[i].ageNs, stepNs);
  }
}

const PastFrame* PastFrames::nearest(int64_t ns) {
  if (count_ == 0) return nullptr;
  const auto off = [&](size_t i) { return std::abs(timeBetween(ns, frames_[i].ageNs)); };
  size_t best = 0;
  while (best + 1 < count_ && off(best + 1) <= off(best)) ++best;
  forget(best);
  return &frames_.front();
}

void PastFrames::add(std::shared_ptr<const Picture> picture, int64_t ns) {
  const bool isDense =
      count_ > 1 && timeBetween(frames_[count_ - 1].ageNs, frames_[count_ - 2].ageNs) < ns / 8;
  if (isDense) --count_;
  if (count_ == kMost) forget(1);
  frames_[count_++] = {std::move(picture), {}, 0};
}

}  // namespace rg::objects
