// SPDX-License-Identifier: LGPL-2.1-or-later
// What the steps from regions to objects call one another's things.
#pragma once

#include "core/base/which.hpp"

#include <cstdint>

namespace rg::objects {

/// Which of the tracker's tracks.
using TrackIndex = Which<struct TrackKind, uint32_t>;
/// Which of the groups that regions were merged into.
using GroupIndex = Which<struct GroupKind, uint32_t>;
/// Which of Objects::objects. Planes hold its number.
using Slot = Which<struct ObjectKind, uint16_t>;

}  // namespace rg::objects
