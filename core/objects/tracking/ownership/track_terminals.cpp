// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/ownership/track_terminals.hpp"

#include "core/base/forest.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rg::objects {
namespace {

constexpr int64_t kOne = 256;
constexpr uint16_t kUnseen = UINT16_MAX, kSeveral = kUnseen - 1;

/// Null where the regions don't touch.
const graph::Arc* findArc(const graph::Graph& graph, uint16_t a, uint16_t b) {
  using Ends = std::pair<uint32_t, uint32_t>;
  const auto endsOf = [](const graph::Arc& arc) { return Ends(arc.a.number(), arc.b.number()); };
  const Ends ends = std::minmax(a, b);
  const auto at =
      std::lower_bound(graph.arcs.begin(), graph.arcs.end(), ends,
                       [&](const graph::Arc& arc, Ends key) { return endsOf(arc) < key; });
  return at != graph.arcs.end() && endsOf(*at) == ends ? &*at : nullptr;
}

/// How a track is expected to move in the picture; of what is new nothing is known.
motion::RegionMotion motionOf(const Track& track, const GroupGrid& e, int64_t stepNs,
                              const Numbers& n) {
  const Point step = expectedStep(track, stepNs);
  const Point by = e.camera.since({track.x, track.foot - track.size.height / 2});
  motion::RegionMotion motion;
  motion.dx = toInt(int64_t{step.x} + by.x);
  motion.dy = toInt(int64_t{step.y} + by.y);
  motion.reliability = track.hits < n.fit.firstHits.whole() ? 0 : motion::kFullReliability;
  return motion;
}

/// What a cell's colour says for a track, in 1/256.
int64_t lookOf(const FitTask& task, uint8_t bin, const Numbers::Ownership& n) {
  constexpr int64_t kOwn = 2;  // The bonus of a colour of its own.
  return n.colour.of(kOne * task.bonus[bin]) / kOwn;
}

int64_t rootOfCells(uint32_t cells, const GroupGrid& e) {
  const auto step = static_cast<uint64_t>(e.stepPx);
  return integerSqrt(cells * step * step);
}

/// In 1/256: what nobody gains of a part's root, and a track less of one that is out of its reach.
int64_t unplaced(const MergeWeights& weights, const Numbers::Ownership& n) {
  return n.place.of(weights.prediction * n.most.of(kOne)) / kOne;
}

}  // namespace

void TrackTerminals::Distances::list(int low, int length, int cells, int64_t deviation,
                                     int64_t most) {
  const auto at = [&](int cell) {
    const int64_t far = kOne * std::max({0, low - cell, cell - (low + length - 1)});
    return far * kOne / deviation * far / deviation;
  };
  begin = std::clamp(low, 0, cells);
  int end = std::clamp(low + length, 0, cells);
  while (begin > 0 && at(begin - 1) < most) --begin;
  while (end < cells && at(end) < most) ++end;
  squared.clear();
  for (int cell = begin; cell < end; ++cell)
    squared.push_back(static_cast<int32_t>(std::min(at(cell), most)));
}

void TrackTerminals::decide(const GroupGrid& e, const MergeInput& input,
                            std::span<const uint16_t> partedFrom, TrackerState& state) {
  parts_.find(e, state.owner, partedFrom);
  arcs_.clear();
  linkParts(e, input);
  const auto parts = static_cast<uint32_t>(parts_.list().size());
  if (parts == 0) return;
  terminals_.assign(state.tracks.size() + 1, 0);
  uint32_t nodes = parts;
  for (const FitTask& task : state.tasks) {
    if (state.sightings[task.trackIndex()].task < 0) continue;
    terminals_[task.track] = nodes++;
    tieToTrack(terminals_[task.track], e, input, task, state);
  }
  groupOf_.resize(nodes + 1);
  std::iota(groupOf_.begin(), groupOf_.end(), 0u);
  for (uint32_t p = 0; p < parts; ++p)
    if (const uint32_t terminal = terminals_[parts_.list()[p].claim]; terminal != 0)
      groupOf_[p] = terminal;
  keepApart(nodes);
  tieToNobody(e, input, state);
  minimise(nodes + 1, arcs_, scratch_, groupOf_);
  give(e, state);
  sight(e, *input.motion.graph, state);
}

