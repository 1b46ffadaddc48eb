// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/motion_trends.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace rg::objects {
namespace {

constexpr int kStep = 2;  // Every second pixel of every second row tells enough.

/// What the previous frame knew of the pixels that a region came from.
MotionTrend trendBefore(std::span<const Run> runs, const motion::RegionMotion& now,
                        const MotionTrends& memory, int64_t alike) {
  const Image<uint16_t>& ids = memory.labels->ids;
  const Point shift{static_cast<int>(divideRounded(now.dx, motion::kMotionUnit)),
                    static_cast<int>(divideRounded(now.dy, motion::kMotionUnit))};
  int64_t weight = 0, sumX = 0, sumY = 0, samples = 0;
  for (const Run& run : runs) {
    if (run.y % kStep != 0) continue;
    samples += (run.end - run.begin + kStep - 1) / kStep;
    const int y = run.y - shift.y;
    if (y < 0 || y >= ids.height()) continue;
    const uint16_t* row = ids.row(y);
    for (int x = run.begin - shift.x; x < run.end - shift.x; x += kStep) {
      if (x < 0 || x >= ids.width() || row[x] == segmentation::kNoRegion) continue;
      const auto label = segmentation::RegionLabel::ofNumber(row[x]);
      const MotionTrend& trend = memory.before[label.index()];
      const int64_t dx = trend.dx - now.dx, dy = trend.dy - now.dy;
      if (dx * dx + dy * dy > alike * alike) continue;
      weight += trend.weight;
      sumX += int64_t{trend.weight} * trend.dx;
      sumY += int64_t{trend.weight} * trend.dy;
    }
  }
  if (weight == 0) return {};
  return {static_cast<int32_t>(divideRounded(sumX, weight)),
          static_cast<int32_t>(divideRounded(sumY, weight)),
          static_cast<int32_t>(weight / samples)};
}

/// The trend goes on with what the region shows in this frame.
void add(const motion::RegionMotion& now, const Numbers::Layers& numbers, MotionTrend& trend) {
  const auto halfReliable = static_cast<int32_t>(numbers.halfReliable.whole());
  const auto frames = static_cast<int32_t>(numbers.trendFrames.whole());
  const int32_t fresh = kFrameWeight * now.reliability / (now.reliability + halfReliable);
  trend.weight = std::min(trend.weight, (frames - 1) * kFrameWeight);
  const int32_t weight = trend.weight + fresh;
  if (weight == 0) return;
  const auto mix = [&](int32_t old, int32_t seen) {
    return static_cast<int32_t>(
        divideRounded(int64_t{old} * trend.weight + int64_t{seen} * fresh, weight));
  };
  trend = {mix(trend.dx, now.dx), mix(trend.dy, now.dy), weight};
}

}  // namespace

void followTrends(const motion::Motion& motion, const Executor& executor, MotionTrends& memory,
                  motion::Motion& trends, const Numbers::Layers& numbers) {
  const graph::Graph& graph = *motion.graph;
  const size_t count = graph.regions.size();
  std::swap(memory.ofRegion, memory.before);
  memory.ofRegion.assign(count, {});
  trends.size = motion.size;
  trends.status = motion.status;
  trends.graph = motion.graph;
  trends.regions.resize(count);
  const bool hasBefore =
      motion.status != Status::Skipped && memory.labels && memory.labels->size == graph.size;
  executor.forEach(static_cast<int>(count), [&](int index) {
    const auto r = static_cast<size_t>(index);
    const motion::RegionMotion& now = motion.regions[r];
    MotionTrend& trend = memory.ofRegion[r];
    if (hasBefore) trend = trendBefore(graph.runs.of(r), now, memory, numbers.trendAlike.whole());
    add(now, numbers, trend);
    const auto reliability =
        motion::kFullReliability * trend.weight / (trend.weight + kFrameWeight);
    trends.regions[r] = {trend.dx, trend.dy, now.sad, static_cast<uint16_t>(reliability)};
  });
  memory.labels = graph.labels;
}

}  // namespace rg::objects
