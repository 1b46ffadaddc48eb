// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/graph/operations.hpp"

#include "core/base/pixel.hpp"
#include "core/graph/arc_table.hpp"
#include "core/graph/region_sums.hpp"
#include "core/simd/base/run_rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <span>
#include <utility>

namespace rg::graph {
namespace {

using segmentation::RegionLabel;

constexpr int kMostBands = 8;

/// What one task saw; tasks are joined by sums, minima and maxima.
struct BandSums {
  std::vector<RegionSums> regions;
  ArcTable arcs;
  /// Where the runs of a row begin, with the width behind the last: one row after another.
  std::vector<uint16_t> begins;
  std::vector<size_t> rows;                     ///< Where the rows begin in `begins`, and its end.
  std::vector<rg::simd::ChannelSums> channels;  ///< Of each run of a row.
  std::vector<uint64_t> alike;  ///< Bits of the pixels whose upper neighbour is alike.
};

/// Rows first … last − 1: a task's share.
struct Band {
  int first, last;
};

class GraphBuilder {
 public:
  GraphBuilder(const segmentation::Labels& labels, Connectivity connectivity)
      : labels_(labels),
        planes_{labels.picture->red(), labels.picture->green(), labels.picture->blue()},
        connectivity_(connectivity) {}

  void addRows(const Band& band, BandSums& sums) const {
    beginRows(band, sums);
    for (int y = band.first; y < band.last; ++y) {
      findRuns(y, sums);
      addRuns(y, runsOf(y, band, sums), sums);
      if (y > 0) addArcsAbove(y, sums);
    }
  }

  /// Of the sums the numbers of runs only.
  void countRuns(const Band& band, BandSums& sums) const {
    beginRows(band, sums);
    for (int y = band.first; y < band.last; ++y) {
      findRuns(y, sums);
      const uint16_t* ids = labels_.ids.row(y);
      const auto begins = runsOf(y, band, sums);
      for (size_t i = 0; i + 1 < begins.size(); ++i)
        if (const auto label = RegionLabel::ofNumber(ids[begins[i]]))
          ++sums.regions[label.index()].runs;
    }
  }

  /// Hands the runs out to the places that their regions have for them.
  void placeRuns(const Band& band, BandSums& sums, std::vector<Run>& list) const {
    for (int y = band.first; y < band.last; ++y) {
      const uint16_t* ids = labels_.ids.row(y);
      const auto begins = runsOf(y, band, sums);
      for (size_t i = 0; i + 1 < begins.size(); ++i)
        if (const auto label = RegionLabel::ofNumber(ids[begins[i]]))
          list[sums.regions[label.index()].runs++] = {static_cast<uint16_t>(y), begins[i],
                                                      begins[i + 1]};
    }
  }

 private:
  void beginRows(const Band& band, BandSums& sums) const {
    const auto rows = static_cast<size_t>(band.last - band.first);
    sums.begins.resize(rows * (static_cast<size_t>(labels_.size.width) + 1));
    sums.rows.assign(1, 0);
  }

  void findRuns(int y, BandSums& sums) const {
    uint16_t* begins = sums.begins.data() + sums.rows.back();
    const int runs = rg::simd::findRuns(labels_.ids.row(y), labels_.size.width, begins);
    sums.rows.push_back(sums.rows.back() + static_cast<size_t>(runs) + 1);
  }

  static std::span<const uint16_t> runsOf(int y, const Band& band, const BandSums& sums) {
    const auto row = static_cast<size_t>(y - band.first);
    return std::span(sums.begins).subspan(sums.rows[row], sums.rows[row + 1] - sums.rows[row]);
  }

  void addRuns(int y, std::span<const uint16_t> begins, BandSums& sums) const {
    const uint16_t* ids = labels_.ids.row(y);
    const size_t count = begins.size() - 1;
    const rg::simd::ChannelRows row = rowsOf(y);
    sums.channels.resize(count);
    rg::simd::sumRuns(row, begins.data(), static_cast<int>(count), sums.channels.data());
    for (size_t i = 0; i < count; ++i) {
      const int first = begins[i], last = begins[i + 1];
      const auto label = RegionLabel::ofNumber(ids[first]);
      if (!label) continue;
      addRun(y, first, last, sums.channels[i], sums.regions[label.index()]);
      if (i + 1 < count && ids[last] != segmentation::kNoRegion)
        sums.arcs.add(label, RegionLabel::ofNumber(ids[last]), 1,
                      contrast(row, last - 1, row, last));
    }
  }

  static void addRun(int y, int first, int last, const rg::simd::ChannelSums& channels,
                     RegionSums& sums) {
    const auto length = static_cast<uint64_t>(last - first);
    add(sums, {(static_cast<uint64_t>(first) + static_cast<uint64_t>(last - 1)) * length / 2,
               static_cast<uint64_t>(y) * length, channels.sums[0], channels.sums[1],
               channels.sums[2], static_cast<uint32_t>(length), first, last, y, y + 1, 1});
  }

  void addArcsAbove(int y, BandSums& sums) const {
    addArcs(y, 0, sums);
    if (connectivity_ == Connectivity::Four) return;
    addArcs(y, -1, sums);
    addArcs(y, 1, sums);
  }

