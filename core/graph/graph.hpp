// SPDX-License-Identifier: LGPL-2.1-or-later
// Stage 3, element srg: the spatial region graph (paper, section 2.3 phase 1.2).
//
// Determinism: integer sums over pixels. Regions sorted by label, arcs by (a, b) with a < b.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/picture.hpp"
#include "core/base/pixel.hpp"
#include "core/base/result.hpp"
#include "core/base/stage.hpp"
#include "core/graph/region_runs.hpp"
#include "core/segmentation/segmentation.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace rg::graph {

/// Mean colour, full-range R'G'B'.
struct Colour {
  uint8_t red = 0;
  uint8_t green = 0;
  uint8_t blue = 0;
  friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// Of the channel that differs most, in grey levels.
[[nodiscard]] constexpr int difference(const Colour& a, const Colour& b) {
  return std::max({absDiff(a.red, b.red), absDiff(a.green, b.green), absDiff(a.blue, b.blue)});
}

/// A node: regions[i] is that of the label of index i.
struct Region {
  uint32_t areaPx = 0;
  Box box;
  int32_t centroidX = 0;  ///< Mean of the pixels' columns, in 1/256 px, rounded to the nearest.
  int32_t centroidY = 0;
  Colour colour;
};

/// Two regions that touch, a < b.
struct Arc {
  segmentation::RegionLabel a;
  segmentation::RegionLabel b;
  uint32_t borderPx = 0;  ///< Pairs of 4-neighbours across the border; with 8-connectivity also
                          ///< diagonal pairs.
  uint32_t contrast = 0;  ///< Sum over those pairs of the largest channel difference, grey levels.

  /// Of a pair, grey levels.
  [[nodiscard]] constexpr uint32_t meanContrast() const {
    return borderPx == 0 ? 0 : contrast / borderPx;
  }
};

/// What srg says of one frame. Immutable once published.
struct Graph {
  Size size;
  Status status = Status::Skipped;
  std::shared_ptr<const Picture> picture;  ///< That the regions are of.
  std::shared_ptr<const segmentation::Labels> labels;
  std::vector<Region> regions;
  std::vector<Arc> arcs;
  RegionRuns runs;  ///< Of the regions' pixels.

  void dropSources() {
    picture.reset();
    labels.reset();
  }
};

struct Params {
  Connectivity connectivity = Connectivity::Four;
};

class Stage {
 public:
  virtual ~Stage() = default;
  [[nodiscard]] virtual Result<std::shared_ptr<const Graph>> process(
      std::shared_ptr<const segmentation::Labels> labels, const Params& params) = 0;
  virtual void reset(Reset what) = 0;
};

[[nodiscard]] std::unique_ptr<Stage> makeStage(Context context);

}  // namespace rg::graph
