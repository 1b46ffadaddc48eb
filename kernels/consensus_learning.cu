// SPDX-License-Identifier: LGPL-2.1-or-later
// What a frame teaches the consensus model: a thread for each pixel does in its turn what core does
// row by row, for no pixel looks at what another one's model becomes.
#include "core/background/models/consensus_turns.hpp"
#include "core/base/pixel.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::kSamples;

struct Lesson {
  Planes picture;
  LearntFrame seen;
  ModelView model;
  rg::background::LearningTurns turns;
  uint32_t frame, noisePeriod, calmPeriod;
  bool isFirst;
};

__device__ bool isForeground(const Lesson& lesson, Point p) {
  return isSet(lesson.seen.foreground, p.x, p.y);
}

__device__ void followNoise(const Lesson& lesson, Point p) {
  const ModelView& model = lesson.model;
  int nearest = 31;
  for (int k = 0; k < kSamples; ++k) {
    int most = 0;
    for (int c = 0; c < model.channels; ++c)
      most = std::max(most, absDiff(lesson.picture.planes[c].at(p.x, p.y), *model.sample(p, k, c)));
    nearest = std::min(nearest, most);
  }
  uint8_t& noise = model.noise.at(p.x, p.y);
  noise = rg::background::followedNoise(noise, nearest);
}

__device__ void followUnrest(const Lesson& lesson, Point p, uint32_t turn) {
  uint8_t& unrest = lesson.model.unrest.at(p.x, p.y);
  const bool hasFlipped =
      isSet(lesson.seen.raw, p.x, p.y) != isSet(lesson.seen.previousRaw, p.x, p.y);
  if (!lesson.isFirst && hasFlipped)
    unrest = rg::background::raisedUnrest(unrest, isSet(lesson.seen.previousNear, p.x, p.y));
  if (turn % lesson.calmPeriod == 0) unrest = rg::background::calmedUnrest(unrest);
}

/// The pixel remembers what it sees at `offset`, if it is drawn and that is background.
__device__ void remember(const Lesson& lesson, Point p, uint64_t seed, Point offset) {
  const uint64_t dice = rg::background::diceOf(seed, p.x / kWordColumns);
  if (!rg::background::isDrawn(dice, p.x % kWordColumns, lesson.turns.limit)) return;
  const Point from{p.x + offset.x, p.y + offset.y};
  if (!boundsOf(lesson.model.size).contains(from) || isForeground(lesson, from)) return;
  const int sample = static_cast<int>(seed % kSamples);
  for (int c = 0; c < lesson.model.channels; ++c)
    *lesson.model.sample(p, sample, c) = lesson.picture.planes[c].at(from.x, from.y);
}

__global__ void learnPixels(const __grid_constant__ Lesson lesson) {
  const Point p = pixelOfThread();
  if (!isWithin(p, lesson.model.size)) return;
  const uint32_t turn = static_cast<uint32_t>(p.y) + lesson.frame;
  if (turn % lesson.noisePeriod == 0 && !isSet(lesson.seen.near, p.x, p.y)) followNoise(lesson, p);
  if (isForeground(lesson, p)) return;
  followUnrest(lesson, p, turn);
  if (turn % lesson.turns.period != 0) return;
  // Restless pixels see more colours and must learn them faster: a second round.
  const uint32_t rounds = lesson.model.unrest.at(p.x, p.y) >= 128 ? 4 : 2;
  for (uint32_t round = 0; round < rounds; round += 2) {
    const rg::background::Draw draw = rg::background::drawOf(lesson.frame, p.y, round);
    remember(lesson, p, draw.own, {});
    remember(lesson, p, draw.other, draw.offset);
  }
}

}  // namespace

void learn(const Planes& picture, const LearntFrame& seen,
           const rg::background::ConsensusRate& rate, const ModelView& model, Stream stream) {
  const uint32_t noisePeriod =
      rate.isFirst ? rg::background::kFirstNoisePeriod : rg::background::kNoisePeriod;
  const Lesson lesson{
      picture,    seen,        model,           rg::background::turnsOf(rate.interval),
      rate.frame, noisePeriod, rate.calmPeriod, rate.isFirst};
  const auto pixels = static_cast<double>(model.size.area());
  // Masks and unrest of all pixels; the samples of the rows whose noise has its turn, and what is
  // remembered, in sectors of 32 bytes.
  const double bytes = pixels * (0.625 + 0.25 + (kSamples + 1.0) * model.channels / noisePeriod +
                                 8.0 * model.channels / rate.interval);
  start(launchOver("learn", model.size, 1, {bytes, 20 * pixels}), stream, learnPixels, lesson);
}

}  // namespace rg::gpu::background
