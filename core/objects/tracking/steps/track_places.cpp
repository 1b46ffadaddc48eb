// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/track_places.hpp"

#include "core/base/pixel.hpp"
#include "core/base/time/frame_count.hpp"
#include "core/objects/tracking/steps/encounters.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg::objects {
namespace {

constexpr int64_t kSecondUs = 1'000'000;
constexpr int kUnit = kPositionUnit;

/// Gains in 1/16 of how far a sighting moves position and speed.
struct Gains {
  Number position, speed;
};

Gains gainsOf(const Track& track, const Sighting& s, const Numbers::Place& n) {
  constexpr int64_t kWhole = 256;
  if (track.hits <= 2) return {n.firstGain, n.firstSpeed};
  if (track.hits <= 4) return {n.earlyGain, n.earlySpeed};
  if (s.isWhole || (s.isMatched && s.share >= n.sharpShare * kWhole))
    return {n.wholeGain, n.wholeSpeed};
  return s.isSole ? Gains{n.soleGain, n.soleSpeed} : Gains{n.otherGain, n.otherSpeed};
}

/// How much of what is usually foreground in its box a track owns, in 1/256.
uint32_t supportOf(const Track& track, const Sighting& s) {
  const uint64_t usual = uint64_t{s.boxCells} * track.fill;
  return usual == 0 ? 0 : static_cast<uint32_t>(uint64_t{s.cells} * 256 * 256 / usual);
}

/// Where a track is that is seen whole: by the mean of its pixels, which tells fractions of a pixel
/// that the box does not, and follows no single edge.
Place placeOfWhole(Track& track, const Sighting& s, const TrackerState& state) {
  const int64_t left = int64_t{s.box.x} * kUnit, right = int64_t{s.box.right()} * kUnit;
  const int64_t top = int64_t{s.box.y} * kUnit, bottom = int64_t{s.box.bottom()} * kUnit;
  const Extent size = state.isSizeKnown(track) ? track.size : state.sizeOfPart(track, s.box);
  const bool isCut = s.box.x <= 0 || s.box.y <= 0 || s.box.right() >= state.frame.width ||
                     s.box.bottom() >= state.frame.height;
  Place place{(left + right) / 2, (top + bottom + size.height) / 2};
  if (!isCut && s.areaPx > 0) {
    const auto area = static_cast<int64_t>(s.areaPx);
    const int64_t meanX = divideRounded(s.sumX, 16 * area),
                  meanY = divideRounded(s.sumY, 16 * area);
    const auto learn = [&](int32_t& centre, int64_t seen) {
      const int64_t known =
          std::min<int64_t>(track.centreSamples, state.numbers.place.centreSamples.whole());
      centre = toInt(divideRounded(centre * known + seen, known + 1));
    };
    learn(track.centreX, meanX - (left + right) / 2);
    learn(track.centreY, meanY - (top + bottom) / 2);
    countUp(track.centreSamples);
    return {meanX - track.centreX, meanY - track.centreY + size.height / 2};
  }
  if (s.box.x <= 0 && s.box.right() < state.frame.width) place.x = right - size.width / 2;
  if (s.box.x > 0 && s.box.right() >= state.frame.width) place.x = left + size.width / 2;
  if (s.box.bottom() >= state.frame.height) place.foot = top + size.height;
  if (s.box.y <= 0) place.foot = bottom;
  return place;
}

/// Where a track is seen. Of what the scene hides in part the end that is nearest to where it was
/// expected is taken to be its own, the other one to be cut off.
Place placeOf(size_t index, TrackerState& state) {
  Track& track = state.tracks[index];
  const Sighting& s = state.sightings[index];
  if (s.isWhole) return placeOfWhole(track, s, state);
  if (s.isMatched) return {s.matched.x, s.matched.y};
  if (!s.box.isEmpty() && s.isSole) return placeOfPart(track, s.box, state.frame);
  const FitTask& task = state.tasks[static_cast<size_t>(s.task)];
  return {track.x + int64_t{task.fitted.x - task.expected.x} * state.stepPx * kUnit,
          track.foot + int64_t{task.fitted.y - task.expected.y} * state.stepPx * kUnit};
}

/// Nobody sees it: it goes on as it did for a while, not as in the last moment.
void miss(Track& track, int64_t stepNs, const TrackerState& state) {
  const Numbers::Place& n = state.numbers.place;
  if (track.unseenNs == 0 && track.centreSamples >= n.steadySamples.whole() &&
      !state.isCovered(track)) {
    const auto isNear = [&](int32_t speed, int32_t steady, int32_t size) {
      return std::abs(speed - steady) <=
             std::max(n.slowing.of(std::abs(steady)), n.slowing.of(size));
    };
    if (isNear(track.speedX, track.steadyX, track.size.width) &&
        isNear(track.speedY, track.steadyY, track.size.height)) {
      track.speedX = track.steadyX;
      track.speedY = track.steadyY;
    }
  }
  track.unseenNs += stepNs;
}

}  // namespace

void advance(int64_t stepNs, const TrackerState& state, Track& track) {
  const Extent before = state.scale.at(track.foot / kUnit);
  const Point step = expectedStep(track, stepNs);
  track.x = toInt(int64_t{track.x} + step.x);
  track.foot = toInt(int64_t{track.foot} + step.y);
  track.ageNs += stepNs;
  countUp(track.ageFrames);
  if (before.height == 0 || (state.isFaithful(track) && !state.scale.isUniform())) return;
  const Extent after = state.scale.at(track.foot / kUnit);
  track.size.width = toInt(int64_t{track.size.width} * after.width / before.width);
  track.size.height = toInt(int64_t{track.size.height} * after.height / before.height);
}

void correct(size_t index, int64_t stepNs, TrackerState& state) {
  Track& track = state.tracks[index];
  const Sighting& s = state.sightings[index];
  const Numbers::Place& n = state.numbers.place;
  const Number least = track.unseenNs == 0 ? n.seenStill : n.seenAgain;
  track.isSeen =
      s.isMatched || (s.task >= 0 && s.cells > 0 && supportOf(track, s) >= least * int64_t{256});
  track.isWhole = track.isSeen && s.isWhole;
  track.isStanding = track.isSeen && s.isStanding;
  if (!track.isSeen) return miss(track, stepNs, state);
  const Place place = placeOf(index, state);
  const int64_t sinceUs = std::max<int64_t>((track.unseenNs + stepNs) / 1000, 1000);
  const int64_t offX = place.x - track.x, offFoot = place.foot - track.foot;
  const Gains gains = gainsOf(track, s, n);
  const auto share = [](Number gain, int64_t off) { return off * gain.num / (16 * gain.den); };
  track.x = toInt(track.x + share(gains.position, offX));
  track.foot = toInt(track.foot + share(gains.position, offFoot));
  const Point speed = track.stepSpeed.value_or(Point{track.speedX, track.speedY});
  track.speedX = toInt(speed.x + share(gains.speed, offX * kSecondUs) / sinceUs);
  track.speedY = toInt(speed.y + share(gains.speed, offFoot * kSecondUs) / sinceUs);
  if (s.isWhole || s.share >= n.steadyShare * int64_t{256}) {
    const auto samples =
        static_cast<int32_t>(std::clamp<int64_t>(track.centreSamples, 1, n.steadySamples.whole()));
    track.steadyX += (track.speedX - track.steadyX) / samples;
    track.steadyY += (track.speedY - track.steadyY) / samples;
  }
  track.unseenNs = 0;
  countUp(track.hits);
  learnLook(index, state);
}

}  // namespace rg::objects
