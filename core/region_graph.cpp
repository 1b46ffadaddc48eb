// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/region_graph.hpp"

#include "core/arc_table.hpp"
#include "core/pixel.hpp"
#include "core/pool.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rg {
namespace {

constexpr int kCentroidFraction = 256;
constexpr int kMostBands = 8;

struct RegionSums {
  uint64_t x = 0, y = 0, red = 0, green = 0, blue = 0;
  uint32_t areaPx = 0;
  int32_t left = INT32_MAX, right = 0, top = INT32_MAX, bottom = 0;  // right, bottom: exclusive.
};

/// What one task saw; tasks are joined by sums, minima and maxima.
struct BandSums {
  std::vector<RegionSums> regions;
  ArcTable arcs;
};

void add(RegionSums& to, const RegionSums& from) {
  to.x += from.x;
  to.y += from.y;
  to.red += from.red;
  to.green += from.green;
  to.blue += from.blue;
  to.areaPx += from.areaPx;
  to.left = std::min(to.left, from.left);
  to.right = std::max(to.right, from.right);
  to.top = std::min(to.top, from.top);
  to.bottom = std::max(to.bottom, from.bottom);
}

Region describe(const RegionSums& sums) {
  const auto area = int64_t{sums.areaPx};
  const auto mean = [&](uint64_t sum) {
    return static_cast<uint8_t>(divideRounded(static_cast<int64_t>(sum), area));
  };
  const auto centre = [&](uint64_t sum) {
    return static_cast<int32_t>(divideRounded(static_cast<int64_t>(sum) * kCentroidFraction, area));
  };
  return {sums.areaPx,
          {sums.left, sums.top, sums.right - sums.left, sums.bottom - sums.top},
          centre(sums.x),
          centre(sums.y),
          {mean(sums.red), mean(sums.green), mean(sums.blue)}};
}

class GraphBuilder {
 public:
  GraphBuilder(const Labels& labels, Connectivity connectivity)
      : labels_(labels),
        planes_{labels.picture->red(), labels.picture->green(), labels.picture->blue()},
        channels_(labels.picture->isGrey() ? 1 : 3),
        connectivity_(connectivity) {}

  void addRow(int y, BandSums& sums) const {
    addRuns(y, sums);
    if (y == 0) return;
    addArcs(y, {0, 0}, sums.arcs);
    if (connectivity_ == Connectivity::Four) return;
    addArcs(y, {1, 0}, sums.arcs);
    addArcs(y, {0, 1}, sums.arcs);
  }

 private:
  /// Where the lower and the upper pixel of the first pair of a row lie.
  struct Offsets {
    int lower, upper;
  };

  void addRuns(int y, BandSums& sums) const {
    const uint16_t* ids = labels_.ids.row(y);
    const int width = labels_.size.width;
    for (int first = 0; first < width;) {
      int last = first + 1;
      while (last < width && ids[last] == ids[first]) ++last;
      if (ids[first] != kNoRegion) addRun(y, first, last, sums.regions[ids[first] - 1u]);
      if (last < width && ids[first] != kNoRegion && ids[last] != kNoRegion)
        sums.arcs.add(ids[first], ids[last], contrast({last - 1, y}, {last, y}));
      first = last;
    }
  }

  void addRun(int y, int first, int last, RegionSums& sums) const {
    const auto length = static_cast<uint64_t>(last - first);
    uint32_t channel[3] = {};
    for (size_t c = 0; c < 3; ++c) {
      const uint8_t* row = planes_[c].row(y);
      for (int x = first; x < last; ++x) channel[c] += row[x];
    }
    add(sums, {(static_cast<uint64_t>(first) + static_cast<uint64_t>(last - 1)) * length / 2,
               static_cast<uint64_t>(y) * length, channel[0], channel[1], channel[2],
               static_cast<uint32_t>(length), first, last, y, y + 1});
  }

  void addArcs(int y, Offsets offsets, ArcTable& arcs) const {
    const uint16_t* lower = labels_.ids.row(y) + offsets.lower;
    const uint16_t* upper = labels_.ids.row(y - 1) + offsets.upper;
    const int count = labels_.size.width - offsets.lower - offsets.upper;
    for (int i = 0; i < count; ++i) {
      if (lower[i] == upper[i] || lower[i] == kNoRegion || upper[i] == kNoRegion) continue;
      arcs.add(lower[i], upper[i], contrast({i + offsets.lower, y}, {i + offsets.upper, y - 1}));
    }
  }

  uint32_t contrast(Point p, Point q) const {
    int largest = 0;
    for (int c = 0; c < channels_; ++c) {
      const ImageView<const uint8_t>& plane = planes_[static_cast<size_t>(c)];
      largest = std::max(largest, absDiff(plane.row(p.y)[p.x], plane.row(q.y)[q.x]));
    }
    return static_cast<uint32_t>(largest);
  }

  const Labels& labels_;
  const std::array<ImageView<const uint8_t>, 3> planes_;
  const int channels_;
  const Connectivity connectivity_;
};

class CpuGraph : public GraphStage {
 public:
  explicit CpuGraph(Context context)
      : context_(std::move(context)),
        bands_(static_cast<size_t>(std::min(context_.cpu->threads(), kMostBands))) {}

  Result<std::shared_ptr<const Graph>> process(std::shared_ptr<const Labels> labels,
                                               const GraphParams& params) override;
  void reset(Reset) override {}

 private:
  Context context_;
  std::vector<BandSums> bands_;
  ArcSorter sorter_;
  Pool<Graph> pool_;
};

Result<std::shared_ptr<const Graph>> CpuGraph::process(std::shared_ptr<const Labels> labels,
                                                       const GraphParams& params) {
  const auto graph = pool_.take();
  graph->size = labels->size;
  graph->status = labels->status;
  graph->regions.clear();
  graph->arcs.clear();
  if (labels->status != Status::Skipped) {
    const GraphBuilder builder(*labels, params.connectivity);
    const auto count = static_cast<int>(bands_.size());
    context_.cpu->forEach(count, [&](int i) {
      BandSums& sums = bands_[static_cast<size_t>(i)];
      sums.regions.assign(labels->count, {});
      sums.arcs.clear();
      const int last = labels->size.height * (i + 1) / count;
      for (int y = labels->size.height * i / count; y < last; ++y) builder.addRow(y, sums);
    });
    for (size_t i = 1; i < bands_.size(); ++i)
      for (size_t r = 0; r < labels->count; ++r) add(bands_[0].regions[r], bands_[i].regions[r]);
    for (const RegionSums& sums : bands_[0].regions) graph->regions.push_back(describe(sums));
    for (const BandSums& sums : bands_) sums.arcs.appendTo(graph->arcs);
    sorter_.sortAndJoin(graph->arcs, labels->count);
  }
  graph->labels = std::move(labels);
  return std::shared_ptr<const Graph>(graph);
}

}  // namespace

std::unique_ptr<GraphStage> makeGraphStage(Context context) {
  return std::make_unique<CpuGraph>(std::move(context));
}

}  // namespace rg
