// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/tracker.hpp"

#include "core/base/pixel.hpp"
#include "core/base/time/frame_count.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

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
  if (s.isMatched && s.share >= n.weakShare * kWhole) return {n.matchGain, n.matchSpeed};
  if (s.isMatched) return {n.weakGain, n.weakSpeed};
  return s.isSole ? Gains{n.soleGain, n.soleSpeed} : Gains{n.otherGain, n.otherSpeed};
}

/// How much of what is usually foreground in its box a track owns, in 1/256.
uint32_t supportOf(const Track& track, const Sighting& s) {
  const uint64_t usual = uint64_t{s.boxCells} * track.fill;
  return usual == 0 ? 0 : static_cast<uint32_t>(uint64_t{s.cells} * 256 * 256 / usual);
}

/// Whether a box is about of a size; legs and arms change a width more than anything a height.
bool isLike(const Box& box, const Extent& size, const Numbers::Place& n) {
  const int64_t height = box.height * int64_t{kUnit}, width = box.width * int64_t{kUnit};
  return height >= n.leastHeight * size.height && height <= n.mostHeight * size.height &&
         width >= n.leastWidth * size.width && width <= n.mostWidth * size.width;
}

/// Whether a box lacks an end of what is expected there.
bool isCutAtOneEnd(const Track& track, const Box& box, bool isRigid, const Numbers::Place& n) {
  const int64_t width = track.size.width;
  const int64_t atLeft = std::abs(int64_t{box.x} * kUnit - (track.x - width / 2));
  const int64_t atRight = std::abs(int64_t{box.right()} * kUnit - (track.x + width / 2));
  return int64_t{box.width} * kUnit < (isRigid ? n.cutRigid : n.cutOther) * width &&
         std::min(atLeft, atRight) <= n.cutOneEnd * std::max(atLeft, atRight);
}

}  // namespace

Place placeOfPart(const Track& track, const Box& part, Size frame) {
  constexpr int64_t kUnseen = INT32_MAX;  // At the frame's border nothing says where it ends.
  const auto offset = [](int64_t low, int64_t high, int64_t expectedLow, int64_t expectedHigh) {
    const int64_t atLow = low - expectedLow, atHigh = high - expectedHigh;
    const int64_t nearest = std::abs(atLow) <= std::abs(atHigh) ? atLow : atHigh;
    return low == kUnseen && high == kUnseen ? 0 : nearest;
  };
  const int64_t left = int64_t{part.x} * kUnit, right = int64_t{part.right()} * kUnit;
  const int64_t top = int64_t{part.y} * kUnit, bottom = int64_t{part.bottom()} * kUnit;
  const int64_t expectedLeft = track.x - track.size.width / 2;
  const int64_t expectedTop = track.foot - track.size.height;
  return {
      track.x + offset(part.x > 0 ? left : kUnseen, part.right() < frame.width ? right : kUnseen,
                       expectedLeft, expectedLeft + track.size.width),
      track.foot + offset(part.y > 0 ? top : kUnseen,
                          part.bottom() < frame.height ? bottom : kUnseen, expectedTop,
                          track.foot)};
}

Box Track::box() const {
  const auto px = [](int64_t v) { return static_cast<int>(divideRounded(v, kUnit)); };
  const int width = std::max(1, px(size.width)), height = std::max(1, px(size.height));
  return {px(int64_t{x} - size.width / 2), px(foot) - height, width, height};
}

void Tracker::reset() {
  endsAll_ = true;
  tracks_.clear();
  encounters_.clear();
  owner_.clear();
}

/// In 1/16 px.
Point Tracker::stepOf(const Track& track, int64_t stepNs) {
  const auto step = [&](int32_t speed) {
    return toInt(int64_t{speed} * (stepNs / 1000) / kSecondUs);
  };
  return {step(track.speedX), step(track.speedY)};
}

Point Tracker::expectedShift(const Track& track, const CameraMotion& camera, int64_t stepNs) {
  const Point step = stepOf(track, stepNs);
  const Point by = camera.since({track.x, track.foot - track.size.height / 2});
  const auto px = [](int64_t v) { return static_cast<int>(divideRounded(v, kUnit)); };
  return {px(int64_t{step.x} + by.x), px(int64_t{step.y} + by.y)};
}

