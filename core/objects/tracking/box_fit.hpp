// SPDX-License-Identifier: LGPL-2.1-or-later
// Where several boxes of known size lie best to explain the foreground together: this is how one
// blob of several people is taken apart.
//
// Each box gains by foreground that no other box covers, more in its middle and where the colour is
// its own, loses by background inside, and by distance from where it was expected. Boxes take turns
// to find their best place, a few times round (coordinate ascent).
//
// Determinism: integers; turns in the order of the tasks, ties go to the shift that is shorter,
// then higher, then further left.
#pragma once

#include "core/objects/tracking/group_grid.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

struct FitTask {
  Box expected;    ///< In cells.
  int reachX = 0;  ///< Largest shift searched, in cells.
  int reachY = 0;
  int tier = 0;                     ///< Boxes of a lower tier choose first and don't yield.
  std::array<int16_t, 32> bonus{};  ///< By colour bin.
  uint16_t track = 0;               ///< As in GroupGrid::expected; 0 = none.
  Box fitted;                       ///< Result.

  /// Of the track that it looks for.
  [[nodiscard]] size_t trackIndex() const { return track - 1u; }
};

struct FitScratch {
  std::vector<uint16_t> claims;    ///< Of each cell: by how many fitted boxes it is covered.
  std::vector<int32_t> sums;       ///< Summed values of a search window.
  std::vector<uint8_t> isSettled;  ///< Of each task: no rival moved in its window since its turn.
};

/// tasks must be sorted by tier.
void fitBoxes(const GroupGrid& evidence, std::span<FitTask> tasks, FitScratch& scratch,
              const Numbers::Fit& numbers = {});

/// For each cell 1 + the task that owns it, 0 = none. Where boxes overlap the lower tier wins, then
/// the better colour, then the earlier task.
void assignCells(const GroupGrid& evidence, std::span<const FitTask> tasks,
                 std::vector<uint16_t>& owner, const Numbers::Fit& numbers = {});

}  // namespace rg::objects
