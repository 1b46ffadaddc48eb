// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/trails.hpp"

#include "core/base/time/time.hpp"
#include "core/text/text.hpp"

#include <algorithm>

namespace rg::overlay {

void Trails::moveAll(const CameraMotion& camera) {
  if (camera == CameraMotion() || !camera.isSafe()) return;
  constexpr int kHalfPx = objects::kPositionUnit / 2;  // Places are those of pixels' middles.
  constexpr int kFar = 1 << 20;
  static_assert(objects::kPositionUnit == 1 << CameraMotion::kMotionBits);
  for (auto& [id, trail] : trails_) {
    for (size_t i = 0; i < trail.count; ++i) {
      Point& position = trail.ring[(trail.first + i) % kCapacity].position;
      const Point by = camera.since({position.x - kHalfPx, position.y - kHalfPx});
      const auto moved = [](int at, int step) {
        return static_cast<int>(std::clamp<int64_t>(int64_t{at} + step, -kFar, kFar));
      };
      position = {moved(position.x, by.x), moved(position.y, by.y)};
    }
  }
}

void Trails::forget(Trail& trail, int64_t beforeNs) {
  while (trail.count > 0 && trail.ring[trail.first].ns < beforeNs) {
    trail.first = (trail.first + 1) % kCapacity;
    --trail.count;
  }
}

void Trails::append(Trail& trail, const Sample& sample) {
  if (trail.count == kCapacity) {
    trail.first = (trail.first + 1) % kCapacity;
    --trail.count;
  }
  trail.ring[(trail.first + trail.count) % kCapacity] = sample;
  ++trail.count;
}

void Trails::advance(const objects::Objects& objects, int64_t nowNs, int64_t lengthNs) {
  moveAll(objects.camera);
  for (const objects::Object& object : objects.objects) {
    if (!objects::isListed(object.state)) continue;
    Trail& trail = trails_[object.id];
    trail.seenNs = nowNs;
    const int64_t stepNs = lengthNs / static_cast<int64_t>(kCapacity - 1);
    const auto& last = trail.ring[(trail.first + trail.count + kCapacity - 1) % kCapacity];
    if (trail.count == 0 || timeBetween(last.ns, nowNs) >= stepNs)
      append(trail, {{object.centroidX, object.centroidY}, nowNs});
  }
  const int64_t oldestNs = timeBetween(lengthNs, nowNs);
  for (auto& [id, trail] : trails_) forget(trail, oldestNs);
  std::erase_if(trails_, [&](const auto& entry) { return entry.second.seenNs < oldestNs; });
}

void Trails::copy(const objects::Object& object, std::vector<Point>& out) const {
  out.clear();
  if (const auto found = trails_.find(object.id); found != trails_.end()) {
    const Trail& trail = found->second;
    for (size_t i = 0; i < trail.count; ++i)
      out.push_back(trail.ring[(trail.first + i) % kCapacity].position);
  }
  out.push_back({object.centroidX, object.centroidY});
}

}  // namespace rg::overlay
