// SPDX-License-Identifier: LGPL-2.1-or-later
// The foreground that no track explains: noise, a new object, or one that was lost.
#include "core/base/pixel.hpp"
#include "core/base/time/frame_count.hpp"
#include "core/objects/tracking/tracker.hpp"

#include <algorithm>
#include <tuple>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;
constexpr size_t kMaxTracks = 256;  // Together with kMaxNewcomers bounds a frame of noise.
constexpr size_t kMaxNewcomers = 128;

Box toPixels(const Box& cells, int stepPx, Size frame) {
  return intersect(
      {cells.x * stepPx, cells.y * stepPx, cells.width * stepPx, cells.height * stepPx},
      boundsOf(frame));
}

bool touchesBorder(const Box& box, Size frame) {
  return box.x <= 0 || box.y <= 0 || box.right() >= frame.width || box.bottom() >= frame.height;
}

/// Pieces of one body lie above each other: they share most of their columns, the gap between them
/// is short and together they are no higher than one thing.
bool belongTogether(const Box& a, const Box& b, const SceneScale& scale,
                    const Numbers::Newcomers& n) {
  const int shared = std::min(a.right(), b.right()) - std::max(a.x, b.x);
  if (shared < n.sharedColumns * std::min(a.width, b.width)) return false;
  const Box both = unite(a, b);
  const int gap = std::max(a.y, b.y) - std::min(a.bottom(), b.bottom());
  if (!scale.isUniform()) return gap <= n.gap * std::max(a.height, b.height);
  const Extent expected = scale.at(both.bottom());
  return gap * kUnit <= n.gap * expected.height &&
         both.height * kUnit <= n.bodyHeight * expected.height &&
         both.width * kUnit <= n.bodyWidth * expected.width;
}

}  // namespace

void Tracker::findNewcomers(const GroupGrid& e, const TrackerParams& params) {
  findPieces(e, owner_, pieceScratch_, pieces_);
  if (!scale_.isUniform()) cutPieces(e, pieceScratch_, pieces_);
  newcomers_.clear();
  newcomerOf_.assign(pieces_.size(), -1);
  // Large pieces first, so that the limit drops the small ones; specks of a cell or two never
  // count.
  std::vector<size_t>& order = order_;
  order.clear();
  for (size_t i = 0; i < pieces_.size(); ++i)
    if (pieces_[i].cells >= numbers_.newcomers.leastCells.whole()) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::tuple(pieces_[b].cells, a) < std::tuple(pieces_[a].cells, b);
  });
  if (order.size() > kMaxNewcomers) order.resize(kMaxNewcomers);
  for (const size_t i : order) {
    Newcomer piece;
    piece.box = toPixels(pieces_[i].box, e.stepPx, e.frame);
    piece.cells = pieces_[i].cells;
    piece.group = pieces_[i].group;
    int host = -1;
    for (size_t n = 0; n < newcomers_.size() && host < 0; ++n)
      if ((scale_.isUniform() ||
           piece.cells <= numbers_.newcomers.fragment * newcomers_[n].cells) &&
          belongTogether(newcomers_[n].box, piece.box, scale_, numbers_.newcomers) &&
          !areApart(e, newcomers_[n].group, piece.group))
        host = static_cast<int>(n);
    if (host < 0) {
      host = static_cast<int>(newcomers_.size());
      newcomers_.push_back(piece);
    } else {
      Newcomer& whole = newcomers_[static_cast<size_t>(host)];
      whole.box = unite(whole.box, piece.box);
      whole.cells += piece.cells;
    }
    newcomerOf_[i] = host;
  }
  describeNewcomers(e);
  giveFragments(e);
  dropSmall(e, params);
}

