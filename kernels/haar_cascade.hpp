// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/detection: integrals, windows by their numbers, a cascade in each window
// (paper, section 3). Tables and views point to device memory.
#pragma once

#include "core/detection/integral.hpp"
#include "core/detection/judge_windows.hpp"
#include "core/detection/search_windows.hpp"
#include "kernels/launch.hpp"

#include <cstdint>

namespace rg::gpu::detection {

/// rg::detection::sumIntegrals.
void sumIntegrals(ImageView<const uint8_t> luma, const rg::detection::Integrals& to, Stream stream);

/// places[id] = rg::detection::placeOf(windows, id) for all windows.
void locateWindows(const rg::detection::WindowTable& windows, rg::detection::WindowPlace* places,
                   Stream stream);

/// rg::detection::judgeWindows.
void judgeWindows(const rg::detection::JudgedPlanes& planes,
                  const rg::detection::WindowTable& windows, uint16_t* stages, Stream stream);

}  // namespace rg::gpu::detection
