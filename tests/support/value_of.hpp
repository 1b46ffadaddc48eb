// SPDX-License-Identifier: LGPL-2.1-or-later
// For programs: a result's value, or the end.
#pragma once

#include "core/base/result.hpp"

#include <cstdlib>
#include <iostream>
#include <utility>

namespace rg {

/// Prints the error and exits with 1 where there is no value.
template <class T>
T valueOf(Result<T> result) {
  if (result) return *std::move(result);
  std::cerr << "error: " << result.error().message << '\n';
  std::exit(1);
}

}  // namespace rg
