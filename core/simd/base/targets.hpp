// SPDX-License-Identifier: LGPL-2.1-or-later
// To be included before <hwy/foreach_target.h>: the targets that the sources here are built for.
#pragma once

// Vectors are members of structs here, which takes a size that the compiler knows. Builds for
// sanitizers leave out more (meson.build).
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
