// SPDX-License-Identifier: LGPL-2.1-or-later
// The one place that starts kernels; for .cu files only.
#pragma once

#include "core/base/memory/device.hpp"
#include "kernels/device.hpp"
#include "kernels/launch.hpp"

#include <string>

namespace rg::gpu {

#if defined(__CUDACC__)

/// Throws what CUDA says, and clears it, so that the next call does not find it again. What can't
/// be cleared has cost the device's context: every later call says it too.
inline void check(cudaError_t code, const char* call) {
  if (code == cudaSuccess) return;
  (void)cudaGetLastError();
  const cudaError_t later = cudaStreamQuery(nullptr);
  const bool isLost = later != cudaSuccess && later != cudaErrorNotReady;
  throw DeviceError(isLost ? DeviceError::Kind::Lost : DeviceError::Kind::Failed,
                    std::string(call) + ": " + cudaGetErrorString(code));
}

template <class... Parameters, class... Arguments>
void start(const Launch& launch, Stream stream, void (*kernel)(Parameters...),
           const Arguments&... arguments) {
  const dim3 grid(launch.grid.x, launch.grid.y, launch.grid.z);
  const dim3 block(launch.block.x, launch.block.y, launch.block.z);
  kernel<<<grid, block, 0, stream>>>(arguments...);
  check(cudaGetLastError(), launch.name);
}

inline void clear(void* memory, size_t bytes, Stream stream) {
  check(cudaMemsetAsync(memory, 0, bytes, stream), "clear");
}

#else

template <class... Parameters, class... Arguments>
void start(const Launch& launch, Stream, void (*kernel)(Parameters...),
           const Arguments&... arguments) {
  shim::call(launch.name);
  shim::run(launch, [&] { kernel(arguments...); });
}

inline void clear(void* memory, size_t bytes, Stream) {
  shim::call("clear");
  shim::clear(memory, bytes);
}

#endif

}  // namespace rg::gpu
