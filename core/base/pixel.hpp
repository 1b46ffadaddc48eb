// SPDX-License-Identifier: LGPL-2.1-or-later
// The integer arithmetic that every backend shares. Each rounding rule has one name here.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace rg {

[[nodiscard]] constexpr int absDiff(int a, int b) {
  return a > b ? a - b : b - a;
}

/// value / 2^shift, rounded to the nearest, halves upwards.
template <class T>
[[nodiscard]] constexpr T roundShift(T value, int shift) {
  return shift == 0 ? value : static_cast<T>((value + (T{1} << (shift - 1))) >> shift);
}
static_assert(roundShift(5, 1) == 3 && roundShift(-5, 1) == -2 && roundShift(7, 0) == 7);

/// numerator / denominator, rounded to the nearest, halves away from zero. denominator > 0.
[[nodiscard]] constexpr int64_t divideRounded(int64_t numerator, int64_t denominator) {
  return numerator >= 0 ? (numerator + denominator / 2) / denominator
                        : -((-numerator + denominator / 2) / denominator);
}
static_assert(divideRounded(5, 2) == 3 && divideRounded(-5, 2) == -3 && divideRounded(4, 3) == 1);

/// The largest integer whose square is not above `value`.
[[nodiscard]] constexpr uint32_t integerSqrt(uint64_t value) {
  uint64_t root = 0;
  if (!std::is_constant_evaluated()) {
    // Of a double it is at most one off: 53 bits hold a root of 32 and more.
    root = std::min<uint64_t>(static_cast<uint64_t>(std::sqrt(static_cast<double>(value))),
                              UINT32_MAX);
    if (root * root > value)
      --root;
    else if (root < UINT32_MAX && (root + 1) * (root + 1) <= value)
      ++root;
    return static_cast<uint32_t>(root);
  }
  for (uint64_t bit = uint64_t{1} << 31; bit != 0; bit >>= 1)
    if ((root + bit) * (root + bit) <= value) root += bit;
  return static_cast<uint32_t>(root);
}
static_assert(integerSqrt(15) == 3 && integerSqrt(16) == 4 && integerSqrt(~0ull) == 0xFFFFFFFF);

// What <bit> counts: of std's functions of 64 bits nvcc makes constants in the code of devices, and
// says nothing.

/// How many bits it takes to write the number; none for 0.
[[nodiscard]] constexpr int bitWidth(uint64_t number) {
  const auto upper = static_cast<uint32_t>(number >> 32);
  return static_cast<int>(upper != 0 ? 32 + std::bit_width(upper)
                                     : std::bit_width(static_cast<uint32_t>(number)));
}
static_assert(bitWidth(0) == 0 && bitWidth(1) == 1 && bitWidth(0xFFFFFFFF) == 32 &&
              bitWidth(uint64_t{1} << 32) == 33 && bitWidth(~uint64_t{0}) == 64);

/// The least power of two that is not less than the number, which must be at most 2^31.
[[nodiscard]] constexpr uint32_t bitCeil(uint32_t number) {
  return std::bit_ceil(number);
}

/// Counter-based mixing of a position and a time: the same number on every backend.
[[nodiscard]] constexpr uint32_t mixHash(uint32_t a, uint32_t b, uint32_t c) {
  uint32_t h = a * 0x9E3779B1u ^ std::rotl(b * 0x85EBCA77u, 13) ^ std::rotl(c * 0xC2B2AE3Du, 26);
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 12)) * 0x297A2D39u;
  return h ^ (h >> 15);
}

/// The same of one number, in 64 bits.
[[nodiscard]] constexpr uint64_t mixHash64(uint64_t value) {
  value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9u;
  value = (value ^ (value >> 27)) * 0x94D049BB133111EBu;
  return value ^ (value >> 31);
}

}  // namespace rg
