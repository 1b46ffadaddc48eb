// SPDX-License-Identifier: LGPL-2.1-or-later
// Connected parts of the foreground that the tracker sees (core/objects/tracking/group_grid.hpp).
//
// Cost: follows the runs of cells, not the cells. Determinism: pieces count in raster order.
#pragma once

#include "core/objects/tracking/group_grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// An 8-connected set of cells.
struct Piece {
  uint32_t cells = 0;
  Box box;             ///< In cells.
  uint16_t group = 0;  ///< As in GroupGrid; one of its groups where they are not parted.
};

struct PieceScratch {
  Size grid;                                            ///< That `label` is of.
  std::vector<uint32_t> label;                          ///< Of each cell: 1 + piece, 0 = none.
  std::vector<Run> runs;                                ///< That have labels.
  std::vector<uint32_t> parent;                         ///< Of each run.
  std::vector<uint32_t> firstColumn, columns, highest;  ///< Of cutPieces().
  std::vector<Piece> cut;
};

/// The parts of the foreground whose owner is 0. owner: for each cell 1 + track or 0; empty: nobody
/// owns anything. areParted: what the energy's minimum parts is of different pieces.
void findPieces(const GroupGrid& evidence, std::span<const uint16_t> owner, bool areParted,
                PieceScratch& scratch, std::vector<Piece>& pieces);

/// Cuts pieces apart, from top to bottom, where two things seem to touch: where a column holds much
/// less than some on either side. Without a joint a piece keeps its number; parts to the right get
/// numbers after all pieces.
void cutPieces(const GroupGrid& evidence, PieceScratch& scratch, std::vector<Piece>& pieces);

}  // namespace rg::objects
