// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/blobs.hpp"

#include <algorithm>
#include <utility>

namespace rg::objects {

void Blobs::find(const GroupGrid& e, bool areParted, bool areCut) {
  findPieces(e, {}, areParted, scratch_, blobs_);
  if (areCut) cutPieces(e, scratch_, blobs_);
}

void Blobs::findOwners(const GroupGrid& e, std::span<const FitTask> tasks,
                       std::span<const uint16_t> owner, size_t tracks) {
  blobOf_.assign(tracks, 0);
  soleTrack_.assign(blobs_.size() + 1, 0);
  cells_.assign(blobs_.size() + 1, 0);
  constexpr uint16_t kSeveral = UINT16_MAX;
  for (const FitTask& task : tasks) {
    const size_t track = task.trackIndex();
    uint32_t& best = blobOf_[track];
    const Box box = intersect(task.fitted, boundsOf(e.grid));
    uint32_t most = 0;
    seen_.clear();
    for (int y = box.y; y < box.bottom(); ++y)
      for (size_t cell = e.at(box.x, y), end = cell + static_cast<size_t>(box.width); cell < end;
           ++cell)
        if (owner[cell] == track + 1 && cells_[at(cell)]++ == 0) seen_.push_back(at(cell));
    for (const uint32_t blob : seen_) {
      if (cells_[blob] > most || (cells_[blob] == most && blob < best)) {
        most = cells_[blob];
        best = blob;
      }
      cells_[blob] = 0;
    }
    if (best == 0) continue;
    uint16_t& sole = soleTrack_[best];
    sole = sole == 0 ? static_cast<uint16_t>(track + 1) : kSeveral;
  }
  for (uint16_t& sole : soleTrack_)
    if (sole == kSeveral) sole = 0;
}

void Blobs::exchange(size_t a, size_t b) {
  const bool isAloneA = isAlone(a), isAloneB = isAlone(b);
  std::swap(blobOf_[a], blobOf_[b]);
  if (isAloneA) soleTrack_[blobOf_[b]] = static_cast<uint16_t>(b + 1);
  if (isAloneB) soleTrack_[blobOf_[a]] = static_cast<uint16_t>(a + 1);
}

bool Blobs::isOwned(uint32_t number) const {
  return std::count(blobOf_.begin(), blobOf_.end(), number) != 0;
}

}  // namespace rg::objects
