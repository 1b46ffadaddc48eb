// SPDX-License-Identifier: LGPL-2.1-or-later
// Where tracks are, and how fast: as they are expected to be, and as they are seen.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>

namespace rg::objects {

/// A track goes on as it did, and grows as things do that come nearer in this scene.
void advance(int64_t stepNs, const TrackerState& state, Track& track);

/// Moves a track to where it was seen.
void correct(size_t index, int64_t stepNs, TrackerState& state);

}  // namespace rg::objects
