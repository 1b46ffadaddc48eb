// SPDX-License-Identifier: LGPL-2.1-or-later
// Grids on the host: each thread of a block is a fiber, blocks come one after the other.
//
// A fiber runs until it waits for others, so that a missing barrier lets it run too far; which of
// them goes first follows the schedule. One operating system thread only: what two blocks do to the
// same memory is seen where their order decides the result, not as a race.
#pragma once

#include "core/base/memory/executor.hpp"
#include "kernels/launch.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace rg::gpu::shim {

/// Which of the blocks, and of the threads that can go on, goes first.
enum class Order : uint8_t { Natural, Reversed, Random };

/// Record: kernels don't run, launches are listed.
enum class Mode : uint8_t { Run, Record };

struct Schedule {
  Order order = Order::Natural;
  uint32_t seed = 1;
  Mode mode = Mode::Run;
};

/// For all launches from then on; forgets findings and launches.
void begin(const Schedule& schedule);
/// What kernels did that they must not do, a line each. Only the first few are kept.
[[nodiscard]] const std::vector<std::string>& findings();
[[nodiscard]] const std::vector<Launch>& launches();

void run(const Launch& launch, Task<> thread);
void clear(void* memory, size_t bytes);
void report(const std::string& what);

/// Where a thread is between barriers. Two accesses are in order if they are one thread's, if a
/// barrier of the block lies between them, or one of the warp that both threads are in.
struct Moment {
  uint32_t block = 0;  ///< Counts blocks and their barriers, never 0 in a kernel.
  uint32_t warp = 0;   ///< Counts the warp's.
  uint32_t thread = 0;
};
[[nodiscard]] Moment now();
/// Counts the blocks: what is kept for a block is old when it has changed.
[[nodiscard]] uint32_t blockSerial();

void waitForBlock();
/// Waits for the warp, in which each lane gives a value; returns what all gave.
const std::array<uint64_t, 32>& waitForWarp(uint64_t value);

}  // namespace rg::gpu::shim

/// CUDA's names for where a thread is.
inline thread_local rg::gpu::Extent threadIdx, blockIdx, blockDim, gridDim;
