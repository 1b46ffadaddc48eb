// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/operations.hpp"

#include "core/background/scene_watch.hpp"
#include "core/background/shadows/shadow.hpp"

namespace rg::background {

void Operations::smooth(const Picture& picture, SmoothPicture& out) {
  background::smooth(picture, executor_, out);
}

void Operations::smoothAndJudge(const Picture& picture, const ConsensusBackground& model,
                                const Tolerance& tolerance, const JudgedPicture& out) {
  background::smoothAndJudge(picture, model, tolerance, executor_, out);
}

void Operations::judge(const SmoothPicture& picture, const ConsensusBackground& model,
                       const Tolerance& tolerance, Verdicts& out) {
  background::judge(picture, model, tolerance, executor_, out);
}

void Operations::fillFrom(const SmoothPicture& picture, ConsensusBackground& model) {
  background::fillFrom(picture, executor_, model);
}

void Operations::learn(const SmoothPicture& picture, const LearntFrame& seen,
                       const ConsensusRate& rate, ConsensusBackground& model) {
  background::learn(picture, seen, rate, executor_, model);
}

void Operations::replaceWhere(const BitMask& places, const SmoothPicture& picture,
                              ConsensusBackground& model) {
  background::replaceWhere(places, picture, executor_, model);
}

void Operations::paintModel(const ConsensusBackground& model, ShownModel& out) {
  background::paintModel(model, executor_, out);
}

void Operations::paintModelAt(const BitMask& places, const ConsensusBackground& model,
                              ShownModel& out) {
  background::paintModelAt(places, model, executor_, out);
}

uint32_t Operations::countSet(const BitMask& mask) {
  return rg::countSet(mask);
}

bool Operations::isDarkerThan(const SmoothPicture& picture, int level) {
  return background::isDarkerThan(picture, level);
}

bool Operations::isEverywhere(const BitMask& mask) {
  return background::isEverywhere(mask);
}

bool Operations::hasSwitchedColour(const SmoothPicture& picture, const ConsensusBackground& model) {
  return background::hasSwitchedColour(picture, model);
}

Shift Operations::findShift(const SmoothPicture& picture, const ConsensusBackground& model,
                            Point centre) {
  return bestShift(sumShifted(picture, model, centre), centre);
}

void Operations::shiftPicture(Point shift, SmoothPicture& spare, SmoothPicture& picture) {
  background::shiftPicture(shift, executor_, spare, picture);
}

Histogram Operations::countLevels(const Image<uint8_t>& plane) {
  return rg::countLevels(plane, executor_);
}

LevelMaps Operations::matchLight(const ShownModel& shown, const SmoothPicture& picture) {
  return background::matchLight(shown, picture, executor_);
}

uint32_t Operations::countApart(const ShownModel& shown, const SmoothPicture& picture,
                                const LevelMaps& maps, const ConsensusBackground& model,
                                const Tolerance& tolerance) {
  return background::countApart(shown, picture, maps, model, tolerance);
}

void Operations::relight(const LevelMaps& maps, ConsensusBackground& model) {
  background::relight(maps, executor_, model);
}

int Operations::findGain(const SmoothPicture& picture, const ConsensusBackground& model) {
  return medianGain(sumGains(picture, model));
}

void Operations::mapLevels(const LevelMap& map, SmoothPicture& picture) {
  background::mapLevels(map, executor_, picture);
}

void Operations::keepMajority(const BitMask& mask, int radius, int share, BitMask& out) {
  background::keepMajority(mask, radius, share, executor_, cleaning_, out);
}

void Operations::keepSupported(BitMask& mask, const BitMask& strong, uint32_t leastPx) {
  background::keepSupported(mask, strong, leastPx, cleaning_);
}

void Operations::dropSwaying(const SmoothPicture& picture, const ConsensusBackground& model,
                             const Tolerance& tolerance, BitMask& mask) {
  background::dropSwaying(picture, model, tolerance, sway_, mask);
}

void Operations::fillHoles(BitMask& mask, uint32_t mostPx) {
  background::fillHoles(mask, mostPx, cleaning_);
}

void Operations::dropSmallParts(BitMask& mask, uint32_t leastPx) {
  background::dropSmallParts(mask, leastPx, cleaning_);
}

void Operations::fillUnedged(const SmoothPicture& picture, int mostStep, uint32_t mostPx,
                             BitMask& mask) {
  rg::fillUnedged(picture.planes[0], mostStep, mostPx, executor_, gaps_, mask);
}

void Operations::growFaint(const FaintEvidence& evidence, BitMask& mask) {
  background::growFaint(evidence, executor_, cleaning_, contour_, mask);
}

void Operations::trimBorder(const BorderEvidence& evidence, BorderLayer layer, BitMask& mask) {
  background::trimBorder(evidence, layer, executor_, contour_, mask);
}

void Operations::thicken(const BitMask& mask, int margin, BitMask& out) {
  rg::thicken(mask, margin, executor_, across_, out);
}

void Operations::remove(const BitMask& b, BitMask& a) {
  rg::remove(b, a);
}

void Operations::keepOnly(const BitMask& b, BitMask& a) {
  rg::keepOnly(b, a);
}

void Operations::followStill(const SmoothPicture& picture, const ConsensusBackground& model,
                             const Tolerance& tolerance, const BitMask& foreground,
                             uint16_t mostAge, StillPixels& still) {
  background::followStill(picture, model, tolerance, foreground, mostAge, executor_, still);
}

void Operations::findGhosts(const SmoothPicture& picture, const ConsensusBackground& model,
                            const BitMask& foreground, StillPixels& still, int leastAge,
                            BitMask& ghosts) {
  background::findGhosts(picture, model, foreground, still, leastAge, still_, ghosts);
}

void Operations::addAged(const BitMask& foreground, const StillPixels& still, int64_t leastAge,
                         BitMask& ghosts) {
  background::addAged(foreground, still, leastAge, ghosts);
}

void Operations::addDisplaced(const SmoothPicture& picture, const ConsensusBackground& model,
                              const BitMask& foreground, const StillPixels& still, int64_t leastAge,
                              BitMask& moved) {
  background::addDisplaced(picture, model, foreground, still, leastAge, moved_, moved);
}

void Operations::findShadows(const SmoothPicture& picture, const ShownModel& shown,
                             const BitMask& mask, BitMask& shadow) {
  const auto planes = [&](const ShownModel& from) {
    const bool isGrey = picture.channels == 1;
    return ColourPlanes{from[isGrey ? 0 : 1], from[0], from[isGrey ? 0 : 2]};
  };
  background::findShadows(planes(picture.planes), planes(shown), mask, executor_, shadow);
}

void Operations::keepCastShadows(const BitMask& mask, BitMask& dark) {
  background::keepCastShadows(mask, dark, castShadows_);
}

void Operations::paintForeground(const BitMask& mask, const BitMask& shadow, Point shift,
                                 Image<uint8_t>& out) {
  background::paintForeground(mask, shadow, shift, executor_, out);
}

}  // namespace rg::background
