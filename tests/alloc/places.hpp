// SPDX-License-Identifier: LGPL-2.1-or-later
// Where allocations are made to fail: in the stages, and in the elements.
#pragma once

#include "tests/alloc/failing_new.hpp"

#include <functional>
#include <string>
#include <vector>

namespace rg::testing {

enum class Outcome {
  NotReached,  ///< All went well: there are not so many allocations.
  Graceful,    ///< It failed, and what followed was right.
  Wrong,       ///< What followed was not what it should have been.
};

/// A piece of work that is done once for each of its allocations.
struct Place {
  std::string name;
  std::function<Outcome(const Fault&)> attempt;
};

[[nodiscard]] std::vector<Place> stagePlaces();
/// Those of threads first: a process starts its threads only once.
[[nodiscard]] std::vector<Place> elementPlaces();

}  // namespace rg::testing
