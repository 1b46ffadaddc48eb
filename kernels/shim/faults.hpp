// SPDX-License-Identifier: LGPL-2.1-or-later
// Calls that fail on the host as they may on a device.
#pragma once

#include "core/base/memory/device.hpp"

#include <cstdint>
#include <optional>

namespace rg::gpu::shim {

struct Fault {
  uint64_t call = 0;  ///< Which of the calls from then on, 0 the next one.
  DeviceError::Kind kind = DeviceError::Kind::Failed;
  bool hangs = false;  ///< Instead: nothing comes to an end any more. Calls don't tell.
  uint64_t times = 1;  ///< So many calls, one after the other.
};

/// Forgets what has failed and counts calls anew.
void plan(std::optional<Fault> fault);
/// Launches, copies, allocations since then.
[[nodiscard]] uint64_t countCalls();
/// Allocations that have not been released.
[[nodiscard]] int64_t countAllocations();
/// The same of the host's memory for copies.
[[nodiscard]] int64_t countHostAllocations();
/// Graphs that have not been ended.
[[nodiscard]] int64_t countGraphs();

/// Every call passes here. Throws DeviceError if it is the one; after a lost device every one.
void call(const char* name);

}  // namespace rg::gpu::shim
