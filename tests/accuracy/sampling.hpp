// SPDX-License-Identifier: LGPL-2.1-or-later
// How a camera samples a scene. Plans are drawn once, 480 px high at 25 frames a second: of a seed
// the same things happen at every rate and size.
#pragma once

#include "tests/accuracy/plan.hpp"

namespace rg::truth {

struct Sampling {
  Size size{640, 480};
  double fps = 25;
  double noise = 4;  ///< Grey levels, standard deviation.
};

/// The frame for which the plan of a sampling is to be drawn: of its shape.
[[nodiscard]] Size plannedFrame(Size size);

/// The plan in pixels and frames of the sampling. Things are drawn anew, not enlarged.
[[nodiscard]] Plan sampled(Plan plan, const Sampling& sampling);

}  // namespace rg::truth
