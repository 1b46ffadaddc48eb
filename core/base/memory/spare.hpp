// SPDX-License-Identifier: LGPL-2.1-or-later
// Vectors that are filled anew for each frame: they keep their memory, but not that of a frame long
// ago that needed far more.
#pragma once

#include <cstddef>
#include <vector>

namespace rg {

template <class T>
void giveBackSpare(std::vector<T>& values) {
  constexpr size_t kManyTimes = 4, kFew = 64;
  if (values.capacity() > kManyTimes * values.size() + kFew) values.shrink_to_fit();
}

template <class T>
void copyTight(const std::vector<T>& from, std::vector<T>& to) {
  to = from;
  giveBackSpare(to);
}

}  // namespace rg
