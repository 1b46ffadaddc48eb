// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/motion_layers.hpp"

#include "core/base/forest.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <bit>
#include <tuple>

namespace rg::objects {
namespace {

constexpr int kWeightBits = 16;     // More would overflow when squared.
constexpr uint64_t kDriftStep = 8;  // 1/16 px per frame: drifts that differ by less count as one.

using Layer = LayerScratch::Layer;

/// What was two objects stays so until it is seen to move as one.
bool areApart(const Layer& a, const Layer& b, const Numbers::Layers& n) {
  const bool wereApart = a.expected && b.expected && a.expected != b.expected;
  if (a.weight < n.leastTrust * a.areaPx || b.weight < n.leastTrust * b.areaPx) return wereApart;
  const auto mover = [](const Layer& layer) {
    return Mover{layer.momentX / layer.weight, layer.momentY / layer.weight, layer.weight};
  };
  const Number least = wereApart ? n.keptDrift : n.leastDrift;
  return moveApart(mover(a), mover(b), least.whole(), n.smallShare);
}

/// Legs stand while the body walks on, and hang below it.
bool areStacked(const Box& a, const Box& b, const Numbers::Layers& n) {
  const int columns = std::min(a.right(), b.right()) - std::max(a.x, b.x);
  const int rows = std::min(a.bottom(), b.bottom()) - std::max(a.y, b.y);
  return columns >= n.stackedColumns * std::min(a.width, b.width) &&
         rows < n.stackedRows * std::min(a.height, b.height);
}

void joinLayers(uint32_t a, uint32_t b, LayerScratch& s) {
  join(s.parent, a, b);
  Layer& into = s.layers[std::min(a, b)];
  const Layer& from = s.layers[std::max(a, b)];
  into.box = unite(into.box, from.box);
  into.areaPx += from.areaPx;
  into.weight += from.weight;
  into.momentX += from.momentX;
  into.momentY += from.momentY;
  if (into.expected == from.expected) {
    into.expectedPx += from.expectedPx;
  } else if (from.expectedPx > into.expectedPx) {
    into.expectedPx = from.expectedPx;
    into.expected = from.expected;
  }
}

/// A layer per region.
void startLayers(const motion::Motion& trends, std::span<const TrackIndex> expected,
                 LayerScratch& s) {
  const std::vector<graph::Region>& regions = trends.graph->regions;
  s.layers.resize(regions.size());
  s.parent.resize(regions.size());
  for (uint32_t r = 0; r < regions.size(); ++r) {
    const int64_t areaPx = regions[r].areaPx;
    const int64_t weight = areaPx * trends.regions[r].reliability;
    s.parent[r] = r;
    s.layers[r] = {.box = regions[r].box,
                   .areaPx = areaPx,
                   .weight = weight,
                   .momentX = weight * trends.regions[r].dx,
                   .momentY = weight * trends.regions[r].dy,
                   .expectedPx = expected[r] ? areaPx : 0,
                   .expected = expected[r]};
  }
}

void sortLinks(std::vector<LayerScratch::Link>& links) {
  std::sort(links.begin(), links.end(), [](const auto& p, const auto& q) {
    return std::tuple(p.key, p.a, p.b) < std::tuple(q.key, q.a, q.b);
  });
}

/// Arcs within groups, those first whose regions were one object, move alike and touch much.
void linkRegions(const motion::Motion& trends, std::span<const uint32_t> groupOf, LayerScratch& s) {
  s.links.clear();
  for (const graph::Arc& arc : trends.graph->arcs) {
    const uint32_t a = arc.a.index(), b = arc.b.index();
    if (groupOf[a] != groupOf[b]) continue;
    const motion::RegionMotion &v = trends.regions[a], &w = trends.regions[b];
    const int64_t dx = v.dx - w.dx, dy = v.dy - w.dy;
    const uint64_t drift = integerSqrt(static_cast<uint64_t>(dx * dx + dy * dy)) / kDriftStep;
    const TrackIndex p = s.layers[a].expected, q = s.layers[b].expected;
    const uint64_t areTwo = p && q && p != q;
    s.links.push_back({areTwo << 60 | drift << 32 | (UINT32_MAX - arc.borderPx), a, b});
  }
  sortLinks(s.links);
}

/// Layers that touch, those first that have most border in common.
void linkLayers(const graph::Graph& graph, LayerScratch& s) {
  s.links.clear();
  for (const graph::Arc& arc : graph.arcs) {
    const uint32_t a = rootOf(s.parent, arc.a.index()), b = rootOf(s.parent, arc.b.index());
    if (a != b) s.links.push_back({arc.borderPx, std::min(a, b), std::max(a, b)});
  }
  std::sort(s.links.begin(), s.links.end(), [](const auto& p, const auto& q) {
    return std::tuple(p.a, p.b, p.key) < std::tuple(q.a, q.b, q.key);
  });
  size_t kept = 0;
  for (const LayerScratch::Link& link : s.links) {
    if (kept > 0 && s.links[kept - 1].a == link.a && s.links[kept - 1].b == link.b)
      s.links[kept - 1].key += link.key;
    else
      s.links[kept++] = link;
  }
  s.links.resize(kept);
  for (LayerScratch::Link& link : s.links) link.key = UINT64_MAX - link.key;
  sortLinks(s.links);
}

}  // namespace

bool moveApart(const Mover& a, const Mover& b, int64_t least, Number smallShare) {
  const int64_t dx = a.dx - b.dx, dy = a.dy - b.dy;
  const int64_t most = std::max(a.weight, b.weight);
  const auto bits = static_cast<int>(std::bit_width(static_cast<uint64_t>(most)));
  const int shift = std::max(0, bits - kWeightBits);
  const int64_t larger = most >> shift,
                share = smallShare.den * (std::min(a.weight, b.weight) >> shift) / smallShare.num;
  const int64_t far = least * std::max(larger, share);
  return share > 0 && (dx * dx + dy * dy) * share * share >= far * far;
}

void partGroups(const motion::Motion& trends, std::span<const TrackIndex> expected, LayerScratch& s,
                std::vector<uint32_t>& groupOf, const Numbers::Layers& numbers) {
  startLayers(trends, expected, s);
  linkRegions(trends, groupOf, s);
  for (const LayerScratch::Link& link : s.links) {
    const uint32_t a = rootOf(s.parent, link.a), b = rootOf(s.parent, link.b);
    if (a != b && !areApart(s.layers[a], s.layers[b], numbers)) joinLayers(a, b, s);
  }
  linkLayers(*trends.graph, s);
  for (const LayerScratch::Link& link : s.links) {
    const uint32_t a = rootOf(s.parent, link.a), b = rootOf(s.parent, link.b);
    if (a != b && areStacked(s.layers[a].box, s.layers[b].box, numbers)) joinLayers(a, b, s);
  }
  numberSets(s.parent);
  std::copy(s.parent.begin(), s.parent.end(), groupOf.begin());
}

}  // namespace rg::objects
