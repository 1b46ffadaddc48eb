// SPDX-License-Identifier: LGPL-2.1-or-later
// What changed from one frame to the next (paper, section 2.1). Per pixel only.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"

#include <cstdint>

namespace rg::background {

/// Largest absolute difference of a channel at each pixel. Both pictures have the same size.
void differ(const Picture& a, const Picture& b, const Executor& executor, Image<uint8_t>& out);

}  // namespace rg::background
