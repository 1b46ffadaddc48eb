// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/object_delay.hpp"

#include "core/base/pixel.hpp"
#include "core/base/time/time.hpp"

#include <algorithm>
#include <utility>

namespace rg::objects {
namespace {

constexpr int64_t kLongestStepNs = 3'600'000'000'000;
constexpr int64_t kLongestUs = int64_t{1} << 30;  // Times a difference of two ints: below 2^63.

const Object* findObject(const Objects& frame, uint64_t id) {
  const auto at = std::lower_bound(frame.objects.begin(), frame.objects.end(), id,
                                   [](const Object& o, uint64_t wanted) { return o.id < wanted; });
  return at != frame.objects.end() && at->id == id ? &*at : nullptr;
}

bool isSeen(const Object& object) {
  return object.areaPx > 0;
}

}  // namespace

void ObjectDelay::push(std::shared_ptr<const Objects> objects, int64_t timeNs) {
  uint64_t clockNs = 0;
  if (!entries_.empty()) {
    const Entry& last = entries_.back();
    const int64_t step = std::min(timeBetween(last.timeNs, timeNs), kLongestStepNs);
    clockNs = last.clockNs + static_cast<uint64_t>(step > 0 ? step : kNominalStepNs);
  }
  entries_.push_back({std::move(objects), timeNs, clockNs});
}

std::shared_ptr<const Objects> ObjectDelay::pop(int64_t delayNs) {
  const bool isDue = !entries_.empty() && entries_.back().clockNs - entries_.front().clockNs >=
                                              static_cast<uint64_t>(std::max<int64_t>(delayNs, 0));
  return isDue ? popAny() : nullptr;
}

std::shared_ptr<const Objects> ObjectDelay::popAny() {
  if (entries_.empty()) return nullptr;
  const Entry& entry = entries_.front();
  const std::shared_ptr<Objects> frame = pool_.take();
  frame->copyFrom(*entry.objects);
  forgetTold(frame->events);
  for (Object& object : frame->objects) {
    confirm(object, *frame);
    bridge(object, entry.timeNs);
  }
  rememberSeen(*frame, entry.timeNs);
  entries_.pop_front();  // Last: where memory ran out before, it is still there.
  return frame;
}

void ObjectDelay::clear() {
  entries_.clear();
  lastSeen_.clear();
  toldEarly_.clear();
}

/// Drops beginnings that were told with an earlier frame.
void ObjectDelay::forgetTold(std::vector<Event>& events) {
  std::erase_if(events, [&](const Event& event) {
    return event.kind == EventKind::ObjectNew && toldEarly_.erase(event.ids.front()) != 0;
  });
}

void ObjectDelay::confirm(Object& object, Objects& frame) {
  if (object.state != ObjectState::New) return;
  const bool isConfirmed = std::any_of(entries_.begin(), entries_.end(), [&](const Entry& later) {
    const Object* found = findObject(*later.objects, object.id);
    return found && isListed(found->state);
  });
  if (!isConfirmed) return;
  object.state = ObjectState::Tracked;
  if (toldEarly_.insert(object.id).second)
    frame.events.push_back({EventKind::ObjectNew, {object.id}});
}

/// Puts an object that is hidden now and seen again later on the straight way between.
void ObjectDelay::bridge(Object& object, int64_t timeNs) const {
  const auto before = lastSeen_.find(object.id);
  if (isSeen(object) || before == lastSeen_.end()) return;
  for (const Entry& later : entries_) {
    const Object* found = findObject(*later.objects, object.id);
    if (!found || !isSeen(*found)) continue;
    const auto& [from, fromNs] = before->second;
    // Times may be any distance apart; what counts of a long one is its share.
    int64_t whole = std::max<int64_t>(1, timeBetween(fromNs, later.timeNs) / 1000);
    int64_t part = std::clamp<int64_t>(timeBetween(fromNs, timeNs) / 1000, 0, whole);
    for (; whole > kLongestUs; part /= 2) whole /= 2;
    const auto between = [&](int a, int b) {
      return static_cast<int>(a + divideRounded((int64_t{b} - a) * part, whole));
    };
    object.state = ObjectState::Occluded;
    object.box = {between(from.box.x, found->box.x), between(from.box.y, found->box.y),
                  between(from.box.width, found->box.width),
                  between(from.box.height, found->box.height)};
    object.centroidX = between(from.centroidX, found->centroidX);
    object.centroidY = between(from.centroidY, found->centroidY);
    return;
  }
}

void ObjectDelay::rememberSeen(const Objects& frame, int64_t timeNs) {
  std::erase_if(lastSeen_, [&](const auto& seen) { return !findObject(frame, seen.first); });
  for (const Object& object : frame.objects)
    if (isSeen(object)) lastSeen_[object.id] = {object, timeNs};
}

}  // namespace rg::objects
