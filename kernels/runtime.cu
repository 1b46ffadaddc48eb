// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/runtime.hpp"
#include "kernels/start.hpp"

#include <chrono>
#include <thread>

namespace rg::gpu::runtime {
namespace {

/// What the call makes.
template <class Handle>
Handle made(const char* call, cudaError_t (*make)(Handle*, unsigned), unsigned flags) {
  Handle handle = nullptr;
  check(make(&handle, flags), call);
  return handle;
}

}  // namespace

int countDevices() noexcept {
  int count = 0;
  if (cudaGetDeviceCount(&count) == cudaSuccess) return count;
  (void)cudaGetLastError();
  return 0;
}

std::string whyNone() {
  int count = 0;
  const cudaError_t code = cudaGetDeviceCount(&count);
  (void)cudaGetLastError();
  return code == cudaSuccess ? "there is no device" : cudaGetErrorString(code);
}

std::string nameOf(int device) {
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, device), "cudaGetDeviceProperties");
  return properties.name;
}

void choose(int device) {
  check(cudaSetDevice(device), "cudaSetDevice");
}

CUstream_st* makeStream() {
  return made("cudaStreamCreateWithFlags", cudaStreamCreateWithFlags, cudaStreamNonBlocking);
}

void endStream(CUstream_st* stream) noexcept {
  (void)cudaStreamDestroy(stream);
}

void* allocate(size_t bytes, Stream stream) {
  void* memory = nullptr;
  check(cudaMallocAsync(&memory, bytes, stream.handle), "cudaMallocAsync");
  try {
    runClear(memory, bytes, stream);
  } catch (...) {
    release(memory, stream);
    throw;
  }
  return memory;
}

void release(void* memory, Stream stream) noexcept {
  (void)cudaFreeAsync(memory, stream.handle);
}

void clear(void* memory, size_t bytes, Stream stream) {
  gpu::clear(memory, bytes, stream);
}

void copy(void* to, const void* from, size_t bytes, Stream stream) {
  if (stream.queue != nullptr) return stream.queue->addCopy(to, from, bytes);
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, stream.handle), "copy");
}

void bring(void* to, const void* from, size_t bytes, Stream stream) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, stream.handle), "bring");
}

void* allocateOnHost(size_t bytes) {
  void* memory = nullptr;
  check(cudaMallocHost(&memory, bytes), "cudaMallocHost");
  return memory;
}

void releaseOnHost(void* memory) noexcept {
  (void)cudaFreeHost(memory);
}

void upload(void* to, const void* from, size_t bytes, Stream stream) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream.handle), "upload");
}

void download(void* to, const void* from, size_t bytes, Stream stream) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream.handle), "download");
}

Event makeEvent() {
  return made("cudaEventCreateWithFlags", cudaEventCreateWithFlags, cudaEventDisableTiming);
}

void endEvent(Event event) noexcept {
  (void)cudaEventDestroy(event);
}

void record(Event event, Stream stream) {
  check(cudaEventRecord(event, stream.handle), "cudaEventRecord");
}

bool isDone(Event event) {
  const cudaError_t code = cudaEventQuery(event);
  if (code != cudaErrorNotReady) check(code, "cudaEventQuery");
  return code == cudaSuccess;
}

int64_t clockNs() noexcept {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

/// What a frame waits for comes in less than the first of these.
void rest(int64_t waitedNs) noexcept {
  constexpr int64_t kShortNs = 500'000;
  if (waitedNs < kShortNs)
    std::this_thread::yield();
  else
    std::this_thread::sleep_for(std::chrono::microseconds(50));
}

}  // namespace rg::gpu::runtime