void TrackTerminals::linkParts(const GroupGrid& e, const MergeInput& input) {
  const graph::Graph& graph = *input.motion.graph;
  const ArcWeigher weigher(graph.size, input.weights);
  for (const PartContact& contact : parts_.contacts()) {
    const RegionPart &p = parts_.list()[contact.a], &q = parts_.list()[contact.b];
    const size_t s = p.region - 1u, t = q.region - 1u;
    const graph::Arc* arc = s == t ? nullptr : findArc(graph, p.region, q.region);
    const int64_t rootArea = rootOfCells(std::min(p.cells, q.cells), e);
    const bool isPredicted = p.expected != 0 && p.expected == q.expected;
    const ArcEnergy energy{
        .motion = weigher.motion(input.motion.regions[s], input.motion.regions[t], rootArea),
        .border = weigher.border(contact.border * static_cast<uint32_t>(e.stepPx),
                                 arc ? arc->meanContrast() : 0),
        .arc = weigher.arc(graph.regions[s].colour, graph.regions[t].colour),
        .prediction = isPredicted ? weigher.prediction(rootArea) : 0};
    arcs_.push_back({contact.a, contact.b, energy.weight()});
  }
}

void TrackTerminals::compareCell(size_t cell, int64_t place, int64_t look) {
  const uint32_t part = parts_.at(cell);
  Agreement& agreement = agreement_[part];
  if (agreement.cells++ == 0) met_.push_back(part);
  agreement.place += place;
  agreement.look += look;
}

/// Of a track whose size tells where it ends.
void TrackTerminals::compareOutline(const GroupGrid& e, const FitTask& task,
                                    const TrackerState& state) {
  const Numbers::Ownership& n = state.numbers.ownership;
  const Track& track = state.tracks[task.trackIndex()];
  const int64_t outside = n.outside.of(kOne), most = n.most.of(kOne);
  const auto deviation = [&](int length) {
    return std::max(
        {n.spread.of(kOne * length), n.sways.of(int64_t{track.sway} * length), int64_t{1}});
  };
  const Box& box = task.fitted;
  columns_.list(box.x, box.width, e.grid.width, deviation(box.width), most - outside);
  rows_.list(box.y, box.height, e.grid.height, deviation(box.height), most - outside);
  for (int i = 0; i < rows_.size(); ++i)
    for (int j = 0; j < columns_.size(); ++j) {
      const size_t cell = e.at(columns_.begin + j, rows_.begin + i);
      if (e.group[cell] == 0) continue;
      const int64_t far =
          int64_t{rows_.squared[static_cast<size_t>(i)]} + columns_.squared[static_cast<size_t>(j)];
      compareCell(cell, far == 0 ? kOne : -std::min(outside + far, most),
                  lookOf(task, e.bin[cell], n));
    }
}

/// Of one whose size says nothing: it may be all of its blob.
void TrackTerminals::compareBlob(const GroupGrid& e, const FitTask& task,
                                 const TrackerState& state) {
  const size_t index = task.trackIndex();
  if (!state.blobs.has(index)) return;
  const Numbers::Ownership& n = state.numbers.ownership;
  const uint32_t blob = state.blobs.numberOf(index);
  const Box& box = state.blobs.of(index).box;
  for (int y = box.y; y < box.bottom(); ++y)
    for (int x = box.x; x < box.right(); ++x) {
      const size_t cell = e.at(x, y);
      if (e.group[cell] != 0 && state.blobs.at(cell) == blob)
        compareCell(cell, 0, lookOf(task, e.bin[cell], n));
    }
}

void TrackTerminals::comparePortrait(const GroupGrid& e, const FitTask& task,
                                     const TrackerState& state) {
  const Sighting& s = state.sightings[task.trackIndex()];
  const int64_t unit = state.numbers.ownership.portrait.of(state.appearance);
  forPortraitCells(state.tracks[task.trackIndex()].portrait, {e, *e.picture, {}}, s.corner,
                   [&](size_t cell, bool isAlike) {
                     Agreement& agreement = agreement_[parts_.at(cell)];
                     if (agreement.cells > 0) agreement.look += isAlike ? unit : -unit;
                   });
}

void TrackTerminals::tieToTrack(uint32_t terminal, const GroupGrid& e, const MergeInput& input,
                                const FitTask& task, const TrackerState& state) {
  const Track& track = state.tracks[task.trackIndex()];
  const Numbers::Ownership& n = state.numbers.ownership;
  agreement_.resize(parts_.list().size());
  met_.clear();
  if (!e.showsMovers && state.isSizeKnown(track))
    compareOutline(e, task, state);
  else
    compareBlob(e, task, state);
  if (state.sightings[task.trackIndex()].isMatched) comparePortrait(e, task, state);
  const ArcWeigher weigher(e.frame, input.weights);
  const motion::RegionMotion moves = motionOf(track, e, input.stepNs, state.numbers);
  std::sort(met_.begin(), met_.end());
  for (const uint32_t p : met_) {
    const Agreement agreement = std::exchange(agreement_[p], {});
    const RegionPart& part = parts_.list()[p];
    const int64_t rootArea = rootOfCells(part.cells, e);
    const int64_t beyond = n.most.of(kOne) * (part.cells - agreement.cells);
    const int64_t place = n.place.of((agreement.place - beyond) / part.cells);
    const int64_t expected = part.expected == task.track ? kOne : 0;
    const int64_t fit =
        input.weights.prediction * (place + expected) / kOne + agreement.look / part.cells;
    const int64_t weight =
        part.partedFrom == task.track
            ? kNever
            : rootArea * (fit + unplaced(input.weights, n)) -
                  weigher.motion(input.motion.regions[part.region - 1u], moves, rootArea);
    arcs_.push_back({p, terminal, weight});
  }
}

