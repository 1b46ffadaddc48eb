// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/parallax.hpp"

#include "core/base/forest.hpp"
#include "core/base/pixel.hpp"
#include "core/objects/merge/compared_frame.hpp"
#include "core/objects/merge/motion_evidence.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <numeric>

namespace rg::objects {
namespace {

constexpr int64_t kPixel = motion::kMotionUnit;
constexpr int64_t kShareUnit = 1 << 16;

}  // namespace

/// Whether a motion beyond the plane's goes on along with it.
bool Parallax::goesAlong(Point beyond, Point plane) const {
  const int64_t length =
      integerSqrt(static_cast<uint64_t>(int64_t{plane.x} * plane.x + int64_t{plane.y} * plane.y));
  if (length < kPixel) return false;
  const int64_t along = (int64_t{plane.x} * beyond.x + int64_t{plane.y} * beyond.y) / length;
  const int64_t across = (int64_t{plane.x} * beyond.y - int64_t{plane.y} * beyond.x) / length;
  const int64_t off = std::max(numbers_.offLine.of(kPixel), numbers_.offLineShare.of(along));
  return along >= kPixel * numbers_.leastSlide && std::abs(across) <= off;
}

void Parallax::look(const motion::Motion& motion, std::span<const uint8_t> isKnown, int64_t stepNs,
                    const Numbers::Parallax& numbers) {
  numbers_ = numbers;
  const graph::Graph& graph = *motion.graph;
  const size_t count = graph.regions.size();
  slides_.clear();
  for (size_t i = 0; i < count; ++i) {
    const Point plane = ComparedFrame::at(motion.camera, motion, i);
    const motion::RegionMotion& m = motion.regions[i];
    const bool isAsked = isKnown.empty() || isKnown[i] == 0;
    slides_.push_back(isAsked && goesAlong({m.dx - plane.x, m.dy - plane.y}, plane));
  }
  pieceOf_.resize(count);
  std::iota(pieceOf_.begin(), pieceOf_.end(), 0u);
  for (const graph::Arc& arc : graph.arcs)
    if (slides_[arc.a.index()] != 0 && slides_[arc.b.index()] != 0)
      join(pieceOf_, static_cast<uint32_t>(arc.a.index()), static_cast<uint32_t>(arc.b.index()));
  pieceWeight_.assign(numberSets(pieceOf_), 0);
  int64_t all = 1, sliding = 0, heaviest = 0;
  for (size_t i = 0; i < count; ++i) {
    const int64_t weight = int64_t{graph.regions[i].areaPx} * motion.regions[i].reliability;
    all += weight;
    if (slides_[i] == 0) continue;
    sliding += weight;
    heaviest = std::max(heaviest, pieceWeight_[pieceOf_[i]] += weight);
  }
  const int64_t left = leftOfEvidence(stepNs);
  const int64_t share = kShareUnit * (sliding - heaviest) / all;  // 2^26 px · 2^8 · 2^16 fit.
  seen_ = (seen_ * left + share * (kAllEvidence - left)) / kAllEvidence;
}

bool Parallax::explains(Point beyond, Point plane) const {
  return seen_ > kShareUnit * numbers_.leastShare && goesAlong(beyond, plane);
}

}  // namespace rg::objects
