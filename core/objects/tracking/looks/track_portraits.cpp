// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/looks/track_portraits.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <tuple>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;
constexpr size_t kMostSearched = 32;  // Bounds a crowd.
constexpr int64_t kReachNs = 100'000'000;

/// The cells that a box of pixels touches.
Box cellsOf(const Box& box, int stepPx) {
  const auto down = [&](int v) { return v >= 0 ? v / stepPx : -((stepPx - 1 - v) / stepPx); };
  const int x = down(box.x), y = down(box.y);
  return {x, y, down(box.right() + stepPx - 1) - x, down(box.bottom() + stepPx - 1) - y};
}

PortraitSearch searchOf(const TrackerState& state, size_t index, int64_t stepNs) {
  const Track& track = state.tracks[index];
  const Size size = track.portrait.sizePx;
  const int64_t since = std::min<int64_t>(stepNs + track.unseenNs, 10 * kReachNs);
  // A thing may turn round at once.
  const Point step = expectedShift(track, {}, stepNs);
  const Numbers::Likeness& n = state.numbers.likeness;
  const Point turn{std::min(2 * std::abs(step.x), static_cast<int>(n.turnX.of(size.width))),
                   std::min(2 * std::abs(step.y), static_cast<int>(n.turnY.of(size.height)))};
  const auto within = [&](int length, int turned, int frame) {
    const auto away = static_cast<int>(length * (kReachNs + since) / (10 * kReachNs));
    return std::max(static_cast<int>(n.leastReach.whole()),
                    std::min(away + turned, static_cast<int>(n.mostReach.of(frame))));
  };
  const Point reach{within(size.width, turn.x, state.frame.width),
                    within(size.height / 2, turn.y, state.frame.height)};
  const int calm = static_cast<int>(1 + track.unseenNs / kReachNs);
  return {track.portraitCorner(), reach, calm, turn, state.appearance};
}

/// Where the middle of a portrait's lower edge is that was looked for at `corner`, in 1/16 px.
Point placeOfMatch(const Track& track, Point corner, const PortraitMatch& match) {
  const Size size = track.portrait.sizePx;
  return {corner.x * kUnit + match.shift.x + size.width * kUnit / 2,
          (corner.y + size.height) * kUnit + match.shift.y};
}

}  // namespace

/// The tracks that have a portrait and aren't clear give up their cells; those of clear ones are
/// taken.
void TrackPortraits::list(const GroupGrid& e, TrackerState& state) {
  tasks_.clear();
  if (!e.picture) return;
  isSearched_.assign(state.tracks.size() + 1, 0);
  for (size_t t = 0; t < state.tasks.size(); ++t) {
    const size_t i = state.tasks[t].trackIndex();
    if (!state.isFaithful(state.tracks[i]) || state.isClear(i, e)) continue;
    if (tasks_.size() == kMostSearched) break;
    tasks_.push_back({i, t, {}, {}, {}});
    isSearched_[i + 1] = 1;
  }
  if (tasks_.empty()) return;
  taken_.assign(e.group.size(), 0);
  e.forForeground([&](size_t cell, int, int) {
    const uint16_t owner = state.owner[cell];
    if (owner == 0) return;
    if (isSearched_[owner] != 0)
      state.owner[cell] = 0;
    else if (state.crowds.soleTrack(state.crowds.at(cell)) == owner)
      taken_[cell] = 1;
  });
}

void TrackPortraits::place(const GroupGrid& e, int64_t stepNs, const Executor& executor,
                           TrackerState& state) {
  list(e, state);
  if (tasks_.empty()) return;
  const PortraitScene scene{e, *e.picture, taken_};
  scratch_.resize(static_cast<size_t>(executor.threads()));
  const auto find = [&](Task& task, size_t thread) {
    task.match = findPortrait(state.tracks[task.track].portrait, scene, task.search,
                              scratch_[thread], state.numbers.likeness);
  };
  executor.forEach(static_cast<int>(tasks_.size()), [&](int index, int thread) {
    Task& task = tasks_[static_cast<size_t>(index)];
    task.search = searchOf(state, task.track, stepNs);
    find(task, static_cast<size_t>(thread));
  });
  std::sort(tasks_.begin(), tasks_.end(), [&](const Task& a, const Task& b) {
    return std::tuple(b.match.value(), -state.tracks[a.track].foot, a.track) <
           std::tuple(a.match.value(), -state.tracks[b.track].foot, b.track);
  });
  for (size_t i = 0; i < tasks_.size(); ++i) {
    if (isDisturbed(i, e, state)) find(tasks_[i], 0);
    giveMatch(scene, tasks_[i], state);
  }
  for (const Task& task : tasks_) {
    if (!state.sightings[task.track].isMatched) continue;
    forPortraitCells(state.tracks[task.track].portrait, {e, *e.picture, {}}, task.corner,
                     [&](size_t cell, bool) {
                       if (state.owner[cell] == 0)
                         state.owner[cell] = static_cast<uint16_t>(task.track + 1);
                     });
  }
  state.findBlobsOfTracks(e);
}

