// SPDX-License-Identifier: LGPL-2.1-or-later
// What becomes of tracks: their size, their state, their end, whom they share a blob with.
#include "core/base/pixel.hpp"
#include "core/base/time/frame_count.hpp"
#include "core/objects/tracking/tracker.hpp"

#include <algorithm>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;

int32_t mix(int32_t old, int64_t fresh, int64_t oldWeight) {
  return static_cast<int32_t>(divideRounded(old * oldWeight + fresh, oldWeight + 1));
}

/// By how much the opposite edge has come nearer since this one stands.
int closedIn(StandingEdge& edge, int place, int opposite) {
  if (std::abs(place - edge.place) > 1) edge = {place, opposite};
  return std::abs(place - edge.opposite) - std::abs(place - opposite);
}

}  // namespace

/// All of a track's places, speeds and lengths are those in the picture, which moves over the
/// ground, turns and zooms.
void Tracker::moveWithCamera(Track& track, const CameraMotion& camera) {
  const LinearMap change =
      camera.around(track.x / kUnit, (track.foot - track.size.height / 2) / kUnit);
  const std::pair<int32_t*, int32_t*> places[] = {{&track.x, &track.foot},
                                                  {&track.stillX, &track.stillFoot},
                                                  {&track.originX, &track.originFoot},
                                                  {&track.learntX, &track.learntFoot}};
  for (const auto& [x, y] : places) {
    const Point by = camera.since({*x, *y});
    *x = toInt(int64_t{*x} + by.x);
    *y = toInt(int64_t{*y} + by.y);
  }
  const std::pair<int32_t*, int32_t*> directions[] = {{&track.speedX, &track.speedY},
                                                      {&track.steadyX, &track.steadyY},
                                                      {&track.centreX, &track.centreY}};
  for (const auto& [x, y] : directions) {
    const Point now = change.of({*x, *y});
    *x = now.x;
    *y = now.y;
  }
  const int64_t scale = change.scale();
  int32_t* const lengths[] = {&track.size.width, &track.size.height, &track.stillSize.width,
                              &track.stillSize.height};
  for (int32_t* length : lengths) *length = toInt(divideRounded(*length * scale, LinearMap::kOne));
}

/// Whether one end of what is seen stands while the other comes nearer: something stands before it.
bool Tracker::goesBehind(Track& track, const Box& box) const {
  const int fromLeft = closedIn(track.rightEdge, box.right(), box.x);
  const int fromRight = closedIn(track.leftEdge, box.x, box.right());
  const Numbers::Sizes& n = numbers_.sizes;
  return std::max(fromLeft, fromRight) >= std::max(n.closingPx.whole(), n.closing.of(box.width));
}

/// How large a track of unknown size is of which `box` is seen: what the frame's border cuts off
/// was seen before, if it is about to leave.
Extent Tracker::sizeOfPart(const Track& track, const Box& box) const {
  Extent size{box.width * kUnit, box.height * kUnit};
  if (box.x <= 0 || box.right() >= frame_.width)
    size.width = std::max(size.width, track.size.width);
  if (box.y <= 0 || box.bottom() >= frame_.height)
    size.height = std::max(size.height, track.size.height);
  return size;
}

/// Mixes in what is seen of a track that is seen whole.
void Tracker::mixSize(Track& track, const Sighting& s) const {
  const Numbers::Sizes& n = numbers_.sizes;
  const Number samples = isRigid(track)       ? n.rigidSamples
                         : scale_.isUniform() ? n.uniformSamples
                                              : n.otherSamples;
  const int64_t known = std::min<int64_t>(track.sizeSamples, samples.whole());
  const int64_t weight = scale_.isUniform() ? std::max(known, n.otherSamples.whole()) : known;
  const auto share = [](int64_t seen, int64_t usual) {
    return std::abs(seen * kUnit - usual) * 256 / std::max<int64_t>(usual, 1);
  };
  const int64_t change =
      share(s.box.width, track.size.width) + share(s.box.height, track.size.height);
  track.sway =
      static_cast<uint16_t>(mix(track.sway, std::min<int64_t>(change, 256), n.swaySamples.whole()));
  track.size.width = mix(track.size.width, int64_t{s.box.width} * kUnit, weight);
  track.size.height = mix(track.size.height, int64_t{s.box.height} * kUnit, weight);
  countUp(track.sizeSamples);
  if (s.boxCells > 0) {
    const int64_t fill = std::clamp<int64_t>(int64_t{s.cells} * 256 / s.boxCells, 64, 256);
    track.fill = static_cast<uint16_t>(mix(track.fill, fill, n.swaySamples.whole()));
  }
}

