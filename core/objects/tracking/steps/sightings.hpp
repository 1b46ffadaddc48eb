// SPDX-License-Identifier: LGPL-2.1-or-later
// What a frame shows of each track.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

namespace rg::objects {

/// What each track owns of its fitted box.
void countCells(const GroupGrid& evidence, TrackerState& state);

/// Whether all of each track is seen, and whether it is alone in its crowd and stands.
void sight(const GroupGrid& evidence, TrackerState& state);

}  // namespace rg::objects
