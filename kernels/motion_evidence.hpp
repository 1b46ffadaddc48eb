// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/objects/merge/motion_evidence.hpp.
#pragma once

#include "core/objects/merge/motion_evidence.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu::objects {

/// rg::objects::KnownEvidence. labels: 1 … count, 0: none.
struct KnownView {
  ImageView<const uint16_t> labels;
  ImageView<const uint8_t> luma, previous;
  const rg::motion::RegionMotion* motions;
  int count;
  ImageView<const int16_t> gains;
  int left;
};
/// rg::objects::CarriedEvidence; the sums begin at 0 here.
struct CarriedView {
  ImageView<int16_t> gains;
  int64_t* sums;
  uint32_t* samples;
};
void carryEvidence(const KnownView& known, const CarriedView& carried, Stream stream);

void addEvidence(ImageView<const uint16_t> labels, const int16_t* density,
                 ImageView<const int16_t> gains, ImageView<int16_t> sum, Stream stream);

}  // namespace rg::gpu::objects
