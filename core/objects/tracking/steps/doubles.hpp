// SPDX-License-Identifier: LGPL-2.1-or-later
// Tracks that turn out to be one body.
//
// Determinism: the younger one joins the oldest that it is one with.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>

namespace rg::objects {

/// Ends tracks that were one body with an older one for a while.
void joinDoubles(int64_t stepNs, TrackerState& state);

}  // namespace rg::objects
