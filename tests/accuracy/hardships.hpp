// SPDX-License-Identifier: LGPL-2.1-or-later
// What makes a panning scene harder: a camera that zooms and rolls, large things, and
// what stands nearer than the ground.
#pragma once

#include "tests/accuracy/plan.hpp"

#include <cstdint>

namespace rg::truth {

/// Speeds are the most per frame at 25 frames a second.
struct Hardships {
  double zoomPercent = 0;
  double rollDegrees = 0;
  double coverPercent = 0;     ///< Of the frame that things cover, on average.
  double parallaxPercent = 0;  ///< By how much faster than the ground what is nearer moves by.

  [[nodiscard]] bool isPlain() const {
    return zoomPercent == 0 && rollDegrees == 0 && coverPercent == 0 && parallaxPercent == 0;
  }
};

/// A plan as planPan() draws it, with hardships: the picture grows up to half as large again and
/// back, and turns up to 30° either way. To cover the frame, other actors take the place of those
/// of the plan, who pass in lanes and do not cover each other. Posts and hedges that are nearer
/// than the ground cover a few percent of the frame, half of them in the ground's own colours.
[[nodiscard]] Plan hardened(Plan plan, uint32_t seed, const Hardships& hardships);

}  // namespace rg::truth