  /// lean: by how much the pixel above is shifted against the lower one of a pair. Only where the
  /// labels differ is looked at pixel by pixel; pairs of the same two regions in a row make one.
  void addArcs(int y, int lean, BandSums& sums) const {
    constexpr int kWordBits = 64;
    const int first = std::max(-lean, 0);
    const int count = labels_.size.width - std::abs(lean);
    if (count <= 0) return;
    const uint16_t *ids = labels_.ids.row(y) + first, *idsAbove = labels_.ids.row(y - 1);
    idsAbove += first + lean;
    const rg::simd::ChannelRows row = rowsOf(y), above = rowsOf(y - 1);
    sums.alike.resize(static_cast<size_t>((count + kWordBits - 1) / kWordBits));
    rg::simd::compareLabels(ids, idsAbove, count, sums.alike.data());
    Arc arc;
    for (int start = 0; start < count; start += kWordBits) {
      uint64_t differing = ~sums.alike[static_cast<size_t>(start / kWordBits)];
      if (count - start < kWordBits) differing &= ~(~uint64_t{0} << (count - start));
      for (; differing != 0; differing &= differing - 1) {
        const int x = start + std::countr_zero(differing);
        if (ids[x] == segmentation::kNoRegion || idsAbove[x] == segmentation::kNoRegion) continue;
        if (ids[x] != arc.a.number() || idsAbove[x] != arc.b.number()) {
          if (arc.borderPx > 0) sums.arcs.add(arc.a, arc.b, arc.borderPx, arc.contrast);
          arc = {RegionLabel::ofNumber(ids[x]), RegionLabel::ofNumber(idsAbove[x]), 0, 0};
        }
        ++arc.borderPx;
        arc.contrast += contrast(row, first + x, above, first + x + lean);
      }
    }
    if (arc.borderPx > 0) sums.arcs.add(arc.a, arc.b, arc.borderPx, arc.contrast);
  }

  [[nodiscard]] rg::simd::ChannelRows rowsOf(int y) const {
    return {{planes_[0].row(y), planes_[1].row(y), planes_[2].row(y)}};
  }

  /// Of pixel p of a row and pixel q of another. The planes of a grey picture are one.
  static uint32_t contrast(const rg::simd::ChannelRows& a, int p, const rg::simd::ChannelRows& b,
                           int q) {
    const auto of = [&](int c) { return absDiff(a.rows[c][p], b.rows[c][q]); };
    return static_cast<uint32_t>(std::max({of(0), of(1), of(2)}));
  }

  const segmentation::Labels& labels_;
  const std::array<ImageView<const uint8_t>, 3> planes_;
  const Connectivity connectivity_;
};

}  // namespace

class Operations::Bands {
 public:
  explicit Bands(const Executor& executor)
      : executor_(executor),
        bands_(static_cast<size_t>(std::min(executor.threads(), kMostBands))) {}

  void build(const segmentation::Labels& labels, Connectivity connectivity, Graph& graph) {
    const GraphBuilder builder(labels, connectivity);
    forBands(labels, [&](const Band& band, BandSums& sums) { builder.addRows(band, sums); });
    placeRuns(builder, labels, graph.runs);
    for (size_t i = 1; i < bands_.size(); ++i)
      for (size_t r = 0; r < labels.count; ++r) add(bands_[0].regions[r], bands_[i].regions[r]);
    for (const RegionSums& sums : bands_[0].regions) graph.regions.push_back(describe(sums));
    for (const BandSums& sums : bands_) sums.arcs.appendTo(graph.arcs);
    sorter_.sortAndJoin(graph.arcs, labels.count);
  }

  void listRuns(const segmentation::Labels& labels, RegionRuns& runs) {
    const GraphBuilder builder(labels, Connectivity::Four);
    forBands(labels, [&](const Band& band, BandSums& sums) { builder.countRuns(band, sums); });
    placeRuns(builder, labels, runs);
  }

 private:
  /// Sums begin anew.
  template <class Task>
  void forBands(const segmentation::Labels& labels, const Task& task) {
    forEachBand(labels.size.height, [&](const Band& band, BandSums& sums) {
      sums.regions.assign(labels.count, {});
      sums.arcs.clear();
      task(band, sums);
    });
  }
  template <class Task>
  void forEachBand(int height, const Task& task) {
    const auto count = static_cast<int>(bands_.size());
    executor_.forEach(count, [&](int i) {
      task(Band{height * i / count, height * (i + 1) / count}, bands_[static_cast<size_t>(i)]);
    });
  }

  /// A band's runs of a region follow those of the bands above.
  void placeRuns(const GraphBuilder& builder, const segmentation::Labels& labels,
                 RegionRuns& runs) {
    runs.starts.resize(size_t{labels.count} + 1);
    uint32_t place = 0;
    for (size_t r = 0; r < labels.count; ++r) {
      runs.starts[r] = place;
      for (BandSums& band : bands_) place += std::exchange(band.regions[r].runs, place);
    }
    runs.starts[labels.count] = place;
    runs.list.resize(place);
    forEachBand(labels.size.height, [&](const Band& band, BandSums& sums) {
      builder.placeRuns(band, sums, runs.list);
    });
  }

  const Executor& executor_;
  std::vector<BandSums> bands_;
  ArcSorter sorter_;
};

Operations::Operations(const Executor& executor) : bands_(std::make_unique<Bands>(executor)) {}
Operations::~Operations() = default;

void Operations::build(const segmentation::Labels& labels, Connectivity connectivity,
                       Graph& graph) {
  bands_->build(labels, connectivity, graph);
}

void Operations::listRuns(const segmentation::Labels& labels, RegionRuns& runs) {
  bands_->listRuns(labels, runs);
}

}  // namespace rg::graph
