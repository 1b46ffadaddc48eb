// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/kernels/marked_memory.hpp"

#include "gst/support/cuda_memory.hpp"

namespace rg {

std::optional<guint> cudaMapOf(GstBuffer* buffer, int deviceId) {
  if (deviceId != 0 || !GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_LAST)) return std::nullopt;
  return GST_MAP_READ;
}

}  // namespace rg
