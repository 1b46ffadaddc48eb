// SPDX-License-Identifier: LGPL-2.1-or-later
// How large tracks are, and what the scene learns from that.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>

namespace rg::objects {

/// From a track that was seen whole. Where all things are of one size, half of what it learns is
/// what the scene says.
void learnSize(size_t index, int64_t stepNs, const GroupGrid& evidence, TrackerState& state);

/// Every half height of a track's way the scene learns from the crowd that the track is in,
/// whatever tracks say of sizes: a wrong scale must not confirm itself. Blobs of several things
/// side by side don't count; tracks above each other may be one thing that was taken apart. A row
/// of the picture says nothing of sizes where the camera moves.
void learnScale(const GroupGrid& evidence, TrackerState& state);

}  // namespace rg::objects
