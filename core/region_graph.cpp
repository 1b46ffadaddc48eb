// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/region_graph.hpp"

#include "core/arc_table.hpp"
#include "core/pixel.hpp"
#include "core/pool.hpp"
#include "core/simd/run_rows.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace rg {
namespace {

constexpr int kCentroidFraction = 256;
constexpr int kMostBands = 8;

struct RegionSums {
  uint64_t x = 0, y = 0, red = 0, green = 0, blue = 0;
  uint32_t areaPx = 0;
  int32_t left = INT32_MAX, right = 0, top = INT32_MAX, bottom = 0;  // right, bottom: exclusive.
  uint32_t runs = 0;  ///< Their number; then where the next one goes in the graph.
};

/// What one task saw; tasks are joined by sums, minima and maxima.
struct BandSums {
  std::vector<RegionSums> regions;
  ArcTable arcs;
  /// Where the runs of a row begin, with the width behind the last: one row after another, from
  /// the one above the band on.
  std::vector<uint16_t> begins;
  std::vector<size_t> rows;                 ///< Where the rows begin in `begins`, and its end.
  std::vector<simd::ChannelSums> channels;  ///< Of each run of a row.
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
  to.runs += from.runs;
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

/// Rows first … last − 1: a task's share.
struct Band {
  int first, last;
  /// The first row that is looked at.
  [[nodiscard]] int above() const { return std::max(first - 1, 0); }
};

class GraphBuilder {
 public:
  GraphBuilder(const Labels& labels, Connectivity connectivity)
      : labels_(labels),
        planes_{labels.picture->red(), labels.picture->green(), labels.picture->blue()},
        channels_(labels.picture->isGrey() ? 1 : 3),
        connectivity_(connectivity) {}

  void addRows(const Band& band, BandSums& sums) const {
    const auto rows = static_cast<size_t>(band.last - band.above());
    sums.begins.resize(rows * (static_cast<size_t>(labels_.size.width) + 1));
    sums.rows.assign(1, 0);
    for (int y = band.above(); y < band.last; ++y) {
      findRuns(y, sums);
      if (y < band.first) continue;
      addRuns(y, runsOf(y, band, sums), sums);
      if (y > 0) addArcsAbove(y, runsOf(y, band, sums), runsOf(y - 1, band, sums), sums.arcs);
    }
  }

  /// Hands the runs out to the places that their regions have for them.
  void placeRuns(const Band& band, BandSums& sums, std::vector<RegionRun>& list) const {
    for (int y = band.first; y < band.last; ++y) {
      const uint16_t* ids = labels_.ids.row(y);
      const auto begins = runsOf(y, band, sums);
      for (size_t i = 0; i + 1 < begins.size(); ++i)
        if (const uint16_t label = ids[begins[i]]; label != kNoRegion)
          list[sums.regions[label - 1u].runs++] = {static_cast<uint16_t>(y), begins[i],
                                                   begins[i + 1]};
    }
  }

 private:
  /// By how much the pixel above is shifted against the lower one of a pair.
  using Lean = int;

  void findRuns(int y, BandSums& sums) const {
    uint16_t* begins = sums.begins.data() + sums.rows.back();
    const int runs = simd::findRuns(labels_.ids.row(y), labels_.size.width, begins);
    sums.rows.push_back(sums.rows.back() + static_cast<size_t>(runs) + 1);
  }

  static std::span<const uint16_t> runsOf(int y, const Band& band, const BandSums& sums) {
    const auto row = static_cast<size_t>(y - band.above());
    return std::span(sums.begins).subspan(sums.rows[row], sums.rows[row + 1] - sums.rows[row]);
  }

  void addRuns(int y, std::span<const uint16_t> begins, BandSums& sums) const {
    const uint16_t* ids = labels_.ids.row(y);
    const size_t count = begins.size() - 1;
    sums.channels.resize(count);
    simd::sumRuns({{planes_[0].row(y), planes_[1].row(y), planes_[2].row(y)}}, begins.data(),
                  static_cast<int>(count), sums.channels.data());
    for (size_t i = 0; i < count; ++i) {
      const int first = begins[i], last = begins[i + 1];
      const uint16_t label = ids[first];
      if (label == kNoRegion) continue;
      addRun(y, first, last, sums.channels[i], sums.regions[label - 1u]);
      if (i + 1 < count && ids[last] != kNoRegion)
        sums.arcs.add(label, ids[last], 1, contrast({last - 1, y}, {last, y}));
    }
  }

