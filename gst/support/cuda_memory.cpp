// SPDX-License-Identifier: LGPL-2.1-or-later
// Calls nothing of libgstcuda's that needs the driver but for memory of its own, which only comes
// into being with one: without, its functions end the process.
#include "gst/support/cuda_memory.hpp"

#include <gst/cuda/gstcudamemory.h>

namespace rg {
namespace {

int deviceOf(const GstCudaMemory& memory) {
  guint device = 0;
  g_object_get(memory.context, "cuda-device-id", &device, nullptr);
  return static_cast<int>(device);
}

}  // namespace

std::optional<guint> cudaMapOf(GstBuffer* buffer, int deviceId) {
  if (gst_buffer_n_memory(buffer) != 1) return std::nullopt;
  GstMemory* memory = gst_buffer_peek_memory(buffer, 0);
  if (!gst_is_cuda_memory(memory)) return std::nullopt;
  GstCudaMemory* there = GST_CUDA_MEMORY_CAST(memory);
  if (deviceOf(*there) != deviceId) return std::nullopt;
#if GST_CHECK_VERSION(1, 24, 0)
  gst_cuda_memory_sync(there);
#endif
  return guint{GST_MAP_READ} | GST_MAP_CUDA;
}

}  // namespace rg
