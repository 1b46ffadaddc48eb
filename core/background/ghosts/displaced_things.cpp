// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/displaced_things.hpp"

#include <algorithm>
#include <array>

namespace rg::background {
namespace {

constexpr int kMostParts = 16;    ///< Each costs a pass over all runs.
constexpr int kLeastChroma = 32;  ///< Grey levels between the largest and the smallest channel.
constexpr int kBits = 4;          ///< Of each channel that tell colours apart.
constexpr size_t kColours = size_t{1} << 3 * kBits;

using Colour = std::array<int, 3>;

void count(const Colour& colour, std::vector<uint32_t>& histogram) {
  const auto [least, most] = std::minmax({colour[0], colour[1], colour[2]});
  if (most - least < kLeastChroma) return;
  size_t bin = 0;
  for (const int level : colour) bin = bin << kBits | static_cast<size_t>(level >> (8 - kBits));
  ++histogram[bin];
}

void chooseStill(const BitMask& foreground, const StillPixels& still, int64_t leastAge,
                 DisplacedScratch& scratch) {
  const std::vector<Component>& list = scratch.parts.list;
  scratch.stillPx.assign(list.size(), 0);
  for (const ComponentRun& run : scratch.parts.runs)
    for (int x = run.begin; x < run.end; ++x)
      scratch.stillPx[run.component] += still.ages.at(x, run.y) >= leastAge;
  const auto leastPx = static_cast<uint32_t>(std::max<int64_t>(30, foreground.size().area() / 500));
  scratch.isChosen.assign(list.size(), 0);
  int left = kMostParts;
  for (size_t i = 0; i < list.size() && left > 0; ++i) {
    if (list[i].areaPx < leastPx || 4 * scratch.stillPx[i] < 3 * list[i].areaPx) continue;
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
      Colour now{}, then{};
      for (size_t c = 0; c < now.size(); ++c) {
        now[c] = picture.planes[c].at(x, run.y);
        then[c] = model.sample({x, run.y}, 0, static_cast<int>(c));
      }
      count(now, scratch.after);
      count(then, scratch.before);
    }
  }
  uint32_t shared = 0;
  for (size_t i = 0; i < kColours; ++i) shared += std::min(scratch.before[i], scratch.after[i]);
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
      scratch.isChosen[i] = 8 * shared >= scratch.parts.list[i].areaPx;
    }
  paintComponents(scratch.parts, scratch.isChosen, true, moved);
}

}  // namespace rg::background
