// SPDX-License-Identifier: LGPL-2.1-or-later
// What a piece of work costs, as feedback for the fuzzer: an input that makes something dearer than
// any before is worth keeping, as one is that reaches new code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>

namespace rg::fuzz {

/// Notes a cost, in the processor's nanoseconds, for so many units of work (pixels, say). With
/// $RG_NO_COSTS the fuzzer is not told, and does the same in each run with one seed.
void noteCost(int64_t ns, int64_t units);

/// The dearest of the costs that were noted since the last call, in picoseconds a unit.
[[nodiscard]] int64_t takeDearest();

/// Keeps an input in the folder that $RG_SLOW_DIR names, if there is one, where it is among the 100
/// dearest there by takeDearest(). They are named by their costs.
void keepIfDear(const uint8_t* data, size_t size);

/// That of the input that keepIfDear() looked at last.
[[nodiscard]] int64_t lastCost();

/// The processor's time of this thread.
[[nodiscard]] inline int64_t cpuNs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

template <class Work>
auto measured(int64_t units, const Work& work) {
  const int64_t start = cpuNs();
  auto result = work();
  noteCost(cpuNs() - start, units);
  return result;
}

}  // namespace rg::fuzz
