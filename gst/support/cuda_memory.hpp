// SPDX-License-Identifier: LGPL-2.1-or-later
// Buffers in the memory of a GPU, as GStreamer's nvcodec makes them.
#pragma once

#include <gst/gst.h>

#include <optional>

namespace rg {

/// The flags to map a buffer with so that its bytes are those of CUDA device `deviceId`, complete
/// as they are. None of buffers that lie elsewhere, and where this was built without libgstcuda.
[[nodiscard]] std::optional<guint> cudaMapOf(GstBuffer* buffer, int deviceId);

}  // namespace rg
