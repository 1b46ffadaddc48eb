// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/track_fit.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <tuple>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;

/// Where a track's box is looked for. Its tier is open.
FitTask fitTaskOf(const TrackerState& state, size_t index, const GroupGrid& e, int64_t stepNs) {
  const Track& track = state.tracks[index];
  const Numbers::Fit& n = state.numbers.fit;
  const int cell = e.stepPx * kUnit;
  const int64_t reachNs = n.reach.whole();
  const int64_t since = std::min<int64_t>(stepNs + track.unseenNs, reachNs);
  const auto cells = [&](int64_t v) { return static_cast<int>(divideRounded(v, cell)); };
  const auto within = [&](int64_t most) {
    return std::max(2, static_cast<int>(divideRounded(most * since, reachNs)));
  };
  const auto atFirst = [](int64_t most) { return std::max(1, static_cast<int>(most)); };
  FitTask task;
  task.track = static_cast<uint16_t>(index + 1);
  const int width = std::clamp(cells(track.size.width), 1, 2 * e.grid.width);
  const int height = std::clamp(cells(track.size.height), 1, 2 * e.grid.height);
  task.expected = {cells(int64_t{track.x} - track.size.width / 2), cells(track.foot) - height,
                   width, height};
  const bool isNew = track.hits < n.firstHits.whole();
  task.reachX = isNew ? atFirst(n.firstReachX.of(width)) : within(n.reachX.of(width));
  task.reachY = isNew ? atFirst(n.firstReachY.of(height)) : within(n.reachY.of(height));
  for (int bin = 0; bin < kColourBins && track.look.frames > 0; ++bin) {
    const int share = shareOf(track.look, bin);
    const int bonus = share > n.ownColour.of(kFullMatch)    ? 2
                      : share > n.someColour.of(kFullMatch) ? 1
                      : share > n.fewColour.of(kFullMatch)  ? 0
                                                            : -1;
    task.bonus[static_cast<size_t>(bin)] = static_cast<int16_t>(bonus * state.appearance / 256);
  }
  return task;
}

}  // namespace

void TrackFit::find(const GroupGrid& e, int64_t stepNs, TrackerState& state) {
  state.tasks.clear();
  order_.clear();
  for (size_t i = 0; i < state.tracks.size(); ++i)
    if (state.tracks[i].state != ObjectState::Lost || state.isFaithful(state.tracks[i]))
      order_.push_back(i);
  const auto tierOf = [&](const Track& t) {
    return t.unseenNs > 0 ? 2 : t.isConfirmed && state.isSizeKnown(t) ? 0 : 1;
  };
  std::sort(order_.begin(), order_.end(), [&](size_t a, size_t b) {
    const Track &p = state.tracks[a], &q = state.tracks[b];
    return std::tuple(tierOf(p), -p.foot, p.id) < std::tuple(tierOf(q), -q.foot, q.id);
  });
  for (const size_t i : order_) {
    state.tasks.push_back(fitTaskOf(state, i, e, stepNs));
    state.tasks.back().tier = tierOf(state.tracks[i]);
  }
  fitBoxes(e, state.tasks, scratch_, state.numbers.fit);
  assignCells(e, state.tasks, state.owner, state.numbers.fit);
  e.forParts(state.owner, [&](const Run& part, uint16_t task) {
    if (task == 0) return;
    std::fill_n(state.owner.data() + e.at(part.begin, part.y), part.end - part.begin,
                state.tasks[task - 1u].track);
  });
  state.sightings.assign(state.tracks.size(), {});
  for (size_t t = 0; t < state.tasks.size(); ++t)
    state.sightings[state.tasks[t].trackIndex()].task = static_cast<int>(t);
}

}  // namespace rg::objects
