// SPDX-License-Identifier: LGPL-2.1-or-later
// Which pixels of a region its motion is looked for with (part of stage 4).
//
// The band along a region's border is a mixture of what lies on both sides, and what is covered or
// uncovered lies in it: matched are pixels away from the border, in whole blocks of 4x1 pixels, as
// wide as a SAD instruction. A region that has few such blocks takes every block of which half is
// its own; one that is too thin for that, none. Of a large region those with texture are enough
// (core/motion/textured_cells.hpp).
// Each region that is matched costs a search however few its pixels are: of more regions than
// mostMatched() those with the most pixels are, of equal ones those with the smaller labels.
// Determinism: each block depends on its neighbourhood and on integer counts. Parts are sorted by
// label, then by row of parts, then by column.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/graph/graph.hpp"
#include "core/motion/fit_sums.hpp"
#include "core/motion/matched_part.hpp"
#include "core/motion/textured_cells.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace rg::motion {

/// A block is inner when its pixels and so many to the left, right, top and bottom of each, as far
/// as the frame goes, have one label.
inline constexpr int kBorderReach = 3;
/// Inner blocks are matched where their pixels are at least one in so many, and kLeastInnerPx.
inline constexpr uint32_t kInnerShare = 4;
inline constexpr uint32_t kLeastInnerPx = 16;

/// A bound on the time: as many as there would be of 256 pixels each, and in small frames 1024.
[[nodiscard]] constexpr size_t mostMatched(Size frame) {
  return static_cast<size_t>(std::max<int64_t>(1024, frame.area() / 256));
}

class MatchedBlocks {
 public:
  void find(const graph::Graph& graph, const Executor& executor);

  [[nodiscard]] std::span<const MatchedPart> parts() const { return parts_; }
  [[nodiscard]] std::span<const MatchedPart> partsOf(segmentation::RegionLabel label) const {
    const uint32_t region = label.index();
    return parts().subspan(starts_[region], starts_[region + 1] - starts_[region]);
  }
  [[nodiscard]] uint32_t pixelsOf(segmentation::RegionLabel label) const {
    return pixels_[label.index()];
  }
  /// Over the parts of a region that has some.
  [[nodiscard]] const GradientProducts& gradientsOf(segmentation::RegionLabel label) const {
    return gradients_[label.index()];
  }

 private:
  /// A task's regions, first … last − 1.
  struct Chunk {
    uint32_t first = 0, last = 0;
    std::vector<MatchedPart> parts;
    std::vector<uint32_t> places;  ///< Of the strip's part in each column of tiles.
    size_t stripFirst = 0;         ///< Where the parts of the region and strip begin.
    TextureScratch texture;
  };

  void findSteady(ImageView<const uint16_t> labels, const Executor& executor);
  void cutChunks(const graph::RegionRuns& runs);
  void collect(const graph::Graph& graph, Chunk& chunk);
  void addInner(const Run& run, segmentation::RegionLabel label, Chunk& chunk) const;
  void addHalves(const Run& run, segmentation::RegionLabel label, std::pair<int, int>& open,
                 Chunk& chunk) const;
  static void add(const Run& run, int column, uint64_t halves, segmentation::RegionLabel label,
                  Chunk& chunk);
  static void closeStrip(Chunk& chunk);
  static GradientProducts keepEnough(ImageView<const uint8_t> luma, Chunk& chunk, size_t begin);
  void dropSmallest();
  void joinChunks(size_t labelCount, const Executor& executor);

  Size size_;
  Image<uint64_t> same_;    ///< Bit x: of one label with the pixel above.
  Image<uint64_t> steady_;  ///< Bit 4 i: the columns of block i have one label kBorderReach rows
                            ///< up and down.
  std::vector<Chunk> chunks_;
  std::vector<uint32_t> starts_;  ///< By region: where its parts begin.
  std::vector<uint32_t> pixels_;  ///< Of each region, matched.
  std::vector<GradientProducts> gradients_;
  std::vector<uint64_t> ranks_;
  std::vector<MatchedPart> parts_;
};

}  // namespace rg::motion
