// SPDX-License-Identifier: LGPL-2.1-or-later
// One region against the previous frame, with the camera's motion alone and with a shift beyond it
// (part of core/objects/merge/own_motion.hpp, which tells what is left out and why).
#pragma once

#include "core/objects/merge/own_motion.hpp"

#include <cstddef>

namespace rg::objects {

/// Fills in the sums of the region's trial, which has a shift; reads s.expected, s.shown and, where
/// s.hidesAny, s.hidden. Regions may be compared at the same time. Cost: follows the region's
/// pixels, and its runs.
void compareRegion(const motion::Motion& motion, size_t region, OwnMotionScratch& s);

}  // namespace rg::objects
