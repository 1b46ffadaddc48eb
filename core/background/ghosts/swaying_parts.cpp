// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/swaying_parts.hpp"

#include "core/background/ghosts/sway.hpp"

namespace rg::background {
namespace {

/// Of a run the pixels that are looked at.
struct RunCount {
  uint32_t all = 0, chosen = 0;
};
/// isChosen(column).
template <class Choose>
RunCount countIn(const ComponentRun& run, const Choose& isChosen) {
  RunCount count;
  if (!isLookedAt(run.y)) return count;
  for (int x = run.begin + run.begin % 2; x < run.end; x += 2) {
    ++count.all;
    count.chosen += isChosen(x);
  }
  return count;
}

class Look {
 public:
  Look(const SmoothPicture& picture, const ConsensusBackground& model, const Tolerance& tolerance,
       int y)
      : picture_(picture),
        model_(model),
        radii_(radiusRow(model, tolerance, y)),
        unrest_(model.unrest.row(y)),
        y_(y) {}

  [[nodiscard]] bool isRestless(int x) const { return unrest_[x] >= kRestless; }
  [[nodiscard]] bool isSwaying(int x) const {
    const auto now = [&](int c) { return +picture_.planes[static_cast<size_t>(c)].at(x, y_); };
    const int radius = radiusAt(radii_, picture_.planes[0].at(x, y_), x);
    return isRestless(x) && isKnownNearby({x, y_}, picture_.size(), model_.channels, radius, now,
                                          [&](Point place, int sample, int c) {
                                            return +model_.sample(place, sample, c);
                                          });
  }

 private:
  const SmoothPicture& picture_;
  const ConsensusBackground& model_;
  RadiusRow radii_;
  const uint8_t* unrest_;
  int y_;
};

}  // namespace

/// What is not restless for the most part can't sway, and what is steady for the most part does
/// not: few pixels are looked at closely.
void dropSwaying(const SmoothPicture& picture, const ConsensusBackground& model,
                 const Tolerance& tolerance, SwayScratch& scratch, BitMask& mask) {
  Components& found = scratch.components;
  findComponents(mask, true, Connectivity::Eight, found);
  std::vector<PartCount>& parts = scratch.parts;
  parts.assign(found.list.size(), {});
  for (const ComponentRun& run : found.runs) {
    const Look look(picture, model, tolerance, run.y);
    const RunCount count = countIn(run, [&](int x) { return look.isRestless(x); });
    parts[run.component].all += count.all;
    parts[run.component].steady += count.all - count.chosen;
  }
  for (PartCount& part : parts)
    if (2 * part.steady < part.all) part.steady = 0;
  for (const ComponentRun& run : found.runs) {
    PartCount& part = parts[run.component];
    if (2 * part.steady >= part.all) continue;
    const Look look(picture, model, tolerance, run.y);
    const RunCount count = countIn(run, [&](int x) { return look.isSwaying(x); });
    part.steady += count.all - count.chosen;
  }
  scratch.isChosen.resize(parts.size());
  for (size_t i = 0; i < parts.size(); ++i)
    scratch.isChosen[i] = sways(weightOf(parts[i].all, parts[i].all - parts[i].steady));
  paintComponents(found, scratch.isChosen, false, mask);
}

}  // namespace rg::background
