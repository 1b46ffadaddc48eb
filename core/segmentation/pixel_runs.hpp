// SPDX-License-Identifier: LGPL-2.1-or-later
// Linked pixels, or cells, as horizontal runs, the runs' components and the borders between these
// (part of stage 2).
//
// Components larger than a limit are cut along a fixed grid of tiles: one motion does not describe
// half a frame, and a grid stands still where iso-lines of a shading would wander.
// Determinism: a component is a transitive closure; components are numbered from 0 in the raster
// order of their first pixels. Borders are sums, in an order that the rows give.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/row_spans.hpp"
#include "core/base/run.hpp"
#include "core/segmentation/border_list.hpp"
#include "core/segmentation/colour_links.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::segmentation {

struct RunLimits {
  uint32_t maxAreaPx = ~uint32_t{0};  ///< Larger components are cut.
  int tilePx = 64;                    ///< Side of the tiles that they are cut into.
};

class PixelRuns {
 public:
  void build(const ColourLinks& links, const RunLimits& limits, const Executor& executor);
  /// The parts of equal labels; label 0 has none. Scope: as of the pixels.
  void build(ImageView<const uint16_t> labels, ImageView<const uint8_t> scope,
             const Executor& executor);

  [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(runs_.size()); }
  [[nodiscard]] uint32_t componentCount() const { return componentCount_; }
  /// Index of the first run of row y; y = height gives count().
  [[nodiscard]] uint32_t rowStart(int y) const { return rowStarts_[static_cast<size_t>(y)]; }
  [[nodiscard]] const Span& run(uint32_t i) const { return runs_[i]; }
  [[nodiscard]] uint32_t component(uint32_t run) const { return components_[parents_[run]]; }

  /// Bands of rows that tasks share out: no run of one belongs to the part of another.
  [[nodiscard]] int bandCount() const { return static_cast<int>(bands_.size()); }
  [[nodiscard]] Span bandRows(int band) const {
    return {band * limits_.tilePx, std::min((band + 1) * limits_.tilePx, size_.height)};
  }
  /// What is linked within a band and a tile is a part, named by its first run: those of a band, in
  /// their order.
  [[nodiscard]] const std::vector<uint32_t>& parts(int band) const {
    return bands_[static_cast<size_t>(band)].parts;
  }
  [[nodiscard]] uint32_t part(uint32_t run) const { return parents_[run]; }
  /// Pixels or cells of a part.
  [[nodiscard]] uint32_t partArea(uint32_t part) const { return areas_[part]; }
  /// At least as many as forBorders() visits.
  [[nodiscard]] size_t mostBorders() const {
    size_t most = 0;
    for (const Band& band : bands_)
      most += band.inner.borders().size() + band.seam.borders().size();
    return most;
  }
  /// Calls visit(component, component, pairs of 4-neighbours) for the borders between components;
  /// one may come several times. None where the scope changes.
  template <class Visit>
  void forBorders(Visit&& visit) const {
    for (const Band& band : bands_)
      for (const BorderList* list : {&band.inner, &band.seam})
        for (const AbsorbedBorder& border : list->borders())
          if (components_[border.a] != components_[border.b])
            visit(components_[border.a], components_[border.b], border.borderPx);
  }

 private:
  /// Runs of two rows that have columns in common.
  struct Overlap {
    uint32_t upper = 0, lower = 0;
    uint32_t columns = 0;
  };
  /// Grows only, so that it is written without a look at its end.
  struct Overlaps {
    std::vector<Overlap> list;
    size_t count = 0;

    void makeRoomFor(size_t most) {
      count = 0;
      if (list.size() < most) list.resize(most);
    }
    [[nodiscard]] std::span<const Overlap> all() const { return {list.data(), count}; }
  };
  /// Of one thread.
  struct Scratch {
    Overlaps linked, touching;  ///< Of a row, of a band.
  };
  struct Band {
    std::vector<uint32_t> parts;
    std::vector<uint32_t> cuts;  ///< Runs linked to the one to their left.
    BorderList inner, seam;      ///< Of parts, within the band and to the one above.
  };

  void prepare(Size size, const RunLimits& limits);
  void countRuns(int y);
  void findComponents(const Executor& executor);
  void findParts(int band, Scratch& scratch);
  void findRuns(int y, std::vector<uint32_t>& cuts);
  void collectOverlaps(int y, Scratch& scratch) const;
  void collectSides(int y, BorderList& borders) const;
  void joinSeam(const Scratch& scratch, BorderList& seam);
  void joinBands();
  void numberComponents();

  RunLimits limits_;
  Size size_;
  ImageView<const uint16_t> labels_;  ///< What links the rows; none: `upLinks_`.
  ImageView<const uint8_t> scopePlane_;
  std::vector<uint16_t> noLabels_;               ///< As wide as a row.
  std::vector<uint64_t> tileStarts_;             ///< Bits of the columns where tiles begin.
  Image<uint64_t> scope_, leftLinks_, upLinks_;  ///< A bit a pixel.
  std::vector<uint32_t> rowStarts_;
  std::vector<Span> runs_;
  std::vector<uint32_t> parents_;  ///< Of each run the first one of its part.
  std::vector<Band> bands_;
  std::vector<Scratch> scratch_;
  /// By part: its area, the forest across the tiles, areas of that one's roots, the component.
  std::vector<uint32_t> areas_, whole_, wholeAreas_, components_;
  uint32_t componentCount_ = 0;
};

}  // namespace rg::segmentation
