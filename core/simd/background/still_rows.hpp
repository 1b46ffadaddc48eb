// SPDX-License-Identifier: LGPL-2.1-or-later
// The hot loop of core/background/ghosts/ghosts.hpp over the columns of one word, by the
// widest instructions there are.
//
// The same bits on every target. plain:: is the reference that the tests compare with.
#pragma once

#include "core/simd/background/consensus_rows.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace rg::background {

/// 64 columns: their colours now, the colours that they keep, and how long (ghosts.hpp: AgeScale).
struct StillWord {
  std::array<const uint8_t*, 3> pixels;
  std::array<uint8_t*, 3> kept;
  uint16_t* ages;
  uint16_t mostAge;     ///< Ages don't grow beyond; they may be beyond.
  int channels;         ///< 1 or 3.
  uint64_t foreground;  ///< A bit a column.
};

/// The age of a foreground pixel of some age in the next frame; 0: it has none yet.
[[nodiscard]] constexpr int nextAge(int age, bool isSame, int mostAge) {
  if (age == 0 || !isSame) return age - std::min(age, 1 + age / 4);
  return std::max(age, std::min(age + 1, mostAge));
}

namespace plain {
/// Ages foreground columns whose colour is within the radius of the one that they keep, makes the
/// others younger; those of age 0 keep their present colour from now on. Columns of the background
/// have age 0.
void followStillWord(const StillWord& word, const RadiusRow& radius);
/// Which of a word's 64 columns are at least of that age.
[[nodiscard]] uint64_t agedColumns(const uint16_t* ages, uint16_t least);
}  // namespace plain

namespace simd {
void followStillWord(const StillWord& word, const RadiusRow& radius);
[[nodiscard]] uint64_t agedColumns(const uint16_t* ages, uint16_t least);
}  // namespace simd

}  // namespace rg::background
