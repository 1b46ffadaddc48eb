// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/runtime.hpp"

#include "kernels/shim/faults.hpp"

#include <atomic>
#include <cstring>
#include <mutex>
#include <new>
#include <string>

namespace rg::gpu {
namespace {

constexpr auto kAlign = std::align_val_t{256};

std::mutex mutex;  // Protects all of these.
std::optional<shim::Fault> planned;
uint64_t calls = 0;
bool isLost = false;
std::atomic<int64_t> allocations = 0;

}  // namespace

void shim::plan(std::optional<Fault> fault) {
  const std::lock_guard lock(mutex);
  planned = fault;
  calls = 0;
  isLost = false;
}

uint64_t shim::countCalls() {
  const std::lock_guard lock(mutex);
  return calls;
}

int64_t shim::countAllocations() {
  return allocations;
}

void shim::call(const char* name) {
  const std::lock_guard lock(mutex);
  const bool isPlanned = planned && planned->call == calls;
  ++calls;
  if (isPlanned && planned->kind == DeviceError::Kind::Lost) isLost = true;
  if (isLost) throw DeviceError(DeviceError::Kind::Lost, std::string(name) + ": planned loss");
  if (isPlanned)
    throw DeviceError(DeviceError::Kind::Failed, std::string(name) + ": planned failure");
}

namespace runtime {

int countDevices() noexcept {
  return 1;
}

std::string whyNone() {
  return {};
}

std::string nameOf(int) {
  return "host";
}

void choose(int) {
  shim::call("choose");
}

Stream makeStream() {
  shim::call("makeStream");
  return nullptr;
}

void endStream(Stream) noexcept {}

void* allocate(size_t bytes, Stream) {
  shim::call("allocate");
  void* memory = ::operator new(bytes, kAlign);
  std::memset(memory, 0, bytes);
  ++allocations;
  return memory;
}

void release(void* memory, Stream) noexcept {
  --allocations;
  ::operator delete(memory, kAlign);
}

void clear(void* memory, size_t bytes, Stream) {
  shim::call("clear");
  std::memset(memory, 0, bytes);
}

void upload(void* to, const void* from, size_t bytes, Stream) {
  shim::call("upload");
  std::memcpy(to, from, bytes);
}

void download(void* to, const void* from, size_t bytes, Stream) {
  shim::call("download");
  std::memcpy(to, from, bytes);
}

void copy(void* to, const void* from, size_t bytes, Stream) {
  shim::call("copy");
  std::memcpy(to, from, bytes);
}

}  // namespace runtime
}  // namespace rg::gpu