  static void addRun(int y, int first, int last, const simd::ChannelSums& channels,
                     RegionSums& sums) {
    const auto length = static_cast<uint64_t>(last - first);
    add(sums, {(static_cast<uint64_t>(first) + static_cast<uint64_t>(last - 1)) * length / 2,
               static_cast<uint64_t>(y) * length, channels.sums[0], channels.sums[1],
               channels.sums[2], static_cast<uint32_t>(length), first, last, y, y + 1, 1});
  }

  void addArcsAbove(int y, std::span<const uint16_t> lower, std::span<const uint16_t> upper,
                    ArcTable& arcs) const {
    addArcs(y, 0, lower, upper, arcs);
    if (connectivity_ == Connectivity::Four) return;
    addArcs(y, -1, lower, upper, arcs);
    addArcs(y, 1, lower, upper, arcs);
  }

  /// Walks the pieces of the row over which neither the run nor the one above changes.
  void addArcs(int y, Lean lean, std::span<const uint16_t> lower, std::span<const uint16_t> upper,
               ArcTable& arcs) const {
    const uint16_t *ids = labels_.ids.row(y), *idsAbove = labels_.ids.row(y - 1);
    const int end = labels_.size.width - std::max(lean, 0);
    size_t i = 0, j = 0;
    for (int x = std::max(-lean, 0); x < end;) {
      while (lower[i + 1] <= x) ++i;
      while (upper[j + 1] <= x + lean) ++j;
      const int next = std::min({int{lower[i + 1]}, upper[j + 1] - lean, end});
      const uint16_t label = ids[x], other = idsAbove[x + lean];
      if (label != other && label != kNoRegion && other != kNoRegion) {
        uint32_t sum = 0;
        for (int p = x; p < next; ++p) sum += contrast({p, y}, {p + lean, y - 1});
        arcs.add(label, other, static_cast<uint32_t>(next - x), sum);
      }
      x = next;
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
  void sumBands(const GraphBuilder& builder, const Labels& labels);
  void sortRuns(const GraphBuilder& builder, const Labels& labels, RegionRuns& runs);
  template <class Task>
  void forBands(int height, const Task& task) {
    const auto count = static_cast<int>(bands_.size());
    context_.cpu->forEach(count, [&](int i) {
      task(Band{height * i / count, height * (i + 1) / count}, bands_[static_cast<size_t>(i)]);
    });
  }

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
  graph->runs.list.clear();
  graph->runs.starts.assign(1, 0);
  if (labels->status != Status::Skipped) {
    const GraphBuilder builder(*labels, params.connectivity);
    sumBands(builder, *labels);
    sortRuns(builder, *labels, graph->runs);
    for (size_t i = 1; i < bands_.size(); ++i)
      for (size_t r = 0; r < labels->count; ++r) add(bands_[0].regions[r], bands_[i].regions[r]);
    for (const RegionSums& sums : bands_[0].regions) graph->regions.push_back(describe(sums));
    for (const BandSums& sums : bands_) sums.arcs.appendTo(graph->arcs);
    sorter_.sortAndJoin(graph->arcs, labels->count);
  }
  graph->labels = std::move(labels);
  return std::shared_ptr<const Graph>(graph);
}

void CpuGraph::sumBands(const GraphBuilder& builder, const Labels& labels) {
  forBands(labels.size.height, [&](const Band& band, BandSums& sums) {
    sums.regions.assign(labels.count, {});
    sums.arcs.clear();
    builder.addRows(band, sums);
  });
}

/// A band's runs of a region follow those of the bands above.
void CpuGraph::sortRuns(const GraphBuilder& builder, const Labels& labels, RegionRuns& runs) {
  runs.starts.resize(size_t{labels.count} + 1);
  uint32_t place = 0;
  for (size_t r = 0; r < labels.count; ++r) {
    runs.starts[r] = place;
    for (BandSums& band : bands_) place += std::exchange(band.regions[r].runs, place);
  }
  runs.starts[labels.count] = place;
  runs.list.resize(place);
  forBands(labels.size.height,
           [&](const Band& band, BandSums& sums) { builder.placeRuns(band, sums, runs.list); });
}

}  // namespace

std::unique_ptr<GraphStage> makeGraphStage(Context context) {
  return std::make_unique<CpuGraph>(std::move(context));
}

}  // namespace rg
