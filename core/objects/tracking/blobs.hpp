// SPDX-License-Identifier: LGPL-2.1-or-later
// The connected parts of all the foreground, and whose they are.
//
// Determinism: counts of cells; the blob with the smaller number wins ties.
#pragma once

#include "core/objects/tracking/box_fit.hpp"
#include "core/objects/tracking/pieces.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

class Blobs {
 public:
  /// `areParted`: each is of one group; `areCut`: where two things seem to touch
  /// (core/objects/tracking/pieces.hpp).
  void find(const GroupGrid& evidence, bool areParted, bool areCut);
  /// Of `tracks` tracks: the blob of each is the one in which it has most cells of its fitted box.
  void findOwners(const GroupGrid& evidence, std::span<const FitTask> tasks,
                  std::span<const uint16_t> owner, size_t tracks);

  /// 1 + the blob of a cell, 0 = none.
  [[nodiscard]] uint32_t at(size_t cell) const { return scratch_.label[cell]; }
  [[nodiscard]] const Piece& piece(uint32_t number) const { return blobs_[number - 1]; }
  /// 1 + the blob of a track, 0 = none.
  [[nodiscard]] uint32_t numberOf(size_t track) const { return blobOf_[track]; }
  [[nodiscard]] bool has(size_t track) const { return blobOf_[track] != 0; }
  [[nodiscard]] const Piece& of(size_t track) const { return piece(blobOf_[track]); }
  [[nodiscard]] bool areTogether(size_t a, size_t b) const { return blobOf_[a] == blobOf_[b]; }
  /// 1 + the only track in a blob, 0 = none or several.
  [[nodiscard]] uint16_t soleTrack(uint32_t number) const { return soleTrack_[number]; }
  /// Whether a track has a blob for itself.
  [[nodiscard]] bool isAlone(size_t track) const {
    return has(track) && soleTrack_[blobOf_[track]] == track + 1;
  }
  [[nodiscard]] bool isOwned(uint32_t number) const;
  void exchange(size_t a, size_t b);

 private:
  std::vector<Piece> blobs_;
  PieceScratch scratch_;
  std::vector<uint32_t> blobOf_;     ///< Of each track: 1 + blob, 0 = none.
  std::vector<uint16_t> soleTrack_;  ///< Of each blob, from 1.
  std::vector<uint32_t> cells_, seen_;
};

}  // namespace rg::objects
