// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/motion_evidence.hpp"

#include "core/objects/operations.hpp"

#include <algorithm>
#include <utility>

namespace rg::objects {
namespace {

constexpr int64_t kMost = kGainUnit;  // Of a pixel's gain.

/// What is asked of each sample, found once.
struct KnownPixels {
  ImageView<const uint8_t> now, before;
  ImageView<const int16_t> gains;
  int left;

  explicit KnownPixels(const KnownEvidence& known)
      : now(known.motion.graph->picture->luma()),
        before(known.previous.luma()),
        gains(known.gains),
        left(known.left) {}

  /// What the sample at p takes over.
  [[nodiscard]] int16_t carriedTo(Point p, const motion::RegionMotion& m) const {
    const Point from = cameFrom(p, m);
    if (!boundsOf(now.size).contains(from)) return 0;
    const Point sample = sampleAt(from, gains.size), nearest = pixelOf(sample);
    const uint8_t shown = before.at(from.x, from.y);
    if (!showsTheSame(now.at(p.x, p.y), shown) ||
        !showsTheSame(shown, before.at(nearest.x, nearest.y)))
      return 0;
    return fadedGain(gains.at(sample.x, sample.y), left);
  }
};

}  // namespace

void carryEvidence(const KnownEvidence& known, const Executor& executor,
                   const CarriedEvidence& carried) {
  const segmentation::Labels& labels = *known.motion.graph->labels;
  const Size grid = carried.gains.size();
  const ImageView<int16_t> gains = carried.gains;
  const KnownPixels pixels(known);
  executor.forRows(grid.height, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const uint16_t* ids = labels.ids.row(v * kEvidenceStep);
      for (int u = 0; u < grid.width; ++u) {
        const Point p = pixelOf({u, v});
        const auto label = segmentation::RegionLabel::ofNumber(ids[p.x]);
        gains.at(u, v) =
            label ? pixels.carriedTo(p, known.motion.regions[label.index()]) : int16_t{0};
      }
    }
  });
  for (int v = 0; v < grid.height; ++v) {
    const uint16_t* ids = labels.ids.row(v * kEvidenceStep);
    for (int u = 0; u < grid.width; ++u) {
      const auto label = segmentation::RegionLabel::ofNumber(ids[u * kEvidenceStep]);
      if (!label) continue;
      carried.sums[label.index()] += gains.at(u, v);
      ++carried.samples[label.index()];
    }
  }
}

void addEvidence(const graph::Graph& graph, std::span<const int16_t> density,
                 const Image<int16_t>& gains, const Executor& executor, Image<int16_t>& sum) {
  const ImageView<int16_t> to = sum;
  executor.forRows(to.height(), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const uint16_t* ids = graph.labels->ids.row(v * kEvidenceStep);
      const int16_t* from = gains.row(v);
      int16_t* row = to.row(v);
      for (int u = 0; u < to.width(); ++u) {
        const auto label = segmentation::RegionLabel::ofNumber(ids[u * kEvidenceStep]);
        row[u] = label ? gainWith(from[u], density[label.index()]) : from[u];
      }
    }
  });
}

void MotionEvidence::reset() {
  frame_ = {};
  hasAny_ = false;
  carried_.clear();
}

void MotionEvidence::carry(const motion::Motion& motion, const Picture* previous, int64_t stepNs,
                           Operations& operations) {
  const size_t count = motion.regions.size();
  carried_.assign(count, 0);
  shown_.resize(evidenceGridOf(motion.size));
  const bool isKnown = std::exchange(hasAny_, false);
  const bool isAlike = std::exchange(frame_, motion.size) == motion.size;
  if (!isKnown || !isAlike || previous == nullptr || previous->size() != motion.size)
    return shown_.fill(0);
  sums_.assign(count, 0);
  samples_.assign(count, 0);
  operations.carryEvidence({motion, *previous, known_, leftOfEvidence(stepNs)},
                           {shown_, sums_, samples_});
  for (size_t i = 0; i < count; ++i)
    if (sums_[i] > 0) {
      carried_[i] = sums_[i] * int64_t{motion.graph->regions[i].areaPx} / samples_[i];
      hasAny_ = true;
    }
}

void MotionEvidence::add(const motion::Motion& motion, std::span<const OwnMotion> own,
                         Operations& operations) {
  const graph::Graph& graph = *motion.graph;
  density_.clear();
  for (size_t i = 0; i < own.size(); ++i)
    density_.push_back(static_cast<int16_t>(std::clamp<int64_t>(
        own[i].gain / std::max<int64_t>(graph.regions[i].areaPx, 1), -kMost, kMost)));
  hasAny_ |= std::any_of(density_.begin(), density_.end(), [](int16_t gain) { return gain > 0; });
  if (!hasAny_) return;
  known_.resize(shown_.size());
  operations.addEvidence(graph, density_, shown_, known_);
}

}  // namespace rg::objects