/// As long as the scene doesn't say how large things are, a small piece right above or below an
/// object is a part of it: a foot, or a head before a background like it.
void Tracker::giveFragments(const GroupGrid& e) {
  if (scale_.isUniform()) return;
  trackOfNewcomer_.assign(newcomers_.size(), -1);
  const int64_t leastPx = clutter_.leastPx(numbers_.life.clutterSome);
  for (size_t n = 0; n < newcomers_.size(); ++n) {
    Newcomer& newcomer = newcomers_[n];
    if (int64_t{newcomer.cells} * e.stepPx * e.stepPx < leastPx) continue;
    for (size_t t = 0; t < tracks_.size() && newcomer.cells > 0; ++t) {
      if (blobOf_[t] == 0) continue;
      const Piece& blob = blobs_[blobOf_[t] - 1];
      const Box box = toPixels(blob.box, e.stepPx, e.frame);
      if (newcomer.cells > numbers_.newcomers.fragment * blob.cells ||
          !belongTogether(box, newcomer.box, scale_, numbers_.newcomers))
        continue;
      if (areApart(e, blob.group, newcomer.group) || isComplete(t, e)) continue;
      if (!e.showsMovers && outgrows(tracks_[t], unite(box, newcomer.box))) continue;
      sightings_[t].box = unite(sightings_[t].box, newcomer.box);
      trackOfNewcomer_[n] = static_cast<int>(t);
      newcomer.cells = 0;
    }
  }
  giveNewcomers(e);
}

/// Cells of the newcomers that have found a track go to it.
void Tracker::giveNewcomers(const GroupGrid& e) {
  e.forForeground([&](size_t cell, int, int) {
    const uint32_t piece = pieceScratch_.label[cell];
    if (piece == 0 || newcomerOf_[piece - 1] < 0) return;
    const int track = trackOfNewcomer_[static_cast<size_t>(newcomerOf_[piece - 1])];
    if (track >= 0) owner_[cell] = static_cast<uint16_t>(track + 1);
  });
}

/// Looks of the newcomers, and the tracks whose blob they come out of.
void Tracker::describeNewcomers(const GroupGrid& e) {
  touching_.assign(newcomers_.size() * tracks_.size(), 0);
  e.forForeground([&](size_t cell, int x, int y) {
    const uint32_t piece = pieceScratch_.label[cell];
    if (piece == 0 || newcomerOf_[piece - 1] < 0) return;
    const auto n = static_cast<size_t>(newcomerOf_[piece - 1]);
    Newcomer& newcomer = newcomers_[n];
    const int row = y * e.stepPx + e.stepPx / 2 - newcomer.box.y;
    const int band = std::clamp(row * kBodyBands / newcomer.box.height, 0, kBodyBands - 1);
    ++newcomer.look.bins[static_cast<size_t>(band)][e.bin[cell]];
    for (const Point& d : {Point{1, 0}, Point{-1, 0}, Point{0, 1}, Point{0, -1}}) {
      if (!boundsOf(e.grid).contains({x + d.x, y + d.y})) continue;
      const uint16_t owner = owner_[e.at(x + d.x, y + d.y)];
      if (owner != 0) ++touching_[n * tracks_.size() + owner - 1u];
    }
  });
  for (size_t n = 0; n < newcomers_.size(); ++n) {
    Newcomer& newcomer = newcomers_[n];
    newcomer.isAtBorder = touchesBorder(newcomer.box, e.frame);
    learn(newcomer.appearance, newcomer.look);
    uint32_t most = 0;
    for (size_t t = 0; t < tracks_.size(); ++t)
      if (touching_[n * tracks_.size() + t] > most) {
        most = touching_[n * tracks_.size() + t];
        newcomer.parent = tracks_[t].id;
      }
  }
}

/// Whether a newcomer moves otherwise than the track that it comes out of.
bool Tracker::comesApart(const GroupGrid& e, const Newcomer& newcomer) const {
  for (size_t t = 0; t < sightings_.size(); ++t)
    if (tracks_[t].id == newcomer.parent)
      return blobOf_[t] != 0 && areApart(e, blobs_[blobOf_[t] - 1].group, newcomer.group);
  return false;
}

