// SPDX-License-Identifier: LGPL-2.1-or-later
// The one place that starts kernels; for .cu files only. A stream that has a queue gets them later.
#pragma once

#include "core/base/memory/device.hpp"
#include "kernels/device.hpp"
#include "kernels/launch.hpp"
#include "kernels/launch_queue.hpp"

#include <cstddef>
#include <string>
#include <utility>

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

inline void runClear(void* memory, size_t bytes, Stream stream) {
  check(cudaMemsetAsync(memory, 0, bytes, stream.handle), "clear");
}

template <class... Parameters>
void runKernel(const Launch& launch, Stream stream, void (*kernel)(Parameters...),
               const Parameters&... arguments) {
  const dim3 grid(launch.grid.x, launch.grid.y, launch.grid.z);
  const dim3 block(launch.block.x, launch.block.y, launch.block.z);
  kernel<<<grid, block, 0, stream.handle>>>(arguments...);
  check(cudaGetLastError(), launch.name);
}

template <class... Parameters>
constexpr Command::HostCall hostCallOf() {
  return nullptr;
}

#else

inline void runClear(void* memory, size_t bytes, Stream) {
  shim::call("clear");
  shim::clear(memory, bytes);
}

template <class... Parameters>
void runKernel(const Launch& launch, Stream, void (*kernel)(Parameters...),
               const Parameters&... arguments) {
  shim::call(launch.name);
  shim::run(launch, [&] { kernel(arguments...); });
}

/// Runs a kernel with arguments from a list of commands.
template <class... Parameters>
constexpr Command::HostCall hostCallOf() {
  return [](const Launch& launch, const void* kernel, const std::byte* arguments) {
    using Places = ArgumentPlaces<Parameters...>;
    const auto call = [&]<size_t... I>(std::index_sequence<I...>) {
      auto* const run = reinterpret_cast<void (*)(Parameters...)>(const_cast<void*>(kernel));
      run(*reinterpret_cast<const Parameters*>(arguments + Places::kBytes[I])...);
    };
    shim::run(launch, [&] { call(std::index_sequence_for<Parameters...>{}); });
  };
}

#endif

inline void clear(void* memory, size_t bytes, Stream stream) {
  if (stream.queue != nullptr)
    stream.queue->addClear(memory, bytes);
  else
    runClear(memory, bytes, stream);
}

template <class... Parameters, class... Arguments>
void start(const Launch& launch, Stream stream, void (*kernel)(Parameters...),
           const Arguments&... arguments) {
  if (stream.queue != nullptr)
    stream.queue->addKernel<Parameters...>(launch, reinterpret_cast<const void*>(kernel),
                                           hostCallOf<Parameters...>(), arguments...);
  else
    runKernel<Parameters...>(launch, stream, kernel, arguments...);
}

}  // namespace rg::gpu
