// SPDX-License-Identifier: LGPL-2.1-or-later
// The terms of the energy and the appearance, by the weight that leaves each of them out.
#pragma once

#include "core/objects/objects.hpp"

namespace rg::truth {

struct Term {
  const char* name;
  double objects::Params::*weight;
};

inline constexpr Term kTerms[] = {{"U1", &objects::Params::motionWeight},
                                  {"U2", &objects::Params::borderWeight},
                                  {"U3", &objects::Params::arcWeight},
                                  {"prediction", &objects::Params::predictionWeight},
                                  {"appearance", &objects::Params::appearanceWeight}};

}  // namespace rg::truth