/// From a track that was seen whole: its own size and, every half height of its way, the scene's.
void Tracker::learnSize(size_t index, int64_t stepNs, const GroupGrid& e) {
  Track& track = tracks_[index];
  const Sighting& s = sightings_[index];
  if (track.isSeen && s.isSole) track.apartNs += stepNs;
  if (track.isSeen) track.seenNs += stepNs;
  track.partedNs = s.isParted ? track.partedNs + stepNs : 0;
  const Box frame = boundsOf(e.frame);
  const bool isCut = s.box.x <= frame.x || s.box.y <= frame.y || s.box.right() >= frame.right() ||
                     s.box.bottom() >= frame.bottom();
  if (!s.isWhole || !track.isSeen) return;
  const Numbers::Sizes& n = numbers_.sizes;
  const auto isOtherThan = [&](int px, int64_t size) {
    return px * kUnit < n.least * size || px * kUnit > n.most * size;
  };
  const Extent& size = track.size;
  const bool isOther =
      isOtherThan(s.box.width, size.width) || isOtherThan(s.box.height, size.height);
  // Nothing says where it ends beside somebody else.
  const bool isShared = !scale_.isUniform() && !s.isSole;
  if (isCut || isShared || (isOther && !isSizeKnown(track))) {
    if (!isSizeKnown(track)) track.size = sizeOfPart(track, s.box);
    return;
  }
  mixSize(track, s);
}

/// Every half height of a track's way the scene learns from the blob that the track is in, whatever
/// tracks say of sizes: a wrong scale must not confirm itself. Blobs of several things side by side
/// don't count; tracks above each other may be one thing that was taken apart. A row of the picture
/// says nothing of sizes where the camera moves.
void Tracker::learnScale(const GroupGrid& e) {
  if (e.showsMovers) return;
  for (size_t i = 0; i < sightings_.size(); ++i) {
    Track& track = tracks_[i];
    const int64_t dx = track.x - track.learntX, dy = track.foot - track.learntFoot;
    const Numbers::Sizes& n = numbers_.sizes;
    const int64_t half = (scale_.isKnown() ? n.learnEvery : n.learnFirst).of(track.size.height);
    if (!track.isConfirmed || blobOf_[i] == 0 || dx * dx + dy * dy < half * half) continue;
    const Box box = blobs_[blobOf_[i] - 1].box;
    if (box.x <= 0 || box.y <= 0 || box.right() >= e.grid.width || box.bottom() >= e.grid.height)
      continue;
    bool isAlone = true, isOneThing = true;
    for (size_t j = 0; j < sightings_.size(); ++j) {
      if (j == i || blobOf_[j] != blobOf_[i]) continue;
      isAlone = false;
      const Box mine = track.box(), other = tracks_[j].box();
      const int columns = std::min(mine.right(), other.right()) - std::max(mine.x, other.x);
      isOneThing &= 2 * columns >= std::min(mine.width, other.width);
    }
    if (!isOneThing) continue;
    track.learntX = track.x;
    track.learntFoot = track.foot;
    const int unit = e.stepPx * kUnit;
    scale_.learn(track.id, box.bottom() * e.stepPx,
                 {isAlone ? box.width * unit : 0, box.height * unit});
  }
}

