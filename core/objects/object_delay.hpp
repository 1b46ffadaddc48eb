// SPDX-License-Identifier: LGPL-2.1-or-later
// Results held back for a fixed time, so that each frame is told with what the next ones show: an
// object is told from the frame in which it was first seen, not from the one that confirmed it, and
// while it was hidden it lies on the way between where it went and where it came back.
//
// Determinism: depends on the results and their times alone.
#pragma once

#include "core/base/memory/pool.hpp"
#include "core/objects/object.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <vector>

namespace rg::objects {

class ObjectDelay {
 public:
  /// Adds the next frame. timeNs: since any beginning. A frame that is no later than the one before
  /// counts as later by kNominalStepNs, so that a time that stands still holds nothing for ever.
  void push(std::shared_ptr<const Objects> objects, int64_t timeNs);
  /// How many frames are held.
  [[nodiscard]] size_t count() const { return entries_.size(); }
  /// The oldest frame, if the newest is later by at least delayNs, an hour at most; null otherwise.
  [[nodiscard]] std::shared_ptr<const Objects> pop(int64_t delayNs);
  /// The oldest frame, told with what is there; null if there is none.
  [[nodiscard]] std::shared_ptr<const Objects> popAny();
  void clear();

 private:
  struct Entry {
    std::shared_ptr<const Objects> objects;
    int64_t timeNs = 0;
    uint64_t clockNs = 0;  ///< The same, but always going on; wraps.
  };
  struct Seen {
    Object object;
    int64_t timeNs = 0;
  };

  void forgetTold(std::vector<Event>& events);
  void confirm(Object& object, Objects& frame);
  void bridge(Object& object, int64_t timeNs) const;
  void rememberSeen(const Objects& frame, int64_t timeNs);

  std::deque<Entry> entries_;
  std::map<uint64_t, Seen> lastSeen_;  ///< Of frames that were popped; of those that still live.
  std::set<uint64_t> toldEarly_;       ///< Objects whose beginning is still to come in a source.
  Pool<Objects> pool_;
};

}  // namespace rg::objects
