// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/tracker_state.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;

}  // namespace

void TrackerState::findBlobsOfTracks(const GroupGrid& e) {
  for (Blobs* found : {&blobs, &crowds}) found->findOwners(e, tasks, owner, tracks.size());
}

void TrackerState::exchangeSightings(size_t a, size_t b) {
  std::swap(sightings[a], sightings[b]);
  for (Blobs* found : {&blobs, &crowds}) found->exchange(a, b);
}

bool TrackerState::isSizeKnown(const Track& track) const {
  return scale.isUniform() || track.sizeSamples >= numbers.place.trustedSamples.whole();
}

bool TrackerState::isRigid(const Track& track) const {
  return !scale.isUniform() && isSizeKnown(track) && track.sway < numbers.place.rigidSway.whole();
}

bool TrackerState::isFaithful(const Track& track) const {
  const Numbers::Likeness& n = numbers.likeness;
  return appearance > 0 && track.portrait.frames >= n.knownFrames.whole() &&
         track.portrait.usual >= n.faithful * int64_t{256};
}

bool TrackerState::isAbout(const Box& box, const Track& track) const {
  const Number about = numbers.likeness.about;
  const auto isNear = [&](int px, int32_t size) {
    return std::abs(int64_t{px} * kUnit - size) <=
           std::max<int64_t>(2 * stepPx * kUnit, about.of(size));
  };
  return isNear(box.width, track.size.width) && isNear(box.height, track.size.height);
}

bool TrackerState::isClear(size_t index, const GroupGrid& e) const {
  const Track& track = tracks[index];
  if (!crowds.isAlone(index) || track.unseenNs > 0) return false;
  const Box& box = crowds.of(index).box;
  if (box.x <= 0 || box.y <= 0 || box.right() >= e.grid.width || box.bottom() >= e.grid.height)
    return false;
  return isAbout({box.x * e.stepPx, box.y * e.stepPx, box.width * e.stepPx, box.height * e.stepPx},
                 track);
}

bool TrackerState::outgrows(const Track& track, const Box& box) const {
  const auto isBeyond = [&](int px, int64_t size) {
    return int64_t{px} * kUnit > numbers.sizes.outgrown * size;
  };
  return !scale.isUniform() && isSizeKnown(track) &&
         (isBeyond(box.width, track.size.width) || isBeyond(box.height, track.size.height));
}

bool TrackerState::isCovered(const Track& track) const {
  const Box box = track.box();
  int64_t covered = 0;
  for (const Track& other : tracks)
    if (other.id != track.id && other.isSeen && other.isConfirmed)
      covered += intersect(other.box(), box).area();
  return covered >= numbers.life.coveredBy * box.area();
}

Extent TrackerState::sizeOfPart(const Track& track, const Box& box) const {
  Extent size{box.width * kUnit, box.height * kUnit};
  if (box.x <= 0 || box.right() >= frame.width) size.width = std::max(size.width, track.size.width);
  if (box.y <= 0 || box.bottom() >= frame.height)
    size.height = std::max(size.height, track.size.height);
  return size;
}

int64_t TrackerState::weighed(int similarity) const {
  return kFullMatch - int64_t{appearance} * (kFullMatch - similarity) / 256;
}

const Track* TrackerState::find(uint64_t id) const {
  const auto at = std::lower_bound(tracks.begin(), tracks.end(), id,
                                   [](const Track& track, uint64_t key) { return track.id < key; });
  return at != tracks.end() && at->id == id ? &*at : nullptr;
}

Track* TrackerState::find(uint64_t id) {
  return const_cast<Track*>(std::as_const(*this).find(id));
}

}  // namespace rg::objects