/// Whether a box is larger than a track of which the size is known from its own history.
bool Tracker::outgrows(const Track& track, const Box& box) const {
  if (scale_.isUniform()) return false;
  const Numbers::Sizes& n = numbers_.sizes;
  const auto isBeyond = [&](int px, int64_t size) {
    return int64_t{px} * kUnit > n.outgrown * size;
  };
  if (isSizeKnown(track))
    return isBeyond(box.width, track.size.width) || isBeyond(box.height, track.size.height);
  return false;
}

/// Where all things are of one size, a track that isn't was a part of one, or several at once: its
/// box becomes a usual one, and what that leaves over becomes a newcomer.
void Tracker::fitSizeToScene(Track& track) const {
  if (!scale_.isUniform() || isFaithful(track)) return;
  const Extent usual = scale_.at(track.foot / kUnit);
  const auto limit = [](int32_t& value, int64_t expected, Number least, Number most) {
    value = static_cast<int32_t>(std::clamp<int64_t>(value, least.of(expected), most.of(expected)));
  };
  const Numbers::Sizes& n = numbers_.sizes;
  limit(track.size.height, usual.height, n.uniformHeightLeast, n.uniformHeightMost);
  limit(track.size.width, usual.width, n.uniformWidthLeast, n.uniformWidthMost);
}

/// Whether other tracks stand in front of most of this one.
bool Tracker::isCovered(const Track& track) const {
  const Box box = track.box();
  int64_t covered = 0;
  for (const Track& other : tracks_)
    if (other.id != track.id && other.isSeen && other.isConfirmed)
      covered += intersect(other.box(), box).area();
  return covered >= numbers_.life.coveredBy * box.area();
}

/// Whether another track is missing where this one is: they may share what is seen.
bool Tracker::hidesAnother(const Track& track) const {
  return std::any_of(tracks_.begin(), tracks_.end(), [&](const Track& other) {
    return other.id != track.id && other.isConfirmed && other.unseenNs > 0 &&
           !intersect(other.box(), track.box()).isEmpty();
  });
}

/// How far a track has come since it last left its place, in 1/16 px. Of what comes in at the
/// border only the inner edges move, and what only gets smaller there is leaving.
int64_t Tracker::movedBy(const Track& track) const {
  const int64_t dx = track.x - track.stillX, dy = track.foot - track.stillFoot;
  if (track.isConfirmed || !track.isFromBorder)
    return integerSqrt(static_cast<uint64_t>(dx * dx + dy * dy));
  const Box box = inflate(track.box(), 2 * stepPx_);
  const int64_t wider = (track.size.width - track.stillSize.width) / 2;
  const int64_t higher = track.size.height - track.stillSize.height;
  const bool atLeft = box.x <= 0, atRight = box.right() >= frame_.width;
  const bool atTop = box.y <= 0, atBottom = box.bottom() >= frame_.height;
  const auto inwards = [](bool isAtLow, bool isAtHigh, int64_t low, int64_t high) {
    if (isAtLow != isAtHigh) return isAtLow ? high : -low;
    return isAtLow || (low < 0) != (high < 0) ? 0 : std::min(std::abs(low), std::abs(high));
  };
  return inwards(atLeft, atRight, dx - wider, dx + wider) +
         inwards(atTop, atBottom, dy - higher, dy);
}

