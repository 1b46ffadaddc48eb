// SPDX-License-Identifier: LGPL-2.1-or-later
// Copies of results that hold what readers need in little memory, once no stage is left that works
// on them: without pictures and runs of regions, their planes packed.
#pragma once

#include "core/base/mapping.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/memory/result_plane.hpp"
#include "core/objects/object.hpp"

#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace rg::objects {

/// Whether a stage can't work on the result any more.
[[nodiscard]] inline bool isPacked(const background::Foreground& foreground) {
  return foreground.mask.isPacked();
}
[[nodiscard]] inline bool isPacked(const segmentation::Labels& labels) {
  return labels.ids.isPacked();
}
[[nodiscard]] inline bool isPacked(const graph::Graph& graph) {
  return graph.labels && isPacked(*graph.labels);
}
[[nodiscard]] inline bool isPacked(const motion::Motion& motion) {
  return motion.graph && isPacked(*motion.graph);
}
[[nodiscard]] inline bool isPacked(const Objects& objects) {
  return objects.slots.isPacked();
}

class ResultPacker {
 public:
  /// A packed copy, and of all that it was made from; the same one for the same result until
  /// endFrame(). What is packed already stays as it is. Throws std::bad_alloc.
  template <class Payload>
  [[nodiscard]] std::shared_ptr<const Payload> pack(const std::shared_ptr<const Payload>& result) {
    if (!result || isPacked(*result)) return result;
    auto& made = shelfOf<Payload>().made;
    for (const auto& [from, copy] : made)
      if (from == result) return copy;
    const auto copy = shelfOf<Payload>().pool.take();
    fill(*result, *copy);
    made.emplace_back(result, copy);
    return copy;
  }
  void endFrame();
  /// The size of the frames that results are told of: what was found in a smaller picture is packed
  /// as if found in the frame. Lengths of borders, their contrast and sums of differences remain.
  void showIn(Size frame) { shown_ = frame; }
  /// Forgets sizes that were.
  void drop();

 private:
  template <class Payload>
  struct Shelf {
    using Result = std::shared_ptr<const Payload>;
    Pool<Payload> pool;
    std::vector<std::pair<Result, Result>> made;  ///< In this frame, from what.

    void drop() {
      made.clear();
      pool.drop();
    }
  };
  template <class Payload>
  [[nodiscard]] Shelf<Payload>& shelfOf() {
    return std::get<Shelf<Payload>>(shelves_);
  }

  void fill(const background::Foreground& from, background::Foreground& to);
  void fill(const segmentation::Labels& from, segmentation::Labels& to);
  void fill(const graph::Graph& from, graph::Graph& to);
  void fill(const motion::Motion& from, motion::Motion& to);
  void fill(const Objects& from, Objects& to);

  [[nodiscard]] FrameMap mapOf(Size size) const {
    return size.isEmpty() || shown_.isEmpty() ? FrameMap{size, size} : FrameMap{size, shown_};
  }

  PlanePacker planes_;
  Size shown_;  ///< Empty: that of each result.
  std::tuple<Shelf<background::Foreground>, Shelf<segmentation::Labels>, Shelf<graph::Graph>,
             Shelf<motion::Motion>, Shelf<Objects>>
      shelves_;
};

}  // namespace rg::objects