void Tracker::advance(Track& track, int64_t stepNs) const {
  const Extent before = scale_.at(track.foot / kUnit);
  const Point step = stepOf(track, stepNs);
  track.x = toInt(int64_t{track.x} + step.x);
  track.foot = toInt(int64_t{track.foot} + step.y);
  track.ageNs += stepNs;
  countUp(track.ageFrames);
  if (before.height == 0 || (isFaithful(track) && !scale_.isUniform())) return;
  const Extent after = scale_.at(track.foot / kUnit);
  track.size.width = toInt(int64_t{track.size.width} * after.width / before.width);
  track.size.height = toInt(int64_t{track.size.height} * after.height / before.height);
}

void Tracker::predict(int64_t stepNs, const TrackerParams& params) {
  numbers_ = params.numbers;
  events_.clear();
  owner_.clear();
  for (Track& track : tracks_) {
    advance(track, stepNs);
    track.isSeen = false;
    track.unseenNs += stepNs;
  }
  settle(stepNs, params);
}

void Tracker::update(const GroupGrid& evidence, std::span<const Group> groups, int64_t stepNs,
                     const TrackerParams& params) {
  numbers_ = params.numbers;
  events_.clear();
  if (frame_ != evidence.frame || showsMovers_ != evidence.showsMovers) {
    frame_ = evidence.frame;
    scale_.reset(frame_, numbers_.sizes);
  }
  stepPx_ = evidence.stepPx;
  showsMovers_ = evidence.showsMovers;
  for (Track& track : tracks_) {
    moveWithCamera(track, evidence.camera);
    advance(track, stepNs);
    fitSizeToScene(track);
  }
  lookForTracks(evidence, stepNs);
  findBlobs(evidence);
  placeByPortraits(evidence, stepNs);
  giveBlobs(evidence);
  giveGroups(evidence, groups);
  countCells(evidence);
  dropStrangers(evidence);
  findNewcomers(evidence, params);
  sight(evidence);
  meet();
  for (size_t i = 0; i < tracks_.size(); ++i) correct(i, stepNs);
  rejoin(evidence);
  for (size_t i = 0; i < sightings_.size(); ++i) {
    learnSize(i, stepNs, evidence);
    learnPortrait(i, evidence);
  }
  learnScale(evidence);
  joinDoubles(evidence, stepNs);
  judgeIdentities();
  findCompany(stepNs);
  tellCompany();
  settle(stepNs, params);
}

/// Where a track's box is looked for. Its tier is open.
FitTask Tracker::fitTaskOf(size_t index, const GroupGrid& e, int64_t stepNs) const {
  const Track& track = tracks_[index];
  const Numbers::Fit& n = numbers_.fit;
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
    task.bonus[static_cast<size_t>(bin)] = share > n.ownColour.of(kFullMatch)    ? 2
                                           : share > n.someColour.of(kFullMatch) ? 1
                                           : share > n.fewColour.of(kFullMatch)  ? 0
                                                                                 : -1;
  }
  return task;
}

void Tracker::lookForTracks(const GroupGrid& e, int64_t stepNs) {
  tasks_.clear();
  order_.clear();
  for (size_t i = 0; i < tracks_.size(); ++i)
    if (tracks_[i].state != ObjectState::Lost || isFaithful(tracks_[i])) order_.push_back(i);
  const auto tierOf = [&](const Track& t) {
    return t.unseenNs > 0 ? 2 : t.isConfirmed && isSizeKnown(t) ? 0 : 1;
  };
  std::sort(order_.begin(), order_.end(), [&](size_t a, size_t b) {
    const Track &p = tracks_[a], &q = tracks_[b];
    return std::tuple(tierOf(p), -p.foot, p.id) < std::tuple(tierOf(q), -q.foot, q.id);
  });
  for (const size_t i : order_) {
    tasks_.push_back(fitTaskOf(i, e, stepNs));
    tasks_.back().tier = tierOf(tracks_[i]);
  }
  fitBoxes(e, tasks_, fitScratch_, numbers_.fit);
  assignCells(e, tasks_, owner_, numbers_.fit);
  e.forParts(owner_, [&](const Run& part, uint16_t task) {
    if (task == 0) return;
    std::fill_n(owner_.data() + e.at(part.begin, part.y), part.end - part.begin,
                tasks_[task - 1u].track);
  });
  sightings_.assign(tracks_.size(), {});
  for (size_t t = 0; t < tasks_.size(); ++t)
    sightings_[tasks_[t].trackIndex()].task = static_cast<int>(t);
}

