// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/runtime.hpp"
#include "kernels/start.hpp"

namespace rg::gpu::runtime {

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

Stream makeStream() {
  Stream stream = nullptr;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "cudaStreamCreateWithFlags");
  return stream;
}

void endStream(Stream stream) noexcept {
  (void)cudaStreamDestroy(stream);
}

void* allocate(size_t bytes, Stream stream) {
  void* memory = nullptr;
  check(cudaMallocAsync(&memory, bytes, stream), "cudaMallocAsync");
  try {
    gpu::clear(memory, bytes, stream);
  } catch (...) {
    release(memory, stream);
    throw;
  }
  return memory;
}

void release(void* memory, Stream stream) noexcept {
  (void)cudaFreeAsync(memory, stream);
}

void clear(void* memory, size_t bytes, Stream stream) {
  gpu::clear(memory, bytes, stream);
}

void upload(void* to, const void* from, size_t bytes, Stream stream) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream), "upload");
}

void download(void* to, const void* from, size_t bytes, Stream stream) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream), "download");
  check(cudaStreamSynchronize(stream), "download");
}

void copy(void* to, const void* from, size_t bytes, Stream stream) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, stream), "copy");
}

}  // namespace rg::gpu::runtime
