// SPDX-License-Identifier: LGPL-2.1-or-later
// CUDA's calls beside launches: memory, copies, waiting. The host version (kernels/shim) does the
// same with the host's memory, and can be told which call is to fail.
//
// A stream's queue (launch_queue.hpp) takes clears and copies on the device; before any other call
// of a stream it must be empty.
//
// All of them throw DeviceError but where noexcept is said.
#pragma once

#include "kernels/launch.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

struct CUevent_st;

namespace rg::gpu {
using Event = CUevent_st*;
}

namespace rg::gpu::runtime {

/// Devices that can be used; 0 without a driver.
[[nodiscard]] int countDevices() noexcept;
/// Why there is none.
[[nodiscard]] std::string whyNone();
[[nodiscard]] std::string nameOf(int device);
/// For the calling thread's calls from then on.
void choose(int device);

[[nodiscard]] CUstream_st* makeStream();
void endStream(CUstream_st* stream) noexcept;

/// Bytes of 0. What is released may still be in use by what the stream was given before.
[[nodiscard]] void* allocate(size_t bytes, Stream stream);
void release(void* memory, Stream stream) noexcept;

void clear(void* memory, size_t bytes, Stream stream);
void copy(void* to, const void* from, size_t bytes, Stream stream);

/// From memory of the same device that another context has allocated.
void bring(void* to, const void* from, size_t bytes, Stream stream);

/// Memory of the host that copies don't wait for.
[[nodiscard]] void* allocateOnHost(size_t bytes);
void releaseOnHost(void* memory) noexcept;
/// The host's memory is of allocateOnHost(), and in use until the stream has come so far. Nothing
/// waits.
void upload(void* to, const void* from, size_t bytes, Stream stream);
void download(void* to, const void* from, size_t bytes, Stream stream);

[[nodiscard]] Event makeEvent();
void endEvent(Event event) noexcept;
/// It comes when the stream has done what it was given before.
void record(Event event, Stream stream);
/// Whether it has come. Throws what the stream's work has failed with, too.
[[nodiscard]] bool isDone(Event event);

/// For who waits: a time that goes on, and a pause, the longer the more was waited.
[[nodiscard]] int64_t clockNs() noexcept;
void rest(int64_t waitedNs) noexcept;

}  // namespace rg::gpu::runtime
