// SPDX-License-Identifier: LGPL-2.1-or-later
// Rows for the functions of core/simd: odd widths, padded strides, guard bytes, fills that provoke
// overflows.
#pragma once

#include "core/base/memory/image.hpp"
#include "core/base/pixel.hpp"
#include "tests/core/simd_targets.hpp"

#include <functional>
#include <string>
#include <vector>

namespace rg::test {

inline constexpr uint8_t kGuard = 0xA5;
inline constexpr int kMostColumns = 257;

using Fill = std::function<uint8_t(int x, int row)>;

/// What goes wrong in bytes goes wrong at the ends of their range and at steps between these.
inline std::vector<Fill> fills() {
  const auto noise = [](uint32_t mask) {
    return [mask](int x, int row) {
      return static_cast<uint8_t>(
          mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(row), mask) & mask);
    };
  };
  return {[](int, int) { return uint8_t{0}; },
          [](int, int) { return uint8_t{255}; },
          [](int x, int row) { return static_cast<uint8_t>((x + row) % 2 == 0 ? 0 : 255); },
          [](int x, int row) { return static_cast<uint8_t>(x % 3 == 0 ? 254 : row % 2); },
          [](int x, int row) { return static_cast<uint8_t>(120 + (x * 7 + row * 5) % 24); },
          noise(255),
          noise(15)};
}

/// Rows of bytes with guards behind what the functions may touch: whole words of columns.
inline Image<uint8_t> filled(int rows, const Fill& fill) {
  Image<uint8_t> image({kMostColumns + 100, rows});
  image.fill(kGuard);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < kMostColumns; ++x) image.at(x, y) = fill(x, y);
  return image;
}

inline int padded(int width) {
  return (width + 63) / 64 * 64;
}

inline void expectSame(const Image<uint8_t>& a, const Image<uint8_t>& b, int width) {
  for (int x = 0; x < width; ++x) ASSERT_EQ(int{a.at(x, 0)}, int{b.at(x, 0)}) << "column " << x;
}

inline void expectGuarded(const Image<uint8_t>& a, const Image<uint8_t>& before, int from) {
  for (int x = from; x < a.width(); ++x) ASSERT_EQ(int{a.at(x, 0)}, int{before.at(x, 0)}) << x;
}

template <class Check>
void forAll(const Check& check) {
  forEachTarget([&] {
    int index = 0;
    for (const Fill& fill : fills()) {
      SCOPED_TRACE("fill " + std::to_string(index++));
      for (int width = 1; width <= kMostColumns && !::testing::Test::HasFailure(); ++width) {
        SCOPED_TRACE("width " + std::to_string(width));
        check(fill, width);
      }
    }
  });
}

}  // namespace rg::test
