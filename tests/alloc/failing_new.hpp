// SPDX-License-Identifier: LGPL-2.1-or-later
// Replaces operator new, malloc where this project calls it, and the start of threads by ones that
// fail when they are told to.
#pragma once

#include <cstdint>

namespace rg::testing {

/// From when on something fails, and for how long.
struct Fault {
  uint64_t at = 0;       ///< The how manieth call fails, counted from 1; 0 = none.
  bool staysSo = false;  ///< All later ones fail, too, until disarm().
};

/// Memory fails from here on.
void armMemory(const Fault& fault);
/// The start of a thread fails from here on.
void armThreads(const Fault& fault);
/// Ends both, and tells whether a call has failed.
bool disarm();

/// Calls of operator new since the program began.
[[nodiscard]] uint64_t allocations();

}  // namespace rg::testing