void Tracker::settleState(Track& track, int64_t stepNs) const {
  // In the middle of the picture only what left something behind appears, and who comes out of
  // somebody: of the former more is asked.
  const Numbers::Life& n = numbers_.life;
  const bool isBelievable = track.isConfirmed || track.isFromBorder || !track.parents.empty();
  const int64_t leave = (isBelievable ? n.leave : n.leaveNew).of(track.size.height);
  track.stillNs += stepNs;
  const bool hasLeft = movedBy(track) > leave && (track.isConfirmed || !track.isStanding);
  if (hasLeft || (!track.isConfirmed && (track.stillNs > n.creep.whole() || track.isStanding))) {
    track.stillNs = 0;
    track.stillX = track.x;
    track.stillFoot = track.foot;
    track.stillSize = track.size;
  }
  track.hasMoved |= track.stillNs == 0 && hasLeft;
  const int64_t wayX = track.x - track.originX, wayY = track.foot - track.originFoot;
  track.hasTravelled |= std::abs(wayX) + std::abs(wayY) >= n.travelled * track.size.width;
  track.isConfirmed |=
      track.hasMoved && track.hits >= n.confirmHits.whole() && track.seenNs >= n.confirm.whole();
  if (!track.isConfirmed) return;
  if (track.isSeen)
    track.state = track.stillNs >= n.still.whole() ? ObjectState::Stopped : ObjectState::Tracked;
  // What was seen for a moment only is not believed to be there when it isn't seen.
  else if (isSizeKnown(track) && track.unseenNs <= n.believed * track.seenNs &&
           (track.unseenNs <= n.miss.whole() ||
            (track.state != ObjectState::Lost && isCovered(track))))
    track.state = ObjectState::Occluded;
  else
    track.state = ObjectState::Lost;
}

/// A new object, and what it came out of if that is still there.
void Tracker::tellNew(const Track& track) {
  events_.push_back({EventKind::ObjectNew, {track.id}});
  for (const Track& parent : tracks_)
    if (!track.parents.empty() && parent.id == track.parents.front() && parent.isConfirmed)
      events_.push_back({EventKind::Split, {parent.id, track.id}});
}

/// Whether the last bit of a track is about to leave the picture: what is seen there next may be
/// somebody who comes in. A portrait tells them apart.
bool Tracker::isLeaving(const Track& track) const {
  const Box box = track.box();
  if (!track.isConfirmed || isFaithful(track) ||
      8 * intersect(box, boundsOf(frame_)).area() >= box.area())
    return false;
  return (box.x < 0 && track.speedX < 0) || (box.right() > frame_.width && track.speedX > 0) ||
         (box.y < 0 && track.speedY < 0) || (box.bottom() > frame_.height && track.speedY > 0);
}

/// States of all tracks; ends those that are gone and says so.
void Tracker::settle(int64_t stepNs, const TrackerParams& params) {
  const Numbers::Life& n = numbers_.life;
  clutter_.age(stepNs);
  if (endsAll_)
    for (const uint64_t id : told_.alive) events_.push_back({EventKind::ObjectEnd, {id}});
  endsAll_ = false;
  trackIndex_.assign(tracks_.size(), 0);
  size_t kept = 0;
  const size_t count = tracks_.size();
  for (size_t i = 0; i < count; ++i) {
    Track& track = tracks_[i];
    const bool wasConfirmed = track.isConfirmed;
    settleState(track, stepNs);
    const Box box = track.box();
    const bool hasLeft = !track.isSeen && frame_.width > 0 &&
                         intersect(box, boundsOf(frame_)).area() < n.gone * box.area();
    const bool isOver = track.isOver || hasLeft || isLeaving(track) ||
                        (track.isConfirmed ? track.unseenNs > params.maxLostNs
                                           : track.unseenNs > n.flicker.whole());
    if (!wasConfirmed && track.isConfirmed) tellNew(track);
    if (isOver) {
      if (track.isConfirmed) events_.push_back({EventKind::ObjectEnd, {track.id}});
      if (!track.isOver && track.seenNs < n.clutter.whole())
        clutter_.learn(intersect(box, boundsOf(frame_)).area() * track.fill / 256);
      continue;
    }
    trackIndex_[i] = static_cast<uint16_t>(kept + 1);
    if (kept != i) tracks_[kept] = std::move(track);
    ++kept;
  }
  tracks_.resize(kept);
  if (kept == count) return;
  for (uint16_t& owner : owner_)
    if (owner != 0) owner = trackIndex_[owner - 1u];
}

}  // namespace rg::objects
