// SPDX-License-Identifier: LGPL-2.1-or-later
// Preloaded by valgrind.sh. Highway 1.0 measures the timer's resolution while it is loaded, by
// RDTSCP, whether the processor has it or not: where the host doesn't tell of it, valgrind ends
// every program that loads Highway. Nothing here asks for what it measures.
#include <cstdint>

namespace hwy::platform {

[[gnu::visibility("default")]] uint64_t TimerResolution() {
  return 1;
}

}  // namespace hwy::platform
