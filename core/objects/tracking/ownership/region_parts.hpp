// SPDX-License-Identifier: LGPL-2.1-or-later
// The frame's regions, cut where tracks are expected to end: the nodes that tracks compete for
// (core/objects/tracking/ownership/track_terminals.hpp).
//
// Determinism: parts and contacts count in raster order of their first cells.
#pragma once

#include "core/objects/tracking/group_grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// A 4-connected set of cells of one region that the same track claims and the same one gave up.
struct RegionPart {
  uint16_t region = 0;      ///< As in GroupGrid::region.
  uint16_t expected = 0;    ///< 1 + the track that the region is predicted to be, 0 = none.
  uint16_t claim = 0;       ///< 1 + the track, 0 = none.
  uint16_t partedFrom = 0;  ///< 1 + the track that gave it up, 0 = none.
  uint32_t cells = 0;
};

/// Two parts that touch, a < b.
struct PartContact {
  uint32_t a = 0, b = 0;
  uint32_t border = 0;  ///< Pairs of cells that touch across it.
};

class RegionParts {
 public:
  struct PartRun {
    Run cells;
    uint32_t part = 0;
  };

  /// claims, partedFrom: of each cell of the evidence.
  void find(const GroupGrid& evidence, std::span<const uint16_t> claims,
            std::span<const uint16_t> partedFrom);
  [[nodiscard]] const std::vector<RegionPart>& list() const { return parts_; }
  /// Of all parts, in raster order.
  [[nodiscard]] const std::vector<PartRun>& runs() const { return runs_; }
  /// Sorted by (a, b).
  [[nodiscard]] const std::vector<PartContact>& contacts() const { return contacts_; }
  /// Of a cell that is foreground.
  [[nodiscard]] uint32_t at(size_t cell) const { return partAt_[cell]; }

 private:
  void listRuns(const GroupGrid& evidence, std::span<const uint16_t> claims,
                std::span<const uint16_t> partedFrom);
  void touchRows();
  void touch(uint32_t run, uint32_t other, int cells);
  void number(const GroupGrid& evidence);
  void sumContacts();

  std::vector<RegionPart> parts_;
  std::vector<PartRun> runs_;
  std::vector<RegionPart> ofRun_;  ///< The part that a run is of, as far as its cells say.
  std::vector<PartContact> contacts_;
  std::vector<uint32_t> parent_;  ///< Of runs that are of one part.
  std::vector<uint32_t> partAt_;
};

}  // namespace rg::objects
