// SPDX-License-Identifier: LGPL-2.1-or-later
// Where tracks are that share a blob or of which only a part is seen: by their portraits.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

class TrackPortraits {
 public:
  /// All are looked for; who is seen best stands in front and takes its place first, and whom that
  /// disturbs is looked for again in what it leaves.
  void place(const GroupGrid& evidence, int64_t stepNs, const Executor& executor,
             TrackerState& state);

 private:
  /// A track that is looked for.
  struct Task {
    size_t track = 0, fit = 0;  ///< Indices.
    PortraitSearch search;
    PortraitMatch match;
    Point corner;  ///< Where it was found, in pixels.
  };
  void list(const GroupGrid& evidence, TrackerState& state);
  [[nodiscard]] bool isDisturbed(size_t index, const GroupGrid& evidence,
                                 const TrackerState& state) const;
  void giveMatch(const PortraitScene& scene, Task& task, TrackerState& state);

  std::vector<Task> tasks_;
  std::vector<uint8_t> taken_;  ///< Of each cell.
  std::vector<uint8_t> isSearched_;
  std::vector<PortraitScratch> scratch_;  ///< Of each thread.
};

/// Which of what came out of a track that was found is seen in its place and looks as that part of
/// it did.
void findParts(size_t index, const GroupGrid& evidence, TrackerState& state);

/// Of a track that was seen whole.
void learnPortrait(size_t index, const GroupGrid& evidence, TrackerState& state);

}  // namespace rg::objects