/// What each track owns of its fitted box.
void Tracker::countCells(const GroupGrid& e) {
  for (size_t i = 0; i < tracks_.size(); ++i) {
    Sighting& s = sightings_[i];
    if (s.task < 0) continue;
    const Box& fitted = tasks_[static_cast<size_t>(s.task)].fitted;
    const Box box = intersect(fitted, boundsOf(e.grid));
    s.boxCells = static_cast<uint32_t>(box.area());
    for (int y = box.y; y < box.bottom(); ++y) {
      auto& bins = s.look.bins[static_cast<size_t>((y - fitted.y) * kBodyBands / fitted.height)];
      const uint16_t* owner = owner_.data() + e.at(box.x, y);
      const uint8_t* bin = e.bin.data() + e.at(box.x, y);
      for (int x = 0; x < box.width; ++x) {
        const bool isMine = owner[x] == i + 1;
        s.cells += isMine;
        s.othersCells += !isMine && owner[x] != 0;
        if (isMine) ++bins[bin[x]];
      }
    }
  }
}

/// Whether the others in its blob were told by their portraits: what they leave is its own.
bool Tracker::hasTheRest(size_t index) const {
  for (size_t i = 0; i < sightings_.size(); ++i)
    if (i != index && blobOf_[i] == blobOf_[index] && !sightings_[i].isMatched) return false;
  return blobOf_[index] != 0;
}

void Tracker::sight(const GroupGrid& e) {
  const Numbers::Place& n = numbers_.place;
  for (size_t i = 0; i < tracks_.size(); ++i) {
    Sighting& s = sightings_[i];
    if (s.task < 0) continue;
    const Track& track = tracks_[i];
    const bool isSole = blobOf_[i] != 0 && soleTrack_[blobOf_[i]] == i + 1;
    const bool isUsual = isLike(s.box, track.size, n) ||
                         (isSole && isLike(s.box, scale_.at(s.box.bottom()), n)) ||
                         (!isSizeKnown(track) && (isSole || hasTheRest(i)));
    s.isSole = isSole;
    s.isStanding = blobOf_[i] != 0 && isKnownToStand(e, blobs_[blobOf_[i] - 1].group);
    // People's strides, of which a uniform scene is full, are no reason to distrust a box.
    s.isCutOff = isSole && !scale_.isUniform() && isSizeKnown(track) &&
                 isCutAtOneEnd(track, s.box, isRigid(track), n);
    const bool isClosing = isSole && goesBehind(tracks_[i], s.box);
    if (isClosing && isRigid(track)) s.isCutOff = true;
    const bool isAllThere =
        isSole && isAbout(s.box, track) && s.share >= n.allThere * track.portrait.usual;
    s.isWhole = (!s.isMatched || isAllThere) && !s.box.isEmpty() && isUsual && !s.isCutOff &&
                s.othersCells < n.othersShare * s.boxCells;
  }
}

/// Until then a track is what its blob is: it grows with it, and nothing else begins beside it.
bool Tracker::isSizeKnown(const Track& track) const {
  return scale_.isUniform() || track.sizeSamples >= numbers_.place.trustedSamples.whole();
}

/// Whether its box hardly changes: what is missing of it is hidden.
bool Tracker::isRigid(const Track& track) const {
  return !scale_.isUniform() && isSizeKnown(track) && track.sway < numbers_.place.rigidSway.whole();
}

