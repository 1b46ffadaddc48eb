// SPDX-License-Identifier: LGPL-2.1-or-later
// Buffers of the host that elements take for those of CUDA device 0, as the host is the device
// (kernels/shim).
#pragma once

#include <gst/gst.h>

namespace rg::testing {

inline void markAsDeviceMemory(GstBuffer* buffer) {
  GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_LAST);
}

}  // namespace rg::testing
