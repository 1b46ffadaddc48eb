// SPDX-License-Identifier: LGPL-2.1-or-later
// Which darkened parts of the foreground are cast shadows, judged by what lies around them: clothes
// that happen to look like a darkened background lie inside an object, shadows lie beside it.
//
// Determinism: integers; sums over components (core/base/components.hpp).
#pragma once

#include "core/base/bit_mask.hpp"
#include "core/base/components.hpp"

#include <cstdint>
#include <vector>

namespace rg::background {

/// What is known of one darkened part.
struct DarkPart {
  uint32_t columns = 0;          ///< Vertical runs of its pixels.
  uint32_t enclosedColumns = 0;  ///< Of these, with solid foreground above and below.
  uint32_t solidContacts = 0;    ///< Pixel sides shared with solid foreground.
  uint32_t freeContacts = 0;     ///< Pixel sides shared with background.
};

/// A part that hangs on solid foreground, is open to the background and is not sandwiched.
[[nodiscard]] constexpr bool isCast(const DarkPart& part) {
  return part.solidContacts > 0 && 3 * part.freeContacts >= part.solidContacts &&
         2 * part.enclosedColumns <= part.columns;
}

/// An object of which more than three quarters is dark has no shadow.
[[nodiscard]] constexpr bool isMostlyDark(uint32_t darkPx, uint32_t areaPx) {
  return uint64_t{darkPx} * 256 > uint64_t{areaPx} * 192;
}

struct CastShadowScratch {
  Components darkParts, objects;
  std::vector<DarkPart> dark;
  std::vector<uint32_t> darkOf;  ///< Darkened pixels of each object.
  std::vector<uint8_t> isChosen;
};

/// Clears in `dark`, a subset of `mask`, what is no cast shadow.
void keepCastShadows(const BitMask& mask, BitMask& dark, CastShadowScratch& scratch);

}  // namespace rg::background