/// Where a track is that is seen whole: by the mean of its pixels, which tells fractions of a pixel
/// that the box does not, and follows no single edge.
Place Tracker::placeOfWhole(Track& track, const Sighting& s) const {
  const int64_t left = int64_t{s.box.x} * kUnit, right = int64_t{s.box.right()} * kUnit;
  const int64_t top = int64_t{s.box.y} * kUnit, bottom = int64_t{s.box.bottom()} * kUnit;
  const Extent size = isSizeKnown(track) ? track.size : sizeOfPart(track, s.box);
  const bool isCut = s.box.x <= 0 || s.box.y <= 0 || s.box.right() >= frame_.width ||
                     s.box.bottom() >= frame_.height;
  Place place{(left + right) / 2, (top + bottom + size.height) / 2};
  if (!isCut && s.areaPx > 0) {
    const auto area = static_cast<int64_t>(s.areaPx);
    const int64_t meanX = divideRounded(s.sumX, 16 * area),
                  meanY = divideRounded(s.sumY, 16 * area);
    const auto learn = [&](int32_t& centre, int64_t seen) {
      const int64_t known =
          std::min<int64_t>(track.centreSamples, numbers_.place.centreSamples.whole());
      centre = toInt(divideRounded(centre * known + seen, known + 1));
    };
    learn(track.centreX, meanX - (left + right) / 2);
    learn(track.centreY, meanY - (top + bottom) / 2);
    countUp(track.centreSamples);
    return {meanX - track.centreX, meanY - track.centreY + size.height / 2};
  }
  if (s.box.x <= 0 && s.box.right() < frame_.width) place.x = right - size.width / 2;
  if (s.box.x > 0 && s.box.right() >= frame_.width) place.x = left + size.width / 2;
  if (s.box.bottom() >= frame_.height) place.foot = top + size.height;
  if (s.box.y <= 0) place.foot = bottom;
  return place;
}

/// Where a track is seen. Of what the scene hides in part the end that is nearest to where it was
/// expected is taken to be its own, the other one to be cut off.
Place Tracker::placeOf(size_t index) {
  Track& track = tracks_[index];
  const Sighting& s = sightings_[index];
  if (s.isWhole) return placeOfWhole(track, s);
  if (s.isMatched) return {s.matched.x, s.matched.y};
  if (!s.box.isEmpty() && s.isSole && !hidesAnother(track))
    return placeOfPart(track, s.box, frame_);
  const FitTask& task = tasks_[static_cast<size_t>(s.task)];
  return {track.x + int64_t{task.fitted.x - task.expected.x} * stepPx_ * kUnit,
          track.foot + int64_t{task.fitted.y - task.expected.y} * stepPx_ * kUnit};
}

/// Nobody sees it: it goes on as it did for a while, not as in the last moment.
void Tracker::miss(Track& track, int64_t stepNs) const {
  const Numbers::Place& n = numbers_.place;
  if (track.unseenNs == 0 && track.centreSamples >= n.steadySamples.whole() && !isCovered(track)) {
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

/// Moves a track to where it was seen.
void Tracker::correct(size_t index, int64_t stepNs) {
  Track& track = tracks_[index];
  const Sighting& s = sightings_[index];
  const Numbers::Place& n = numbers_.place;
  const Number least = track.unseenNs == 0 ? n.seenStill : n.seenAgain;
  track.isSeen =
      s.isMatched || (s.task >= 0 && s.cells > 0 && supportOf(track, s) >= least * int64_t{256});
  track.isWhole = track.isSeen && s.isWhole;
  track.isStanding = track.isSeen && s.isStanding;
  if (!track.isSeen) return miss(track, stepNs);
  const Place place = placeOf(index);
  const int64_t sinceUs = std::max<int64_t>((track.unseenNs + stepNs) / 1000, 1000);
  const int64_t offX = place.x - track.x, offFoot = place.foot - track.foot;
  const Gains gains = gainsOf(track, s, n);
  const auto share = [](Number gain, int64_t off) { return off * gain.num / (16 * gain.den); };
  track.x = toInt(track.x + share(gains.position, offX));
  track.foot = toInt(track.foot + share(gains.position, offFoot));
  track.speedX = toInt(track.speedX + share(gains.speed, offX * kSecondUs) / sinceUs);
  track.speedY = toInt(track.speedY + share(gains.speed, offFoot * kSecondUs) / sinceUs);
  if (s.isWhole || s.share >= n.steadyShare * int64_t{256}) {
    const auto samples =
        static_cast<int32_t>(std::clamp<int64_t>(track.centreSamples, 1, n.steadySamples.whole()));
    track.steadyX += (track.speedX - track.steadyX) / samples;
    track.steadyY += (track.speedY - track.steadyY) / samples;
  }
  track.unseenNs = 0;
  countUp(track.hits);
  learnLook(index);
}

}  // namespace rg::objects
