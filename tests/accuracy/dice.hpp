// SPDX-License-Identifier: LGPL-2.1-or-later
// Numbers that follow from a seed: the same on every machine.
#pragma once

#include "core/base/pixel.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace rg::truth {

class Dice {
 public:
  Dice(uint32_t seed, uint32_t purpose) : seed_(seed), purpose_(purpose) {}

  uint32_t bits() { return mixHash(seed_, count_++, purpose_); }
  /// least … most, both included.
  int whole(int least, int most) {
    return least + static_cast<int>(bits() % static_cast<uint32_t>(most - least + 1));
  }
  double real(double least, double most) { return least + (most - least) * bits() / 4294967296.0; }
  bool flip() { return (bits() & 1) != 0; }
  template <class T>
  void shuffle(std::vector<T>& values) {
    for (size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[bits() % i]);
  }

 private:
  uint32_t seed_, purpose_, count_ = 0;
};

}  // namespace rg::truth
