// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/track_sizes.hpp"

#include "core/base/pixel.hpp"
#include "core/base/time/frame_count.hpp"
#include "core/objects/tracking/looks/track_portraits.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;

int32_t mix(int32_t old, int64_t fresh, int64_t oldWeight) {
  return static_cast<int32_t>(divideRounded(old * oldWeight + fresh, oldWeight + 1));
}

/// Mixes in what is seen of a track that is seen whole.
void mixSize(const Sighting& s, const TrackerState& state, Track& track) {
  const Numbers::Sizes& n = state.numbers.sizes;
  const Number samples = state.isRigid(track)      ? n.rigidSamples
                         : state.scale.isUniform() ? n.uniformSamples
                                                   : n.otherSamples;
  const int64_t known = std::min<int64_t>(track.sizeSamples, samples.whole());
  const int64_t weight = state.scale.isUniform() ? std::max(known, n.otherSamples.whole()) : known;
  const auto share = [](int64_t seen, int64_t usual) {
    return std::abs(seen * kUnit - usual) * 256 / std::max<int64_t>(usual, 1);
  };
  const int64_t change =
      share(s.box.width, track.size.width) + share(s.box.height, track.size.height);
  track.sway =
      static_cast<uint16_t>(mix(track.sway, std::min<int64_t>(change, 256), n.swaySamples.whole()));
  Extent seen{s.box.width * kUnit, s.box.height * kUnit};
  if (state.scale.isUniform()) {
    const Extent usual = state.scale.at(track.foot / kUnit);
    seen.width += toInt(n.usual.of(int64_t{usual.width} - seen.width));
    seen.height += toInt(n.usual.of(int64_t{usual.height} - seen.height));
  }
  const bool isWider = !state.scale.isUniform() && !state.isRigid(track) &&
                       state.isSizeKnown(track) && seen.width > track.size.width;
  const int64_t widthWeight = isWider ? std::max(weight, n.widening.of(weight + 1) - 1) : weight;
  track.size.width = mix(track.size.width, seen.width, widthWeight);
  track.size.height = mix(track.size.height, seen.height, weight);
  countUp(track.sizeSamples);
  if (s.boxCells > 0) {
    const int64_t fill = std::clamp<int64_t>(int64_t{s.cells} * 256 / s.boxCells, 64, 256);
    track.fill = static_cast<uint16_t>(mix(track.fill, fill, n.swaySamples.whole()));
  }
}

/// Whether a part of a track has shown to be a thing of its own.
bool losesPart(const Track& track, TrackerState& state) {
  for (Track& part : state.tracks)
    if (part.partOf == track.id && part.isConfirmed && part.isSeen) {
      part.partOf = 0;
      return true;
    }
  return false;
}

/// It is no more than what is seen of it.
void startAnew(const Box& box, Track& track) {
  track.x = (2 * box.x + box.width) * kUnit / 2;
  track.foot = box.bottom() * kUnit;
  track.size = {box.width * kUnit, box.height * kUnit};
  track.portrait.frames = 0;
  track.centreSamples = 0;
}

}  // namespace

void learnSize(size_t index, int64_t stepNs, const GroupGrid& e, TrackerState& state) {
  Track& track = state.tracks[index];
  const Sighting& s = state.sightings[index];
  if (track.isSeen && s.isSole) track.apartNs += stepNs;
  if (track.isSeen) track.seenNs += stepNs;
  if (!state.scale.isUniform()) {
    findParts(index, e, state);
    if (s.isSole && !s.box.isEmpty() && losesPart(track, state)) return startAnew(s.box, track);
  }
  const Box frame = boundsOf(e.frame);
  const bool isCut = s.box.x <= frame.x || s.box.y <= frame.y || s.box.right() >= frame.right() ||
                     s.box.bottom() >= frame.bottom();
  if (!s.isWhole || !track.isSeen) return;
  const Numbers::Sizes& n = state.numbers.sizes;
  const auto isOtherThan = [&](int px, int64_t size) {
    const int64_t seen = int64_t{px} * kUnit;
    return std::abs(seen - size) > n.off * std::max(seen, size);
  };
  const Extent& size = track.size;
  const bool isOther =
      isOtherThan(s.box.width, size.width) || isOtherThan(s.box.height, size.height);
  // Nothing says where it ends beside somebody else.
  const bool isShared = !state.scale.isUniform() && !s.isSole;
  if (!state.isSizeKnown(track) && (isCut || isShared || isOther)) {
    track.size = state.sizeOfPart(track, s.box);
    // What is known agrees frame after frame, or a portrait of before would be found in a part; of
    // what a moving camera shows parts come and go.
    if (isOther && !state.showsMovers) {
      track.sizeSamples = 0;
      track.portrait.frames = 0;
    }
    return;
  }
  if (isCut || isShared) return;
  mixSize(s, state, track);
}

void learnScale(const GroupGrid& e, TrackerState& state) {
  if (e.showsMovers) return;
  for (size_t i = 0; i < state.sightings.size(); ++i) {
    Track& track = state.tracks[i];
    const int64_t dx = track.x - track.learntX, dy = track.foot - track.learntFoot;
    const Numbers::Sizes& n = state.numbers.sizes;
    const int64_t half =
        (state.scale.isKnown() ? n.learnEvery : n.learnFirst).of(track.size.height);
    if (!track.isConfirmed || !state.crowds.has(i) || dx * dx + dy * dy < half * half) continue;
    const Box box = state.crowds.of(i).box;
    if (box.x <= 0 || box.y <= 0 || box.right() >= e.grid.width || box.bottom() >= e.grid.height)
      continue;
    bool isAlone = true, isOneThing = true;
    for (size_t j = 0; j < state.sightings.size(); ++j) {
      if (j == i || !state.crowds.areTogether(j, i)) continue;
      isAlone = false;
      const Box mine = track.box(), other = state.tracks[j].box();
      const int columns = std::min(mine.right(), other.right()) - std::max(mine.x, other.x);
      isOneThing &= 2 * columns >= std::min(mine.width, other.width);
    }
    if (!isOneThing) continue;
    track.learntX = track.x;
    track.learntFoot = track.foot;
    const int unit = e.stepPx * kUnit;
    state.scale.learn(track.id, box.bottom() * e.stepPx,
                      {isAlone ? box.width * unit : 0, box.height * unit});
  }
}

}  // namespace rg::objects
