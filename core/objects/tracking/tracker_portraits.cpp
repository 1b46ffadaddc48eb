// SPDX-License-Identifier: LGPL-2.1-or-later
// Where tracks are that share a blob or of which only a part is seen: by their portraits.
#include "core/base/pixel.hpp"
#include "core/objects/tracking/tracker.hpp"

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

/// Middle of the lower edge, in 1/16 px.
Point placeOfMatch(const Track& track, Point corner, const PortraitMatch& match) {
  const Size size = track.portrait.sizePx;
  return {corner.x * kUnit + match.shift.x + size.width * kUnit / 2,
          (corner.y + size.height) * kUnit + match.shift.y};
}

}  // namespace

Point Track::portraitCorner(Point camera) const {
  const auto px = [](int64_t v) { return static_cast<int>(divideRounded(v, kUnit)); };
  const Size sizePx = portrait.sizePx;
  return {px(x + camera.x - int64_t{sizePx.width} * kUnit / 2),
          px(int64_t{foot} + camera.y) - sizePx.height};
}

bool Tracker::isFaithful(const Track& track) const {
  const Numbers::Likeness& n = numbers_.likeness;
  return track.portrait.frames >= n.knownFrames.whole() &&
         track.portrait.usual >= n.faithful * int64_t{256};
}

/// Whether a box of pixels is as large as a track, but for two cells or an eighth.
bool Tracker::isAbout(const Box& box, const Track& track) const {
  const Number about = numbers_.likeness.about;
  const auto isNear = [&](int px, int32_t size) {
    return std::abs(int64_t{px} * kUnit - size) <=
           std::max<int64_t>(2 * stepPx_ * kUnit, about.of(size));
  };
  return isNear(box.width, track.size.width) && isNear(box.height, track.size.height);
}

/// Whether the blob that a track has for itself is as large as it should be.
bool Tracker::isClear(size_t index, const GroupGrid& e) const {
  const uint32_t blob = blobOf_[index];
  if (blob == 0 || soleTrack_[blob] != index + 1) return false;
  const Track& track = tracks_[index];
  if (track.unseenNs > 0) return false;
  const Box& box = blobs_[blob - 1].box;
  if (box.x <= 0 || box.y <= 0 || box.right() >= e.grid.width || box.bottom() >= e.grid.height)
    return false;
  return isAbout({box.x * e.stepPx, box.y * e.stepPx, box.width * e.stepPx, box.height * e.stepPx},
                 track);
}

/// The tracks that have a portrait and aren't clear give up their cells; those of clear ones are
/// taken.
void Tracker::listPortraits(const GroupGrid& e) {
  portraitTasks_.clear();
  if (!e.picture) return;
  isSearched_.assign(tracks_.size() + 1, 0);
  for (size_t t = 0; t < tasks_.size(); ++t) {
    const size_t i = tasks_[t].trackIndex();
    if (!isFaithful(tracks_[i]) || isClear(i, e)) continue;
    if (portraitTasks_.size() == kMostSearched) break;
    portraitTasks_.push_back({i, t, {}, {}, {}});
    isSearched_[i + 1] = 1;
  }
  if (portraitTasks_.empty()) return;
  taken_.assign(e.group.size(), 0);
  e.forForeground([&](size_t cell, int, int) {
    const uint16_t owner = owner_[cell];
    if (owner == 0) return;
    if (isSearched_[owner] != 0)
      owner_[cell] = 0;
    else if (soleTrack_[blobScratch_.label[cell]] == owner)
      taken_[cell] = 1;
  });
}

/// Whether nothing is missing of a track: its blob is all that it usually is.
bool Tracker::isComplete(size_t index, const GroupGrid& e) const {
  return isFaithful(tracks_[index]) && isClear(index, e);
}

/// Who is seen best stands in front and takes its place first; the others are looked for in what it
/// leaves.
void Tracker::placeByPortraits(const GroupGrid& e, int64_t stepNs) {
  listPortraits(e);
  std::vector<PortraitTask>& tasks = portraitTasks_;
  if (tasks.empty()) return;
  const PortraitScene scene{e, *e.picture, taken_};
  for (PortraitTask& task : tasks) {
    task.search = searchOf(task.track, stepNs);
    task.match = findTrack(scene, task);
  }
  std::sort(tasks.begin(), tasks.end(), [&](const PortraitTask& a, const PortraitTask& b) {
    return std::tuple(b.match.value(), -tracks_[a.track].foot, a.track) <
           std::tuple(a.match.value(), -tracks_[b.track].foot, b.track);
  });
  for (size_t i = 0; i < tasks.size(); ++i) {
    if (isDisturbed(i, e)) tasks[i].match = findTrack(scene, tasks[i]);
    giveMatch(scene, tasks[i]);
  }
  for (const PortraitTask& task : tasks) {
    if (!sightings_[task.track].isMatched) continue;
    forPortraitCells(tracks_[task.track].portrait, {e, *e.picture, {}}, task.corner,
                     [&](size_t cell, bool) {
                       if (owner_[cell] == 0) owner_[cell] = static_cast<uint16_t>(task.track + 1);
                     });
  }
  findOwnBlobs(e);
}