/// Whether one that was given its match before has taken cells where this one was looked for.
bool TrackPortraits::isDisturbed(size_t index, const GroupGrid& e,
                                 const TrackerState& state) const {
  const Task& task = tasks_[index];
  const Box searched = searchedBox(state.tracks[task.track].portrait, e, task.search);
  for (size_t i = 0; i < index; ++i) {
    const Task& other = tasks_[i];
    const Size size = state.tracks[other.track].portrait.sizePx;
    const Box taken = inflate({other.corner.x, other.corner.y, size.width, size.height}, e.stepPx);
    if (state.sightings[other.track].isMatched && !intersect(searched, taken).isEmpty())
      return true;
  }
  return false;
}

/// What is found of a track is its own; where too little is, it is hidden.
void TrackPortraits::giveMatch(const PortraitScene& scene, Task& task, TrackerState& state) {
  const Track& track = state.tracks[task.track];
  const PortraitMatch& match = task.match;
  Sighting& s = state.sightings[task.track];
  // A sliver tells of what keeps its shape.
  const Numbers::Likeness& n = state.numbers.likeness;
  const int64_t least = (state.isRigid(track) ? n.rigidShare : n.leastShare).of(match.inside());
  if (match.agreeing < std::max(n.leastAgreeing.whole(), least) ||
      match.agreeing < n.agreeing * match.seen) {
    s.task = -1;
    return;
  }
  const Point corner = track.portraitCorner();
  const auto px = [](int sixteenths) { return static_cast<int>(divideRounded(sixteenths, 16)); };
  task.corner = {corner.x + px(match.shift.x), corner.y + px(match.shift.y)};
  s.isMatched = true;
  s.share = match.share();
  s.matched = placeOfMatch(track, corner, match);
  s.corner = task.corner;
  forPortraitCells(track.portrait, scene, task.corner, [&](size_t cell, bool isAlike) {
    if (!isAlike || state.owner[cell] != 0) return;
    state.owner[cell] = static_cast<uint16_t>(task.track + 1);
    taken_[cell] = 1;
  });
  state.tasks[task.fit].fitted = cellsOf(
      {task.corner.x, task.corner.y, track.portrait.sizePx.width, track.portrait.sizePx.height},
      scene.evidence.stepPx);
}

// What stands in front of a part of a track looks otherwise than that part did.
void findParts(size_t index, const GroupGrid& e, TrackerState& state) {
  const Track& track = state.tracks[index];
  if (!state.sightings[index].isMatched) return;
  for (size_t part = index + 1; part < state.tracks.size(); ++part) {
    Track& other = state.tracks[part];
    if (other.isConfirmed || other.parents.empty() || other.parents.front() != track.id) continue;
    const Box box = intersect(cellsOf(other.box(), e.stepPx), boundsOf(e.grid));
    uint32_t cells = 0, alike = 0;
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x) cells += state.owner[e.at(x, y)] == part + 1;
    forPortraitCells(
        track.portrait, {e, *e.picture, {}}, state.sightings[index].corner,
        [&](size_t cell, bool isAlike) { alike += isAlike && state.owner[cell] == part + 1; });
    if (cells > 0 && alike >= state.numbers.likeness.part * cells) other.partOf = track.id;
  }
}

void learnPortrait(size_t index, const GroupGrid& e, TrackerState& state) {
  Track& track = state.tracks[index];
  const Sighting& s = state.sightings[index];
  if (!e.picture || !track.isSeen || !s.isWhole || !s.isSole || s.isMatched) return;
  const Box frame = boundsOf(e.frame);
  if (s.box.x <= frame.x || s.box.y <= frame.y || s.box.right() >= frame.right() ||
      s.box.bottom() >= frame.bottom())
    return;
  const auto px = [](int32_t v) { return std::max(1, static_cast<int>(divideRounded(v, kUnit))); };
  const Size size{px(track.size.width), px(track.size.height)};
  if (track.portrait.frames == 0) track.portrait.sizePx = size;
  learn(track.portrait, {e, *e.picture, {}}, track.portraitCorner(), size, state.owner,
        static_cast<uint16_t>(index + 1));
}

}  // namespace rg::objects