/// Drops what is too small to be an object here; what sticks out of a track has to be a whole one.
void Tracker::dropSmall(const GroupGrid& e, const TrackerParams& params) {
  const int64_t cellPx = int64_t{e.stepPx} * e.stepPx;
  const int64_t leastPx = clutter_.leastPx(numbers_.life.clutterSome);
  const Numbers::Newcomers& least = numbers_.newcomers;
  const auto isSmall = [&](const Newcomer& n) {
    const int64_t areaPx = n.cells * cellPx;
    if (params.minAreaPx > 0) return areaPx < params.minAreaPx;
    if (areaPx < leastPx) return true;
    if (!scale_.isKnown()) {
      const auto parent = std::find_if(tracks_.begin(), tracks_.end(),
                                       [&](const Track& t) { return t.id == n.parent; });
      if (parent != tracks_.end() &&
          areaPx * kUnit * kUnit * 256 <
              (isSizeKnown(*parent) || comesApart(e, n) ? least.ofKnown : least.ofParent) *
                  (int64_t{parent->size.width} * parent->size.height * parent->fill))
        return true;
      return areaPx < least.ofFrame * e.frame.area();
    }
    const Extent expected = scale_.at(n.box.bottom());
    const int64_t usual = int64_t{expected.width} * expected.height / (kUnit * kUnit);
    const int64_t height = n.box.height * int64_t{kUnit}, width = n.box.width * int64_t{kUnit};
    if (n.isAtBorder && n.parent == 0)
      return areaPx < least.atBorder * usual || height < least.atBorderHeight * expected.height;
    if (n.parent != 0 && !comesApart(e, n))
      return areaPx < least.outOf * usual || height < least.outOfHeight * expected.height ||
             width < least.outOfWidth * expected.width;
    return areaPx < least.alone * usual || height < least.aloneHeight * expected.height ||
           width < least.aloneWidth * expected.width;
  };
  // Kept in place: newcomerOf_ points here.
  for (Newcomer& newcomer : newcomers_)
    if (isSmall(newcomer)) newcomer.cells = 0;
}

/// Gives newcomers to the tracks that are missing and look like them; the others begin tracks.
void Tracker::rejoin(const GroupGrid& e) {
  std::vector<size_t>& missing = order_;
  missing.clear();
  for (size_t i = 0; i < tracks_.size(); ++i)
    if (!tracks_[i].isSeen) missing.push_back(i);
  costs_.assign(missing.size() * newcomers_.size(), kForbidden);
  for (size_t m = 0; m < missing.size(); ++m)
    for (size_t n = 0; n < newcomers_.size(); ++n)
      if (newcomers_[n].cells > 0)
        costs_[m * newcomers_.size() + n] = rejoinCost(e, tracks_[missing[m]], newcomers_[n]);
  assignment_.solve(costs_, static_cast<int>(missing.size()), static_cast<int>(newcomers_.size()),
                    numbers_.identity.leaveOut.whole());
  trackOfNewcomer_.assign(newcomers_.size(), -1);
  for (size_t m = 0; m < missing.size(); ++m) {
    const int n = assignment_.columnOf(static_cast<int>(m));
    if (n < 0) continue;
    comeBack(e, tracks_[missing[m]], newcomers_[static_cast<size_t>(n)]);
    trackOfNewcomer_[static_cast<size_t>(n)] = static_cast<int>(missing[m]);
  }
  for (size_t n = 0; n < newcomers_.size(); ++n) {
    if (newcomers_[n].cells == 0 || trackOfNewcomer_[n] >= 0 || tracks_.size() >= kMaxTracks)
      continue;
    trackOfNewcomer_[n] = static_cast<int>(tracks_.size());
    begin(newcomers_[n]);
  }
  giveNewcomers(e);
}

/// 0 … 2000, or kForbidden: how unlikely it is that the newcomer is the track that is missing.
int64_t Tracker::rejoinCost(const GroupGrid& e, const Track& track, const Newcomer& newcomer) {
  const int64_t x = (2 * int64_t{newcomer.box.x} + newcomer.box.width) * kUnit / 2;
  const int64_t foot = int64_t{newcomer.box.bottom()} * kUnit;
  const int64_t dx = x - track.x, dy = foot - track.foot;
  const uint32_t far = integerSqrt(static_cast<uint64_t>(dx * dx + dy * dy));
  const Numbers::Identity& n = numbers_.identity;
  const int64_t growth = n.gateGrowth.of(track.size.height * (track.unseenNs / 1'000'000)) / 1000;
  const int64_t gate = std::max<int64_t>(1, n.gate.of(track.size.height) + growth);
  if (far > gate) return kForbidden;
  if (isFaithful(track) && int64_t{newcomer.box.width} * kUnit < n.part * track.size.width)
    return recognise(e, track, newcomer) ? 1000 * int64_t{far} / gate : kForbidden;
  const int64_t height = int64_t{newcomer.box.height} * kUnit;
  if (!newcomer.isAtBorder &&
      (height < n.leastHeight * track.size.height || height > n.mostHeight * track.size.height))
    return kForbidden;
  const int alike = likeness(track, newcomer);
  if (track.isConfirmed && alike < n.alike * kFullMatch) return kForbidden;
  return 1000 * int64_t{far} / gate + 1000 - 1000 * int64_t{alike} / kFullMatch;
}

