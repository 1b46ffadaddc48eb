// SPDX-License-Identifier: LGPL-2.1-or-later
// Rows of bits (core/base/bit_mask.hpp), from rows of bytes and counted, by the widest instructions
// there are.
//
// The same bits on every target. plain:: is the reference that the tests compare with.
#pragma once

#include <cstdint>

namespace rg {

namespace plain {
void packEqualRow(const uint8_t* bytes, int width, uint8_t value, uint64_t* words);
uint32_t countBits(const uint64_t* words, int count);
}  // namespace plain

namespace simd {
/// Bit x = (bytes[x] == value) for the columns of the row; the last word's other bits are 0.
void packEqualRow(const uint8_t* bytes, int width, uint8_t value, uint64_t* words);
/// How many bits of `count` words are set.
[[nodiscard]] uint32_t countBits(const uint64_t* words, int count);
}  // namespace simd

}  // namespace rg
