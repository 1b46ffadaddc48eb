// SPDX-License-Identifier: LGPL-2.1-or-later
// MOTChallenge CSV: frame,id,left,top,width,height,confidence,-1,-1,-1.
#pragma once

#include "core/objects/objects.hpp"
#include "core/text/line.hpp"

#include <string>

namespace rg::text {

/// Appends one line for each object of an isListed() state, in the order of their ids: whole
/// pixels, the frame's first pixel is (0, 0), confidence 1. Boxes may leave the frame, as those of
/// the benchmark's truth do.
void appendMot(std::string& out, const objects::Objects& objects, const FrameStamp& stamp);

}  // namespace rg::text
