// SPDX-License-Identifier: LGPL-2.1-or-later
// Who shares a blob with whom, and since when: merges and splits.
#include "core/objects/tracking/tracker.hpp"

#include <algorithm>
#include <utility>

namespace rg::objects {

/// Tracks of one blob form a company, named after its smallest id; a change counts once it has
/// lasted. Tracks that are not seen stay where they were.
void Tracker::findCompany(int64_t stepNs) {
  companyBefore_.resize(sightings_.size());
  for (size_t i = 0; i < sightings_.size(); ++i) {
    Track& track = tracks_[i];
    if (track.company == 0) track.company = track.id;
    companyBefore_[i] = track.company;
    if (!track.isSeen || !track.isConfirmed || blobOf_[i] == 0) continue;
    uint64_t company = track.id;  // Ids are sorted: the first track of the blob is the smallest.
    for (size_t j = 0; j < i && company == track.id; ++j)
      if (blobOf_[j] == blobOf_[i] && tracks_[j].isSeen && tracks_[j].isConfirmed)
        company = tracks_[j].id;
    if (company != track.nextCompany) track.companyNs = 0;
    track.nextCompany = company;
    track.companyNs += stepNs;
    if (track.companyNs >= numbers_.life.settled.whole()) track.company = company;
  }
}

/// One event for each company that came together or apart in this frame.
void Tracker::tellCompany() {
  const auto tell = [&](EventKind kind, uint64_t name, const auto& company, const auto& other) {
    const auto isMember = [&](size_t i) { return tracks_[i].isConfirmed && company(i) == name; };
    size_t first = 0;
    while (first < sightings_.size() && !isMember(first)) ++first;
    bool isMixed = false;
    for (size_t i = first; i < sightings_.size(); ++i)
      isMixed |= isMember(i) && other(i) != other(first);
    if (!isMixed) return;
    events_.push_back({kind, {}});
    for (size_t i = first; i < sightings_.size(); ++i)
      if (isMember(i)) events_.back().ids.push_back(tracks_[i].id);
  };
  const auto was = [&](size_t i) { return companyBefore_[i]; };
  const auto is = [&](size_t i) { return tracks_[i].company; };
  for (size_t i = 0; i < sightings_.size(); ++i) {
    const uint64_t name = tracks_[i].id;
    tell(EventKind::Merge, name, is, was);
    tell(EventKind::Split, name, was, is);
  }
}

void Tracker::takeEvents(bool isAnotherScene, std::vector<Event>& out) {
  if (isAnotherScene) events_.push_back({EventKind::SceneChanged, {}});
  std::vector<uint64_t>& alive = told_.alive;
  alive.reserve(alive.size() + events_.size());
  // Nothing fails from here on.
  for (const Event& event : events_) {
    if (event.kind == EventKind::ObjectNew) alive.push_back(event.ids.front());
    if (event.kind == EventKind::ObjectEnd) std::erase(alive, event.ids.front());
  }
  std::sort(alive.begin(), alive.end());
  told_.nextId = nextId_;
  events_.swap(out);
  events_.clear();
}

TrackerLegacy Tracker::bequeath() noexcept {
  return std::exchange(told_, {});
}

void Tracker::inherit(TrackerLegacy&& legacy) noexcept {
  told_ = std::move(legacy);
  nextId_ = told_.nextId;
  endsAll_ = true;
}

}  // namespace rg::objects
