// SPDX-License-Identifier: LGPL-2.1-or-later
// CUDA's calls beside launches: memory, copies, waiting. The host version (kernels/shim) does the
// same with the host's memory, and can be told which call is to fail.
//
// All of them throw DeviceError but where noexcept is said.
#pragma once

#include "kernels/launch.hpp"

#include <cstddef>
#include <string>

namespace rg::gpu::runtime {

/// Devices that can be used; 0 without a driver.
[[nodiscard]] int countDevices() noexcept;
/// Why there is none.
[[nodiscard]] std::string whyNone();
[[nodiscard]] std::string nameOf(int device);
/// For the calling thread's calls from then on.
void choose(int device);

[[nodiscard]] Stream makeStream();
void endStream(Stream stream) noexcept;

/// Bytes of 0. What is released may still be in use by what the stream was given before.
[[nodiscard]] void* allocate(size_t bytes, Stream stream);
void release(void* memory, Stream stream) noexcept;

void clear(void* memory, size_t bytes, Stream stream);
/// `from` may change as soon as it returns.
void upload(void* to, const void* from, size_t bytes, Stream stream);
/// Waits for what the stream was given before.
void download(void* to, const void* from, size_t bytes, Stream stream);
void copy(void* to, const void* from, size_t bytes, Stream stream);

}  // namespace rg::gpu::runtime
