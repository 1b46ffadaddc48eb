// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/companies.hpp"

namespace rg::objects {

void Companies::find(int64_t stepNs, TrackerState& state) {
  before_.resize(state.sightings.size());
  for (size_t i = 0; i < state.sightings.size(); ++i) {
    Track& track = state.tracks[i];
    if (track.company == 0) track.company = track.id;
    before_[i] = track.company;
    if (!track.isSeen || !track.isConfirmed || !state.crowds.has(i)) continue;
    uint64_t company = track.id;  // Ids are sorted: the first track of the crowd is the smallest.
    for (size_t j = 0; j < i && company == track.id; ++j)
      if (state.crowds.areTogether(j, i) && state.tracks[j].isSeen && state.tracks[j].isConfirmed)
        company = state.tracks[j].id;
    if (company != track.nextCompany) track.companyNs = 0;
    track.nextCompany = company;
    track.companyNs += stepNs;
    if (track.companyNs >= state.numbers.life.settled.whole()) track.company = company;
  }
}

void Companies::tell(const TrackerState& state, std::vector<Event>& events) const {
  const auto tellOne = [&](EventKind kind, uint64_t name, const auto& company, const auto& other) {
    const auto isMember = [&](size_t i) {
      return state.tracks[i].isConfirmed && company(i) == name;
    };
    size_t first = 0;
    while (first < state.sightings.size() && !isMember(first)) ++first;
    bool isMixed = false;
    for (size_t i = first; i < state.sightings.size(); ++i)
      isMixed |= isMember(i) && other(i) != other(first);
    if (!isMixed) return;
    events.push_back({kind, {}});
    for (size_t i = first; i < state.sightings.size(); ++i)
      if (isMember(i)) events.back().ids.push_back(state.tracks[i].id);
  };
  const auto was = [&](size_t i) { return before_[i]; };
  const auto is = [&](size_t i) { return state.tracks[i].company; };
  for (size_t i = 0; i < state.sightings.size(); ++i) {
    const uint64_t name = state.tracks[i].id;
    tellOne(EventKind::Merge, name, is, was);
    tellOne(EventKind::Split, name, was, is);
  }
}

}  // namespace rg::objects
