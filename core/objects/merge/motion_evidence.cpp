// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/motion_evidence.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <utility>

namespace rg::objects {
namespace {

constexpr int kStep = 4;                  // Pixels between samples.
constexpr int kAlike = 16;                // Grey levels by which a sample may have changed.
constexpr int64_t kMost = kGainUnit;      // Of a pixel's gain.
constexpr int64_t kHalfNs = 100'000'000;  // That leave half of it.

Size gridOf(Size frame) {
  return {(frame.width + kStep - 1) / kStep, (frame.height + kStep - 1) / kStep};
}

/// What is left of `unit` after so long.
int64_t fade(int64_t unit, int64_t ns) {
  return unit * kHalfNs / (kHalfNs + std::min(ns, 1000 * kHalfNs));
}

}  // namespace

void MotionEvidence::reset() {
  frame_ = {};
  hasAny_ = false;
  carried_.clear();
}

void MotionEvidence::carry(const motion::Motion& motion, ImageView<const uint8_t> previous,
                           int64_t stepNs, const Executor& executor) {
  const size_t count = motion.regions.size();
  carried_.assign(count, 0);
  const Size grid = gridOf(motion.size);
  std::swap(now_, before_);
  now_.resize(grid);
  now_.fill(0);
  const bool hadAny = std::exchange(hasAny_, false);
  if (std::exchange(frame_, motion.size) != motion.size || previous.size != motion.size) return;
  if (!hadAny) return;
  const graph::Graph& graph = *motion.graph;
  const ImageView<const uint8_t> luma = graph.picture->luma();
  const int64_t left = fade(256, stepNs);
  executor.forRows(grid.height, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const int y = v * kStep;
      const uint16_t* ids = graph.labels->ids.row(y);
      for (int u = 0; u < grid.width; ++u) {
        const int x = u * kStep;
        const auto label = segmentation::RegionLabel::ofNumber(ids[x]);
        if (!label) continue;
        const motion::RegionMotion& m = motion.regions[label.index()];
        const int px = x - static_cast<int>(divideRounded(m.dx, motion::kMotionUnit));
        const int py = y - static_cast<int>(divideRounded(m.dy, motion::kMotionUnit));
        if (px < 0 || py < 0 || px >= motion.size.width || py >= motion.size.height) continue;
        if (absDiff(luma.row(y)[x], previous.row(py)[px]) > kAlike) continue;
        const int pu = std::min((px + kStep / 2) / kStep, grid.width - 1);
        const int pv = std::min((py + kStep / 2) / kStep, grid.height - 1);
        now_.row(v)[u] = static_cast<int16_t>(before_.row(pv)[pu] * left / 256);
      }
    }
  });
  sums_.assign(count, 0);
  samples_.assign(count, 0);
  for (int v = 0; v < grid.height; ++v) {
    const uint16_t* ids = graph.labels->ids.row(v * kStep);
    for (int u = 0; u < grid.width; ++u) {
      const auto label = segmentation::RegionLabel::ofNumber(ids[u * kStep]);
      if (!label) continue;
      sums_[label.index()] += now_.row(v)[u];
      ++samples_[label.index()];
    }
  }
  for (size_t i = 0; i < count; ++i)
    if (sums_[i] > 0) {
      carried_[i] = sums_[i] * int64_t{graph.regions[i].areaPx} / samples_[i];
      hasAny_ = true;
    }
}

void MotionEvidence::add(const motion::Motion& motion, std::span<const OwnMotion> own,
                         const Executor& executor) {
  const graph::Graph& graph = *motion.graph;
  density_.clear();
  for (size_t i = 0; i < own.size(); ++i)
    density_.push_back(static_cast<int16_t>(std::clamp<int64_t>(
        own[i].gain / std::max<int64_t>(graph.regions[i].areaPx, 1), -kMost, kMost)));
  hasAny_ |= std::any_of(density_.begin(), density_.end(), [](int16_t gain) { return gain > 0; });
  if (!hasAny_) return;
  executor.forRows(now_.height(), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const uint16_t* ids = graph.labels->ids.row(v * kStep);
      int16_t* row = now_.row(v);
      for (int u = 0; u < now_.width(); ++u)
        if (const auto label = segmentation::RegionLabel::ofNumber(ids[u * kStep]))
          row[u] =
              static_cast<int16_t>(std::clamp<int64_t>(row[u] + density_[label.index()], 0, kMost));
    }
  });
}

}  // namespace rg::objects
