// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/own_motion.hpp"

#include "core/base/pixel.hpp"
#include "core/objects/operations.hpp"

#include <algorithm>

namespace rg::objects {
namespace {

constexpr int kOwnRounds = 2;  // The first movers show which ground was hidden.
constexpr int kNeighbourRounds = 2;
constexpr int64_t kLeastGainShare = 4;  // A mover gains a grey level for so many pixels.
constexpr int64_t kNoiseUnit = 16;
// In deviations of what noise gains: the best of thousands of shifts, and one that others suggest.
constexpr int64_t kSearchGain = 4;
constexpr int64_t kNoiseGain = 1;
// In noise: by how much a pixel of the same thing can differ where that is more than kAlikeLevels.
// Beyond it shows something else, whatever that is.
constexpr uint64_t kMostNoise = 6;
// What a thing gains grows with its area, all else in U with its lengths. Between frames of other
// sizes it does so, too, as neighbours err alike: a pixel counts once in one of so many a side.
constexpr int64_t kGainSide = 832;
// Pixels that a round compares, but for a row of each region: all of a frame of 800x600, a quarter
// of one of 1920x1080. Beyond it, rows are like those beside them.
constexpr uint64_t kMostCompared = uint64_t{1} << 19;

using segmentation::RegionLabel;
using Sums = OwnMotionScratch::Sums;
using Trial = OwnMotionScratch::Trial;

/// What is given to all steps.
struct Inputs {
  const motion::Motion& motion;
  const ComparedFrame& compared;
  const OwnMotionRules& rules;
  Operations& operations;
};

Point inPixels(Point motion) {
  return {static_cast<int>(divideRounded(motion.x, motion::kMotionUnit)),
          static_cast<int>(divideRounded(motion.y, motion::kMotionUnit))};
}

/// So many rows are left out that the others hold no more than kMostCompared pixels.
void limitWork(const graph::Graph& graph, OwnMotionScratch& s) {
  uint64_t area = 0;
  for (size_t i = 0; i < s.trials.size(); ++i)
    if (s.trials[i].shift != Point{}) area += graph.regions[i].areaPx;
  s.everyRow = static_cast<int>(std::max(uint64_t{1}, (area + kMostCompared - 1) / kMostCompared));
}

bool movesAny(const OwnMotionScratch& s) {
  return std::any_of(s.moves.begin(), s.moves.end(), [](uint8_t moves) { return moves != 0; });
}

bool triesAny(const OwnMotionScratch& s) {
  return std::any_of(s.trials.begin(), s.trials.end(),
                     [](const Trial& trial) { return trial.shift != Point{}; });
}

/// Measures each region that has a shift to try, on pixels that can be compared with and without.
void measure(const Inputs& in, const std::vector<OwnMotion>& own, OwnMotionScratch& s) {
  limitWork(*in.motion.graph, s);
  s.hidesAny = movesAny(s);
  in.operations.compareRegions({in.compared, in.motion, own}, s);
  uint64_t pixels = 0;
  for (const Trial& trial : s.trials) pixels += trial.seen;
  s.mostPixels = std::max(s.mostPixels, pixels);
  ++s.rounds;
}

/// How much a pixel differs from what explains it, over all that is tried.
void measureNoise(OwnMotionScratch& s) {
  uint64_t sum = 0, pixels = 0;
  for (const OwnMotionScratch::Trial& trial : s.trials) {
    sum += std::min(trial.sums.still, trial.sums.moved);
    pixels += trial.sums.pixels;
  }
  s.noise = pixels == 0 ? kNoiseUnit : std::max(uint64_t{kNoiseUnit}, kNoiseUnit * sum / pixels);
  s.mostLevels = static_cast<uint8_t>(
      std::clamp<uint64_t>(kMostNoise * s.noise / kNoiseUnit, kAlikeLevels, 255));
}

/// deviations: of its noise, by as many the gain has to be the larger.
int64_t gainOf(const Sums& sums, int64_t deviations, uint64_t noise) {
  const auto pixels = static_cast<int64_t>(sums.pixels);
  const int64_t gain = static_cast<int64_t>(sums.still - sums.moved) - pixels / kLeastGainShare;
  return kGainUnit * kNoiseUnit * gain / static_cast<int64_t>(noise) -
         kGainUnit * deviations * integerSqrt(sums.pixels);
}

/// The same for all of a region's rows, where those that were compared stand for them.
int64_t gainOfAll(const Trial& trial, int height, int64_t deviations, const OwnMotionScratch& s) {
  const int64_t compared = (height + s.everyRow - 1) / s.everyRow;
  const auto side =
      static_cast<int64_t>(integerSqrt(static_cast<uint64_t>(s.expected.size().area())));
  return gainOf(trial.sums, deviations, s.noise) * height / compared * kGainSide / side;
}

/// What holds each region to what moves, and which of those has the longest border with it.
void lookAround(const graph::Graph& graph, std::span<const ArcEnergy> arcs, OwnMotionScratch& s) {
  s.around.assign(s.moves.size(), {});
  const auto see = [&](RegionLabel region, RegionLabel other, uint32_t borderPx, int64_t hold) {
    OwnMotionScratch::Surroundings& around = s.around[region.index()];
    const bool isMoving = s.moves[other.index()] != 0;
    around.hold += isMoving ? hold : -hold;
    if (!isMoving || borderPx <= around.longest) return;
    around.longest = borderPx;
    around.neighbour = other;
  };
  for (size_t i = 0; i < arcs.size(); ++i) {
    const graph::Arc& arc = graph.arcs[i];
    const int64_t hold = arcs[i].border + arcs[i].arc;
    see(arc.a, arc.b, arc.borderPx, hold);
    see(arc.b, arc.a, arc.borderPx, hold);
  }
}

TrackIndex expectedAs(const OwnMotionRules& rules, size_t region) {
  return rules.expected.empty() ? TrackIndex() : rules.expected[region];
}

/// Whether U is less when a region moves, with its neighbours as they were guessed.
bool isMover(const Inputs& in, size_t region, const OwnMotion& own, const OwnMotionScratch& s) {
  const int64_t area = in.motion.graph->regions[region].areaPx;
  const GroundEnergy ground =
      weighGround(own.gain, area, bool{expectedAs(in.rules, region)}, in.rules.weights);
  return s.around[region].hold > ground.weight();
}

/// Takes over what was measured, and guesses again which of those regions move, by what was seen
/// around them.
void judge(const Inputs& in, int64_t deviations, OwnMotionScratch& s, std::vector<OwnMotion>& own) {
  for (size_t i = 0; i < own.size(); ++i) {
    const OwnMotionScratch::Trial& trial = s.trials[i];
    if (trial.shift == Point{}) continue;
    const int height = in.motion.graph->regions[i].box.height;
    own[i] = {trial.shift, gainOfAll(trial, height, deviations, s)};
    s.moves[i] = isMover(in, i, own[i], s);
  }
}

/// Whether what moves so beyond the camera, in 1/16 px since the earlier frame, may stand still.
bool isParallax(const Inputs& in, size_t region, Point beyond) {
  if (in.rules.parallax == nullptr) return false;
  const TrackIndex track = expectedAs(in.rules, region);
  if (track && in.rules.tracks[track.index()].isFollowed) return false;
  const Point plane = ComparedFrame::at(in.compared.camera, in.motion, region);
  return in.rules.parallax->explains(beyond, plane);
}

/// The shift that a region's own vector suggests, or what it is expected to be.
Point ownShift(const Inputs& in, size_t region) {
  const Point beyond = in.compared.beyondCamera(in.motion, region);
  if (in.compared.showsMotion(in.motion, region) && !isParallax(in, region, beyond))
    return inPixels(beyond);
  const TrackIndex track = expectedAs(in.rules, region);
  if (!track) return {};
  const Point step = in.rules.tracks[track.index()].step;
  const Point by = inPixels(ComparedFrame::at(in.compared.camera, in.motion, region));
  const Point further{step.x - by.x, step.y - by.y};
  constexpr int kUnit = motion::kMotionUnit;
  return isParallax(in, region, {further.x * kUnit, further.y * kUnit}) ? Point{} : further;
}

}  // namespace

void clearOwnMotion(size_t regions, OwnMotionScratch& s, std::vector<OwnMotion>& own) {
  own.assign(regions, {});
  s.moves.assign(regions, 0);
}

void findOwnMotion(const motion::Motion& motion, const ComparedFrame& compared,
                   const OwnMotionRules& rules, Operations& operations, OwnMotionScratch& s,
                   std::vector<OwnMotion>& own) {
  const Inputs in{motion, compared, rules, operations};
  const size_t count = motion.regions.size();
  s.trials.assign(count, {});
  s.mostPixels = 0;
  s.mostLevels = 255;  // Until the noise is known.
  s.rounds = 0;
  for (size_t i = 0; i < count; ++i)
    if (own[i].isTried())
      own[i].shift = compared.sinceThen(own[i].shift);
    else
      s.trials[i].shift = ownShift(in, i);
  if (!triesAny(s)) return;
  operations.expectFrame(compared, s);
  for (int round = 0; round < kOwnRounds; ++round) {
    measure(in, own, s);
    measureNoise(s);
    lookAround(*motion.graph, rules.arcs, s);
    judge(in, kSearchGain, s, own);
    if (!movesAny(s)) return;  // Nothing is hidden then, and nobody has neighbours that move.
  }
  for (int round = 0; round < kNeighbourRounds; ++round) {
    lookAround(*motion.graph, rules.arcs, s);
    s.trials.assign(count, {});
    for (size_t i = 0; i < count; ++i)
      if (const RegionLabel neighbour = s.around[i].neighbour; s.moves[i] == 0 && neighbour)
        s.trials[i].shift = own[neighbour.index()].shift;
    if (!triesAny(s)) return;
    measure(in, own, s);
    judge(in, kNoiseGain, s, own);
  }
}

}  // namespace rg::objects