void TrackTerminals::tieToNobody(const GroupGrid& e, const MergeInput& input,
                                 const TrackerState& state) {
  const auto nobody = static_cast<uint32_t>(groupOf_.size() - 1);
  const int64_t gain = unplaced(input.weights, state.numbers.ownership);
  const auto parts = static_cast<uint32_t>(parts_.list().size());
  for (uint32_t p = 0; p < parts; ++p)
    arcs_.push_back({p, nobody, gain * rootOfCells(parts_.list()[p].cells, e)});
  for (uint32_t t = parts; t < nobody; ++t) arcs_.push_back({t, nobody, kNever});
}

/// Terminals that parts connect.
void TrackTerminals::keepApart(uint32_t nodes) {
  component_.resize(nodes);
  std::iota(component_.begin(), component_.end(), 0u);
  for (const WeightedArc& arc : arcs_) join(component_, arc.a, arc.b);
  numberSets(component_);
  for (auto a = static_cast<uint32_t>(parts_.list().size()); a < nodes; ++a)
    for (uint32_t b = a + 1; b < nodes; ++b)
      if (component_[a] == component_[b]) arcs_.push_back({a, b, kNever});
}

void TrackTerminals::give(const GroupGrid& e, TrackerState& state) {
  trackOf_.assign(groupOf_.size(), 0);
  for (size_t track = 1; track < terminals_.size(); ++track)
    if (terminals_[track] != 0)
      trackOf_[groupOf_[terminals_[track]]] = static_cast<uint16_t>(track);
  for (const RegionParts::PartRun& run : parts_.runs()) {
    const uint16_t owner = trackOf_[groupOf_[run.part]];
    const size_t first = e.at(run.cells.begin, run.cells.y);
    std::fill_n(state.owner.data() + first, run.cells.end - run.cells.begin, owner);
  }
}

/// A region that is all one track's tells to the pixel where that ends.
void TrackTerminals::sight(const GroupGrid& e, const graph::Graph& graph, TrackerState& state) {
  ownerOf_.assign(graph.regions.size(), kUnseen);
  for (uint32_t p = 0; p < parts_.list().size(); ++p) {
    const uint16_t owner = trackOf_[groupOf_[p]];
    uint16_t& known = ownerOf_[parts_.list()[p].region - 1u];
    known = known == kUnseen || known == owner ? owner : kSeveral;
  }
  const auto add = [&](uint16_t owner, const Box& box, uint64_t areaPx, int64_t sumX,
                       int64_t sumY) {
    Sighting& s = state.sightings[owner - 1u];
    s.box = unite(s.box, box);
    s.areaPx += areaPx;
    s.sumX += sumX;
    s.sumY += sumY;
  };
  for (size_t r = 0; r < ownerOf_.size(); ++r) {
    if (ownerOf_[r] == 0 || ownerOf_[r] >= kSeveral) continue;
    const graph::Region& region = graph.regions[r];
    add(ownerOf_[r], region.box, region.areaPx, int64_t{region.areaPx} * region.centroidX,
        int64_t{region.areaPx} * region.centroidY);
  }
  for (const RegionParts::PartRun& run : parts_.runs()) {
    const uint16_t owner = trackOf_[groupOf_[run.part]];
    if (owner == 0 || ownerOf_[parts_.list()[run.part].region - 1u] != kSeveral) continue;
    const Run& cells = run.cells;
    const Box box = intersect({cells.begin * e.stepPx, cells.y * e.stepPx,
                               (cells.end - cells.begin) * e.stepPx, e.stepPx},
                              boundsOf(e.frame));
    add(owner, box, static_cast<uint64_t>(box.area()),
        box.area() * (2 * box.x + box.width - 1) * 128,
        box.area() * (2 * box.y + box.height - 1) * 128);
  }
}

}  // namespace rg::objects