/// How much a newcomer looks like a track. What comes out of a blob that a missing track went into
/// may also be the other one of the two; who is who is judged later.
int Tracker::likeness(const Track& track, const Newcomer& newcomer) const {
  int most = similarity(track.look, newcomer.appearance);
  const uint64_t parent = parentOf(newcomer);
  for (const Encounter& encounter : encounters_) {
    const bool isPair = (encounter.first == track.id && encounter.second == parent) ||
                        (encounter.second == track.id && encounter.first == parent);
    if (!isPair) continue;
    for (const Track& other : tracks_)
      if (other.id == parent) most = std::max(most, similarity(other.look, newcomer.appearance));
  }
  return most;
}

void Tracker::comeBack(const GroupGrid& e, Track& track, const Newcomer& newcomer) {
  // What comes out from behind something shows a part first.
  const bool isPart = track.centreSamples > 0 &&
                      newcomer.box.width * kUnit < numbers_.identity.part * track.size.width;
  Place place{(2 * int64_t{newcomer.box.x} + newcomer.box.width) * kUnit / 2,
              int64_t{newcomer.box.bottom()} * kUnit};
  if (isPart) place = placeOfPart(track, newcomer.box, frame_);
  if (const auto recognised = recognise(e, track, newcomer); isPart && recognised)
    place = {recognised->x, recognised->y};
  const int64_t x = place.x, foot = place.foot;
  const int64_t sinceUs = std::max<int64_t>(track.unseenNs / 1000, 1000);
  if (track.hits <= 2) {
    track.speedX += static_cast<int32_t>((x - track.x) * 1'000'000 / sinceUs);
    track.speedY += static_cast<int32_t>((foot - track.foot) * 1'000'000 / sinceUs);
  }
  track.x = static_cast<int32_t>(x);
  track.foot = static_cast<int32_t>(foot);
  track.isSeen = true;
  track.unseenNs = 0;
  countUp(track.hits);
}

/// The object that a newcomer comes out of: the one that it touches, or whose place it overlaps
/// most when it appears right beside it. 0 = none.
uint64_t Tracker::parentOf(const Newcomer& newcomer) const {
  if (newcomer.parent != 0 || newcomer.isAtBorder) return newcomer.parent;
  const auto beside = [&](int width) {
    return static_cast<int>(numbers_.newcomers.besideParent.of(width));
  };
  uint64_t parent = 0;
  int64_t most = 0;
  for (const Track& track : tracks_) {
    const Box box = track.box();
    const int64_t shared = intersect(inflate(box, beside(box.width)), newcomer.box).area();
    if (!track.isConfirmed || track.state == ObjectState::Lost || shared <= most) continue;
    most = shared;
    parent = track.id;
  }
  return parent;
}

void Tracker::begin(const Newcomer& newcomer) {
  Track track;
  track.id = nextId_++;
  track.x = (2 * newcomer.box.x + newcomer.box.width) * kUnit / 2;
  track.foot = newcomer.box.bottom() * kUnit;
  track.size = {newcomer.box.width * kUnit, newcomer.box.height * kUnit};
  if (scale_.isUniform()) {
    const Extent expected = scale_.at(newcomer.box.bottom());
    const bool isUsual = track.size.width <= numbers_.newcomers.usualWidth * expected.width &&
                         track.size.height <= numbers_.newcomers.usualHeight * expected.height;
    // What comes in shows a part: the rest is beyond the border that it touches.
    if (isUsual) {
      const Box& box = newcomer.box;
      track.size = expected;
      if (box.x <= 0) track.x = box.right() * kUnit - expected.width / 2;
      if (box.right() >= frame_.width) track.x = box.x * kUnit + expected.width / 2;
      if (box.bottom() >= frame_.height) track.foot = box.y * kUnit + expected.height;
    }
  }
  if (const uint64_t parent = parentOf(newcomer)) track.parents.push_back(parent);
  track.stillX = track.originX = track.learntX = track.x;
  track.stillFoot = track.originFoot = track.learntFoot = track.foot;
  track.stillSize = track.size;
  track.look = newcomer.appearance;
  track.isFromBorder = newcomer.isAtBorder || showsMovers_;
  track.isSeen = true;
  track.hits = 1;
  track.ageFrames = 1;
  tracks_.push_back(std::move(track));
}

}  // namespace rg::objects
