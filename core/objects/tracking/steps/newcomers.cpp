// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/newcomers.hpp"

#include <algorithm>
#include <tuple>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;
constexpr size_t kMaxNewcomers = 128;  // Together with kMaxTracks bounds a frame of noise.

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

/// Before a moving camera groups are things; before a still one they may be parts of a body.
bool areTwoThings(const GroupGrid& e, uint16_t group, uint16_t other) {
  return e.showsMovers && group != other;
}

}  // namespace

void Newcomers::find(const GroupGrid& e, uint32_t minAreaPx, TrackerState& state) {
  findPieces(e, state.owner, true, pieceScratch_, pieces_);
  if (!state.scale.isUniform()) cutPieces(e, pieceScratch_, pieces_);
  list_.clear();
  ofPiece_.assign(pieces_.size(), -1);
  // Large pieces first, so that the limit drops the small ones; specks of a cell or two never
  // count.
  order_.clear();
  for (size_t i = 0; i < pieces_.size(); ++i)
    if (pieces_[i].cells >= state.numbers.newcomers.leastCells.whole()) order_.push_back(i);
  std::sort(order_.begin(), order_.end(), [&](size_t a, size_t b) {
    return std::tuple(pieces_[b].cells, a) < std::tuple(pieces_[a].cells, b);
  });
  if (order_.size() > kMaxNewcomers) order_.resize(kMaxNewcomers);
  for (const size_t i : order_) {
    Newcomer piece;
    piece.box = toPixels(pieces_[i].box, e.stepPx, e.frame);
    piece.group = pieces_[i].group;
    piece.cells = pieces_[i].cells;
    int host = -1;
    for (size_t n = 0; n < list_.size() && host < 0; ++n)
      if ((state.scale.isUniform() ||
           piece.cells <= state.numbers.newcomers.fragment * list_[n].cells) &&
          belongTogether(list_[n].box, piece.box, state.scale, state.numbers.newcomers) &&
          !areTwoThings(e, list_[n].group, piece.group))
        host = static_cast<int>(n);
    if (host < 0) {
      host = static_cast<int>(list_.size());
      list_.push_back(piece);
    } else {
      Newcomer& whole = list_[static_cast<size_t>(host)];
      whole.box = unite(whole.box, piece.box);
      whole.cells += piece.cells;
    }
    ofPiece_[i] = host;
  }
  describe(e, state);
  giveFragments(e, state);
  dropSmall(e, minAreaPx, state);
}

/// As long as the scene doesn't say how large things are, a small piece right above or below an
/// object is a part of it: a foot, or a head before a background like it.
void Newcomers::giveFragments(const GroupGrid& e, TrackerState& state) {
  if (state.scale.isUniform()) return;
  trackOf_.assign(list_.size(), -1);
  const int64_t leastPx = state.clutter.leastPx(state.numbers.life.clutterSome);
  for (size_t n = 0; n < list_.size(); ++n) {
    Newcomer& newcomer = list_[n];
    if (int64_t{newcomer.cells} * e.stepPx * e.stepPx < leastPx) continue;
    for (size_t t = 0; t < state.tracks.size() && newcomer.cells > 0; ++t) {
      if (!state.blobs.has(t)) continue;
      const Piece& blob = state.blobs.of(t);
      if (areTwoThings(e, blob.group, newcomer.group)) continue;
      const Box box = toPixels(blob.box, e.stepPx, e.frame);
      if (newcomer.cells > state.numbers.newcomers.fragment * blob.cells ||
          !belongTogether(box, newcomer.box, state.scale, state.numbers.newcomers))
        continue;
      if (!e.showsMovers && state.outgrows(state.tracks[t], unite(box, newcomer.box))) continue;
      state.sightings[t].box = unite(state.sightings[t].box, newcomer.box);
      trackOf_[n] = static_cast<int>(t);
      newcomer.cells = 0;
    }
  }
  giveCells(e, state);
}

