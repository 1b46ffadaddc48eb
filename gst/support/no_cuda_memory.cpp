// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/cuda_memory.hpp"

namespace rg {

std::optional<guint> cudaMapOf(GstBuffer*, int) {
  return std::nullopt;
}

}  // namespace rg
