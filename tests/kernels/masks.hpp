// SPDX-License-Identifier: LGPL-2.1-or-later
// Masks, and components in memory as a device has them.
#pragma once

#include "kernels/components.hpp"
#include "tests/kernels/parity.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rg::test {

/// Masks that are hard on components: full, empty, dots that touch by corners only, combs whose
/// teeth meet in the last row, spirals of one pixel, patches.
inline constexpr int kMasks = 8;
[[nodiscard]] inline BitMask maskOf(Size size, int kind) {
  BitMask mask(size);
  mask.clear();
  const auto isSet = [&](int x, int y) {
    const int ring = std::min(std::min(x, size.width - 1 - x), std::min(y, size.height - 1 - y));
    switch (kind) {
      case 0:
        return true;
      case 1:
        return false;
      case 2:
        return (x + y) % 2 == 0;
      case 3:
        return x % 2 == 0 || y == size.height - 1;
      case 4:
        return ring % 2 == 0 && !(x == ring && y == ring + 1);
      case 5:
        return hashOf(x, y, 1) % 2 == 0;
      case 6:
        return hashOf(x / 7, y / 3, 2) % 3 != 0;
      default:
        return hashOf(x, y, 3) % 40 == 0;
    }
  };
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (isSet(x, y)) mask.set(x, y);
  return mask;
}

template <class Check>
void forMasks(const Check& check) {
  for (const Size size : kSizes)
    for (int kind = 0; kind < kMasks && !::testing::Test::HasFailure(); ++kind) {
      SCOPED_TRACE(std::to_string(size.width) + "x" + std::to_string(size.height) + ", mask " +
                   std::to_string(kind));
      check(maskOf(size, kind));
    }
}

struct DeviceComponents {
  std::vector<ComponentRun> runs;
  std::vector<Component> list;
  std::vector<uint32_t> parents, numbers, firstRun, firstRoot, scratch;

  explicit DeviceComponents(Size size) {
    const auto most = static_cast<size_t>(gpu::mostRuns(size));
    const int words = gpu::wordsOf(size.width) * size.height;
    runs.resize(most);
    list.resize(most);
    for (std::vector<uint32_t>* numbersOfRuns : {&parents, &numbers})
      numbersOfRuns->assign(most, 0xA5A5A5A5);
    for (std::vector<uint32_t>* ofWords : {&firstRun, &firstRoot})
      ofWords->assign(static_cast<size_t>(words) + 1, 0xA5A5A5A5);
    scratch.assign(static_cast<size_t>(gpu::scanScratchOf(words)), 0xA5A5A5A5);
  }
  gpu::ComponentsView view() {
    return {runs.data(),     list.data(),      parents.data(), numbers.data(),
            firstRun.data(), firstRoot.data(), scratch.data()};
  }
};

}  // namespace rg::test
