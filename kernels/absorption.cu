// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/absorber.hpp"
#include "kernels/start.hpp"

namespace rg::gpu::segmentation {
namespace {

using namespace one_block;

__global__ void __launch_bounds__(kThreads, 1)
    absorbRegions(AbsorptionLimits limits, const __grid_constant__ AbsorptionView view) {
  RG_SHARED(uint32_t, sums, kWarps);
  RG_SHARED(uint32_t, digits, kDigits);
  absorbAll(limits, view, sums, digits);
}

}  // namespace

void absorb(const AbsorptionLimits& limits, const AbsorptionView& view, Stream stream) {
  constexpr double kUsualRegions = 4096;
  start(launchOf("absorb", kUsualRegions), stream, absorbRegions, limits, view);
}

}  // namespace rg::gpu::segmentation
