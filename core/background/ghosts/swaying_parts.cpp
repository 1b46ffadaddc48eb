// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/swaying_parts.hpp"

namespace rg::background {
namespace {

/// Calls visit(column) for those of a run that are looked at.
template <class Visit>
void forLookedAt(const ComponentRun& run, const Visit& visit) {
  if (!isLookedAt(run.y)) return;
  for (int x = run.begin + run.begin % 2; x < run.end; x += 2) visit(x);
}

class Look {
 public:
  Look(const SmoothPicture& picture, const ConsensusBackground& model, const Tolerance& tolerance,
       int y)
      : picture_(picture), model_(model), radii_(radiusRow(model, tolerance, y)), y_(y) {}

  [[nodiscard]] bool isKnown(int x) const {
    const auto now = [&](int c) { return +picture_.planes[static_cast<size_t>(c)].at(x, y_); };
    const int radius = nearbyRadius(radiusAt(radii_, picture_.planes[0].at(x, y_), x));
    return isKnownNearby(
        {x, y_}, picture_.size(), model_.channels, radius, now,
        [&](Point place, int sample, int c) { return +model_.sample(place, sample, c); });
  }

 private:
  const SmoothPicture& picture_;
  const ConsensusBackground& model_;
  RadiusRow radii_;
  int y_;
};

}  // namespace

/// Few parts are restless: few pixels are looked at closely.
void dropSwaying(const SmoothPicture& picture, const ConsensusBackground& model,
                 const Tolerance& tolerance, SwayScratch& scratch, BitMask& mask) {
  Components& found = scratch.components;
  findComponents(mask, true, Connectivity::Eight, found);
  std::vector<PartCount>& parts = scratch.parts;
  parts.assign(found.list.size(), {});
  for (const ComponentRun& run : found.runs) {
    const uint8_t* unrest = model.unrest.row(run.y);
    PartCount& part = parts[run.component];
    forLookedAt(run, [&](int x) {
      ++part.all;
      part.restless += unrest[x] >= kRestless;
    });
  }
  for (const ComponentRun& run : found.runs) {
    PartCount& part = parts[run.component];
    if (!isRestless(part)) continue;
    const Look look(picture, model, tolerance, run.y);
    forLookedAt(run, [&](int x) { part.known += look.isKnown(x); });
  }
  scratch.isChosen.resize(parts.size());
  for (size_t i = 0; i < parts.size(); ++i) scratch.isChosen[i] = sways(parts[i]);
  paintComponents(found, scratch.isChosen, false, mask);
}

}  // namespace rg::background
