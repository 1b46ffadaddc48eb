// SPDX-License-Identifier: LGPL-2.1-or-later
// Counts what a program has asked of its heap and not given back.
#pragma once

#include <cstddef>

namespace rg::stress {

/// Bytes as they were asked for, by all threads. What the allocator itself says counts what it
/// keeps for each thread's next allocations as well, and what it left of a block that was hardly
/// larger: both change with the order of things that differ in size.
[[nodiscard]] size_t bytesInUse();

}  // namespace rg::stress
