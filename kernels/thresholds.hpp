// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of the thresholds of core/base/histogram.hpp (paper, section 2.1).
#pragma once

#include "core/base/histogram.hpp"
#include "kernels/launch.hpp"

namespace rg::gpu {

/// levels: 256 counts; the answer is one number of device memory.
void quantile(const uint32_t* levels, int share, int* level, Stream stream);
void differenceThreshold(const uint32_t* levels, int least, int* threshold, Stream stream);
void contrastThreshold(const uint32_t* levels, int least, int* threshold, Stream stream);

}  // namespace rg::gpu
