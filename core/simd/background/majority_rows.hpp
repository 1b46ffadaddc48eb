// SPDX-License-Identifier: LGPL-2.1-or-later
// The hot loops of keepMajority (core/background/mask_cleaning.hpp) over one row, 64 columns a word
// and as many words at once as there is room for.
//
// The same bits on every target. plain:: is the reference that the tests compare with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace rg::background {

/// A row of counts in binary, one digit after the other: digit i of column x is bit x % 64 of word
/// i · words + x / 64. `words` is a multiple of 8 everywhere here.
inline constexpr size_t kCountDigits = 4;  ///< At most 15 pixels along a row,
inline constexpr size_t kSumDigits = 8;    ///< 225 in a square.

namespace plain {
void countAlongRow(const uint64_t* row, size_t words, int radius, uint64_t* counts);
void compareSums(std::span<const uint64_t* const> counts, size_t words, int limit, uint64_t* out);
}  // namespace plain

namespace simd {
/// How many of the columns x − radius … x + radius are set. row[−1] and row[words] are read too.
/// radius 1 … 7.
void countAlongRow(const uint64_t* row, size_t words, int radius, uint64_t* counts);
/// Sets the columns whose counts of all rows together are above the limit. At most 15 rows.
void compareSums(std::span<const uint64_t* const> counts, size_t words, int limit, uint64_t* out);
}  // namespace simd

}  // namespace rg::background
