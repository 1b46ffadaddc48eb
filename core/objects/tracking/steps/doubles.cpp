// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/doubles.hpp"

#include <algorithm>
#include <utility>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;

/// Whether two tracks seem to be one body: one of them was hardly ever seen apart, and they lie
/// above each other as its halves do, or together show no more than one of them should.
bool areOneBody(const TrackerState& state, size_t a, size_t b) {
  const Numbers::Life& n = state.numbers.life;
  const Track &p = state.tracks[a], &q = state.tracks[b];
  const Box first = p.box(), second = q.box(), both = unite(first, second);
  const int columns = std::min(first.right(), second.right()) - std::max(first.x, second.x);
  if (state.showsMovers && !state.blobs.areTogether(a, b)) return false;
  if (std::min(p.apartNs, q.apartNs) >= n.doubled.whole()) return false;
  // What a moving camera shows of a body comes and goes, so that a part's size says nothing.
  if (!state.showsMovers && (state.outgrows(p, both) || state.outgrows(q, both))) return false;
  if (!state.scale.isUniform() && state.blobs.has(a) && state.blobs.areTogether(a, b)) return true;
  if (columns < n.oneBodyColumns * std::min(first.width, second.width)) return false;
  if (!state.scale.isUniform()) {
    const int rows = std::min(first.bottom(), second.bottom()) - std::max(first.y, second.y);
    const int least = std::min(first.height, second.height);
    return rows < n.oneBodyRows * least && -rows < n.oneBodyGap * least;
  }
  const Extent usual = state.scale.at(both.bottom());
  if (both.height * kUnit < n.oneBodyHeight * usual.height) return true;
  const Sighting &s = state.sightings[a], &t = state.sightings[b];
  const int64_t one = int64_t{std::max(s.boxCells, t.boxCells)} * std::max(p.fill, q.fill);
  return 256 * (int64_t{s.cells} + t.cells) < n.oneBodyCells * one &&
         intersect(first, second).area() > n.oneBodyShared * std::min(first.area(), second.area());
}

/// The older one keeps its number; how it looks the one knows that was more of it.
void takeLooks(Track& from, Track& to) {
  to.look = from.look;
  to.colour = from.colour;
  std::swap(to.portrait, from.portrait);
  to.centreX = from.centreX;
  to.centreY = from.centreY;
  to.centreSamples = from.centreSamples;
  to.sway = from.sway;
  to.fill = from.fill;
}

}  // namespace

void joinDoubles(int64_t stepNs, TrackerState& state) {
  for (size_t b = 0; b < state.sightings.size(); ++b) {
    Track& track = state.tracks[b];
    if (!track.isSeen) continue;
    size_t partner = b;
    for (size_t a = 0; a < b && partner == b; ++a)
      if (state.tracks[a].isSeen && !state.tracks[a].isOver && areOneBody(state, a, b)) partner = a;
    if (partner == b) {
      track.doubleNs = 0;
      continue;
    }
    track.doubleNs += stepNs;
    // Nothing says that it is a thing of its own when it was apart for a shorter time.
    const int64_t doubled = state.numbers.life.doubled.whole();
    if (track.doubleNs < (state.scale.isUniform() ? doubled : std::min(doubled, track.apartNs)))
      continue;
    Track& kept = state.tracks[partner];
    if (!state.scale.isUniform()) {
      const Box both = unite(kept.box(), track.box());
      kept.x = (2 * both.x + both.width) * kUnit / 2;
      kept.foot = both.bottom() * kUnit;
      kept.size = {both.width * kUnit, both.height * kUnit};
      kept.sizeSamples = 0;
      if (state.sightings[b].cells > state.sightings[partner].cells) takeLooks(track, kept);
    }
    track.isOver = true;
    for (uint16_t& owner : state.owner)
      if (owner == b + 1) owner = static_cast<uint16_t>(partner + 1);
  }
}

}  // namespace rg::objects
