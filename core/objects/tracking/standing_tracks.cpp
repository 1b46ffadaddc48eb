// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/standing_tracks.hpp"

#include <algorithm>

namespace rg::objects {
namespace {

constexpr int kAround = 1;  // Pixels by which the camera's motion may be off.
constexpr int kSkip = 2;    // Of the portrait's columns and rows while the place is looked for.

/// Calls visit(pixel, agrees) for the solid samples of a portrait that lie in the picture.
template <class Visit>
void forSamples(const Portrait& p, const Picture& picture, Point corner, int skip,
                const Visit& visit) {
  const Size frame = picture.size();
  const PortraitColours colours(picture);
  const uint32_t least = p.leastWeight();
  for (int row = 0; row < p.grid.height; row += skip) {
    const int y = corner.y + row * p.stepPx;
    if (y < 0 || y >= frame.height) continue;
    const PortraitSample* samples = p.samples.data() + ptrdiff_t{row} * p.grid.width;
    for (int column = 0; column < p.grid.width; column += skip) {
      const int x = corner.x + column * p.stepPx;
      if (samples[column].weight < least || x < 0 || x >= frame.width) continue;
      visit(Point{x, y}, colours.agrees(samples[column], colours.placeOf(x, y)));
    }
  }
}

/// Where the thing stands, if as much of it is seen there as usually is.
bool isSeenStanding(const Track& track, const Picture& picture, Point expected, Number share,
                    Point& corner) {
  uint32_t most = 0;
  for (int dy = -kAround; dy <= kAround; ++dy)
    for (int dx = -kAround; dx <= kAround; ++dx) {
      const Point at{expected.x + dx, expected.y + dy};
      uint32_t samples = 0, agreeing = 0;
      forSamples(track.portrait, picture, at, kSkip, [&](Point, bool isAlike) {
        ++samples;
        agreeing += isAlike;
      });
      if (256 * int64_t{agreeing} < share * (int64_t{track.portrait.usual} * samples)) continue;
      if (agreeing <= most) continue;
      most = agreeing;
      corner = at;
    }
  return most > 0;
}

}  // namespace

void findStandingTracks(const TrackerState& state, const segmentation::Labels& labels,
                        const CameraMotion& camera, std::span<const graph::Region> regions,
                        StandingScratch& s, std::span<StandingTrack> ofRegion) {
  s.votes.resize(std::max(s.votes.size(), regions.size()), 0);
  const std::vector<Track>& tracks = state.tracks;
  const Numbers::Likeness& n = state.numbers.likeness;
  for (uint32_t t = 0; t < tracks.size(); ++t) {
    const Track& track = tracks[t];
    if (!track.isConfirmed || !track.hasTravelled || !state.isFaithful(track)) continue;
    Point corner;
    if (!isSeenStanding(track, *labels.picture,
                        track.portraitCorner(camera.since({track.x, track.foot})), n.standing,
                        corner))
      continue;
    const auto samplePx = static_cast<uint32_t>(track.portrait.stepPx * track.portrait.stepPx);
    forSamples(track.portrait, *labels.picture, corner, 1, [&](Point at, bool isAlike) {
      const uint16_t label = labels.ids.at(at.x, at.y);
      if (!isAlike || label == segmentation::kNoRegion) return;
      uint32_t& votes = s.votes[label - 1u];
      if (votes == 0) s.seen.push_back(label - 1u);
      votes += samplePx;
    });
    for (const uint32_t r : s.seen) {
      const uint32_t areaPx = std::min(s.votes[r], regions[r].areaPx);
      if (areaPx >= n.standingRegion * regions[r].areaPx && areaPx > ofRegion[r].areaPx)
        ofRegion[r] = {TrackIndex::ofIndex(t), areaPx};
      s.votes[r] = 0;
    }
    s.seen.clear();
  }
}

}  // namespace rg::objects