PortraitSearch Tracker::searchOf(size_t index, int64_t stepNs) const {
  const Track& track = tracks_[index];
  const Size size = track.portrait.sizePx;
  const int64_t since = std::min<int64_t>(stepNs + track.unseenNs, 10 * kReachNs);
  // A thing may turn round at once.
  const Point step = expectedShift(track, {}, stepNs);
  const Numbers::Likeness& n = numbers_.likeness;
  const Point turn{std::min(2 * std::abs(step.x), static_cast<int>(n.turnX.of(size.width))),
                   std::min(2 * std::abs(step.y), static_cast<int>(n.turnY.of(size.height)))};
  const auto within = [&](int length, int turned, int frame) {
    const auto away = static_cast<int>(length * (kReachNs + since) / (10 * kReachNs));
    return std::max(static_cast<int>(n.leastReach.whole()),
                    std::min(away + turned, static_cast<int>(n.mostReach.of(frame))));
  };
  const Point reach{within(size.width, turn.x, frame_.width),
                    within(size.height / 2, turn.y, frame_.height)};
  const int calm = static_cast<int>(1 + track.unseenNs / kReachNs);
  return {track.portraitCorner(), reach, calm, turn};
}

PortraitMatch Tracker::findTrack(const PortraitScene& scene, const PortraitTask& task) {
  return findPortrait(tracks_[task.track].portrait, scene, task.search, portraitScratch_,
                      numbers_.likeness);
}

/// Whether one that was given its match before has taken cells where this one was looked for.
bool Tracker::isDisturbed(size_t index, const GroupGrid& e) const {
  const PortraitTask& task = portraitTasks_[index];
  const Box searched = searchedBox(tracks_[task.track].portrait, e, task.search);
  for (size_t i = 0; i < index; ++i) {
    const PortraitTask& other = portraitTasks_[i];
    const Size size = tracks_[other.track].portrait.sizePx;
    const Box taken = inflate({other.corner.x, other.corner.y, size.width, size.height}, e.stepPx);
    if (sightings_[other.track].isMatched && !intersect(searched, taken).isEmpty()) return true;
  }
  return false;
}

/// What is found of a track is its own; where too little is, it is hidden.
void Tracker::giveMatch(const PortraitScene& scene, PortraitTask& task) {
  const Track& track = tracks_[task.track];
  const PortraitMatch& match = task.match;
  Sighting& s = sightings_[task.track];
  // A sliver tells of what keeps its shape.
  const Numbers::Likeness& n = numbers_.likeness;
  const int64_t least = (isRigid(track) ? n.rigidShare : n.leastShare).of(match.inside());
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
  forPortraitCells(track.portrait, scene, task.corner, [&](size_t cell, bool isAlike) {
    if (!isAlike || owner_[cell] != 0) return;
    owner_[cell] = static_cast<uint16_t>(task.track + 1);
    taken_[cell] = 1;
  });
  tasks_[task.fit].fitted = cellsOf(
      {task.corner.x, task.corner.y, track.portrait.sizePx.width, track.portrait.sizePx.height},
      scene.evidence.stepPx);
}

/// Where a track's lower edge has its middle, in 1/16 px, if a newcomer is its left or right part.
std::optional<Point> Tracker::recognise(const GroupGrid& e, const Track& track,
                                        const Newcomer& newcomer) {
  if (!isFaithful(track) || !e.picture) return {};
  const Size size = track.portrait.sizePx;
  const PortraitScene scene{e, *e.picture, {}};
  const Numbers::Likeness& n = numbers_.likeness;
  std::optional<Point> best;
  uint32_t most = 0;
  for (const int x : {newcomer.box.x, newcomer.box.right() - size.width}) {
    const Point corner{x, newcomer.box.bottom() - size.height};
    const PortraitMatch match = findPortrait(
        track.portrait, scene, {corner, {4, 4}, static_cast<int>(n.farFrom.whole()), {}},
        portraitScratch_, n);
    if (match.agreeing < n.sliver * match.samples || match.agreeing < n.sliverAgreeing * match.seen)
      continue;
    if (match.agreeing <= most) continue;
    most = match.agreeing;
    best = placeOfMatch(track, corner, match);
  }
  return best;
}

void Tracker::learnPortrait(size_t index, const GroupGrid& e) {
  Track& track = tracks_[index];
  const Sighting& s = sightings_[index];
  if (!e.picture || !track.isSeen || !s.isWhole || !s.isSole || s.isMatched) return;
  const Box frame = boundsOf(e.frame);
  if (s.box.x <= frame.x || s.box.y <= frame.y || s.box.right() >= frame.right() ||
      s.box.bottom() >= frame.bottom())
    return;
  const auto px = [](int32_t v) { return std::max(1, static_cast<int>(divideRounded(v, kUnit))); };
  const Size size{px(track.size.width), px(track.size.height)};
  if (track.portrait.frames == 0) track.portrait.sizePx = size;
  learn(track.portrait, {e, *e.picture, {}}, track.portraitCorner(), size, owner_,
        static_cast<uint16_t>(index + 1));
}

}  // namespace rg::objects