void Newcomers::giveCells(const GroupGrid& e, TrackerState& state) const {
  e.forForeground([&](size_t cell, int, int) {
    const uint32_t piece = pieceScratch_.label[cell];
    if (piece == 0 || ofPiece_[piece - 1] < 0) return;
    const int track = trackOf_[static_cast<size_t>(ofPiece_[piece - 1])];
    if (track >= 0) state.owner[cell] = static_cast<uint16_t>(track + 1);
  });
}

/// Looks of the newcomers, and the tracks whose blob they come out of.
void Newcomers::describe(const GroupGrid& e, const TrackerState& state) {
  touching_.assign(list_.size() * state.tracks.size(), 0);
  e.forForeground([&](size_t cell, int x, int y) {
    const uint32_t piece = pieceScratch_.label[cell];
    if (piece == 0 || ofPiece_[piece - 1] < 0) return;
    const auto n = static_cast<size_t>(ofPiece_[piece - 1]);
    Newcomer& newcomer = list_[n];
    const int row = y * e.stepPx + e.stepPx / 2 - newcomer.box.y;
    const int band = std::clamp(row * kBodyBands / newcomer.box.height, 0, kBodyBands - 1);
    ++newcomer.look.bins[static_cast<size_t>(band)][e.bin[cell]];
    for (const Point& d : {Point{1, 0}, Point{-1, 0}, Point{0, 1}, Point{0, -1}}) {
      if (!boundsOf(e.grid).contains({x + d.x, y + d.y})) continue;
      const uint16_t owner = state.owner[e.at(x + d.x, y + d.y)];
      if (owner != 0) ++touching_[n * state.tracks.size() + owner - 1u];
    }
  });
  for (size_t n = 0; n < list_.size(); ++n) {
    Newcomer& newcomer = list_[n];
    newcomer.isAtBorder = touchesBorder(newcomer.box, e.frame);
    learn(newcomer.appearance, newcomer.look);
    uint32_t most = 0;
    for (size_t t = 0; t < state.tracks.size(); ++t)
      if (touching_[n * state.tracks.size() + t] > most) {
        most = touching_[n * state.tracks.size() + t];
        newcomer.parent = state.tracks[t].id;
      }
  }
}

/// Drops what is too small to be an object here; what sticks out of a track has to be a whole one.
void Newcomers::dropSmall(const GroupGrid& e, uint32_t minAreaPx, const TrackerState& state) {
  const int64_t cellPx = int64_t{e.stepPx} * e.stepPx;
  const int64_t leastPx = state.clutter.leastPx(state.numbers.life.clutterSome);
  const Numbers::Newcomers& least = state.numbers.newcomers;
  const auto isSmall = [&](const Newcomer& n) {
    const int64_t areaPx = n.cells * cellPx;
    if (minAreaPx > 0) return areaPx < minAreaPx;
    if (areaPx < leastPx) return true;
    if (!state.scale.isKnown()) {
      const auto parent = std::find_if(state.tracks.begin(), state.tracks.end(),
                                       [&](const Track& t) { return t.id == n.parent; });
      if (parent != state.tracks.end() &&
          areaPx * kUnit * kUnit * 256 <
              (state.isSizeKnown(*parent) ? least.ofKnown : least.ofParent) *
                  (int64_t{parent->size.width} * parent->size.height * parent->fill))
        return true;
      return areaPx < least.ofFrame * e.frame.area();
    }
    const Extent expected = state.scale.at(n.box.bottom());
    const int64_t usual = int64_t{expected.width} * expected.height / (kUnit * kUnit);
    const int64_t height = n.box.height * int64_t{kUnit}, width = n.box.width * int64_t{kUnit};
    if (n.isAtBorder && n.parent == 0)
      return areaPx < least.atBorder * usual || height < least.atBorderHeight * expected.height;
    if (n.parent != 0)
      return areaPx < least.outOf * usual || height < least.outOfHeight * expected.height ||
             width < least.outOfWidth * expected.width;
    return areaPx < least.alone * usual || height < least.aloneHeight * expected.height ||
           width < least.aloneWidth * expected.width;
  };
  // Kept in place: ofPiece_ points here.
  for (Newcomer& newcomer : list_)
    if (isSmall(newcomer)) newcomer.cells = 0;
}

}  // namespace rg::objects
