// SPDX-License-Identifier: LGPL-2.1-or-later
// The foreground that no track explains: noise, a part of a track, a new object, or one that was
// lost.
//
// Determinism: larger pieces first, then those with the smaller number.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

/// One that may be something.
struct Newcomer {
  Box box;              ///< In pixels.
  uint16_t group = 0;   ///< Of its largest piece.
  uint32_t cells = 0;   ///< 0: it was nothing, or went to a track.
  uint64_t parent = 0;  ///< Id of the track whose blob it comes out of, 0 = none.
  bool isAtBorder = false;
  LookCounts look;
  Look appearance;
};

class Newcomers {
 public:
  /// minAreaPx: of an object; 0 = learnt from the scene.
  void find(const GroupGrid& evidence, uint32_t minAreaPx, TrackerState& state);
  [[nodiscard]] const std::vector<Newcomer>& list() const { return list_; }
  /// Of each newcomer the track that it is, −1 = none, as giveCells() needs it.
  [[nodiscard]] std::vector<int>& tracks() { return trackOf_; }
  /// Cells of the newcomers that have found a track go to it.
  void giveCells(const GroupGrid& evidence, TrackerState& state) const;

 private:
  void describe(const GroupGrid& evidence, const TrackerState& state);
  void giveFragments(const GroupGrid& evidence, TrackerState& state);
  void dropSmall(const GroupGrid& evidence, uint32_t minAreaPx, const TrackerState& state);

  std::vector<Newcomer> list_;
  std::vector<int> trackOf_;
  std::vector<int> ofPiece_;  ///< Of each piece its newcomer, −1 = none.
  std::vector<Piece> pieces_;
  PieceScratch pieceScratch_;
  std::vector<size_t> order_;
  std::vector<uint32_t> touching_;  ///< Of each newcomer and track, how many cells touch.
};

}  // namespace rg::objects
