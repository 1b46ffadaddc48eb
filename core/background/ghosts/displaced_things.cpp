// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/displaced_things.hpp"

#include <algorithm>

namespace rg::background {
namespace {

void count(int colour, std::vector<uint32_t>& histogram) {
  if (colour >= 0) ++histogram[static_cast<size_t>(colour)];
}

void chooseStill(const BitMask& foreground, const StillPixels& still, int64_t leastAge,
                 DisplacedScratch& scratch) {
  const std::vector<Component>& list = scratch.parts.list;
  scratch.stillPx.assign(list.size(), 0);
  for (const ComponentRun& run : scratch.parts.runs)
    for (int x = run.begin; x < run.end; ++x)
      scratch.stillPx[run.component] += still.ages.at(x, run.y) >= leastAge;
  scratch.isChosen.assign(list.size(), 0);
  int left = kMostDisplaced;
  for (size_t i = 0; i < list.size() && left > 0; ++i) {
    if (!isStillPart(scratch.stillPx[i], list[i].areaPx, foreground.size())) continue;
    scratch.isChosen[i] = 1;
    --left;
  }
}

/// How many pixels of a part have a colour that the model has beneath it as often.
uint32_t countShared(const SmoothPicture& picture, const ConsensusBackground& model, size_t part,
                     DisplacedScratch& scratch) {
  scratch.before.assign(kColours, 0);
  scratch.after.assign(kColours, 0);
  for (const ComponentRun& run : scratch.parts.runs) {
    if (run.component != part) continue;
    for (int x = run.begin; x < run.end; ++x) {
      const auto now = [&](size_t c) { return +picture.planes[c].at(x, run.y); };
      const auto then = [&](int c) { return +model.sample({x, run.y}, 0, c); };
      count(vividColour(now(0), now(1), now(2)), scratch.after);
      count(vividColour(then(0), then(1), then(2)), scratch.before);
    }
  }
  uint32_t shared = 0;
  for (size_t i = 0; i < size_t{kColours}; ++i)
    shared += std::min(scratch.before[i], scratch.after[i]);
  return shared;
}

}  // namespace

void addDisplaced(const SmoothPicture& picture, const ConsensusBackground& model,
                  const BitMask& foreground, const StillPixels& still, int64_t leastAge,
                  DisplacedScratch& scratch, BitMask& moved) {
  if (picture.channels == 1) return;
  findComponents(foreground, true, Connectivity::Eight, scratch.parts);
  chooseStill(foreground, still, leastAge, scratch);
  for (size_t i = 0; i < scratch.isChosen.size(); ++i)
    if (scratch.isChosen[i] != 0) {
      const uint32_t shared = countShared(picture, model, i, scratch);
      scratch.isChosen[i] = isDisplaced(shared, scratch.parts.list[i].areaPx);
    }
  paintComponents(scratch.parts, scratch.isChosen, true, moved);
}

}  // namespace rg::background
