// SPDX-License-Identifier: LGPL-2.1-or-later
// Copies of results that hold what readers need in little memory, once no stage is left that works
// on them: without pictures and runs of regions, their planes packed.
#pragma once

#include "core/objects.hpp"
#include "core/pool.hpp"
#include "core/result_plane.hpp"

#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace rg {

/// Whether a stage can't work on the result any more.
[[nodiscard]] inline bool isPacked(const Foreground& foreground) {
  return foreground.mask.isPacked();
}
[[nodiscard]] inline bool isPacked(const Labels& labels) {
  return labels.ids.isPacked();
}
[[nodiscard]] inline bool isPacked(const Graph& graph) {
  return graph.labels && isPacked(*graph.labels);
}
[[nodiscard]] inline bool isPacked(const Motion& motion) {
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

  void fill(const Foreground& from, Foreground& to);
  void fill(const Labels& from, Labels& to);
  void fill(const Graph& from, Graph& to);
  void fill(const Motion& from, Motion& to);
  void fill(const Objects& from, Objects& to);

  PlanePacker planes_;
  std::tuple<Shelf<Foreground>, Shelf<Labels>, Shelf<Graph>, Shelf<Motion>, Shelf<Objects>>
      shelves_;
};

}  // namespace rg
