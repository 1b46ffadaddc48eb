// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/runtime.hpp"

#include "kernels/launch_queue.hpp"
#include "kernels/shim/faults.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <utility>

namespace rg::gpu {
namespace {

constexpr auto kAlign = std::align_val_t{256};

std::mutex mutex;  // Protects what is not atomic.
std::optional<shim::Fault> planned;
uint64_t calls = 0;
bool isLost = false, hangs = false;
std::atomic<int64_t> allocations = 0, hostAllocations = 0;
std::atomic<int64_t> clock = 0;

}  // namespace

void shim::plan(std::optional<Fault> fault) {
  const std::lock_guard lock(mutex);
  planned = fault;
  calls = 0;
  isLost = hangs = false;
}

uint64_t shim::countCalls() {
  const std::lock_guard lock(mutex);
  return calls;
}

int64_t shim::countAllocations() {
  return allocations;
}

int64_t shim::countHostAllocations() {
  return hostAllocations;
}

void shim::call(const char* name) {
  const std::lock_guard lock(mutex);
  const bool isPlanned =
      planned && calls >= planned->call && calls - planned->call < planned->times;
  ++calls;
  if (isPlanned && planned->hangs) hangs = true;
  if (hangs) return;
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

CUstream_st* makeStream() {
  shim::call("makeStream");
  return nullptr;
}

void endStream(CUstream_st*) noexcept {}

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

void clear(void* memory, size_t bytes, Stream stream) {
  if (stream.queue != nullptr) return stream.queue->addClear(memory, bytes);
  shim::call("clear");
  std::memset(memory, 0, bytes);
}

void copy(void* to, const void* from, size_t bytes, Stream stream) {
  if (stream.queue != nullptr) return stream.queue->addCopy(to, from, bytes);
  shim::call("copy");
  std::memcpy(to, from, bytes);
}

void bring(void* to, const void* from, size_t bytes, Stream) {
  shim::call("bring");
  std::memcpy(to, from, bytes);
}

void* allocateOnHost(size_t bytes) {
  shim::call("allocateOnHost");
  void* memory = ::operator new(bytes, kAlign);
  ++hostAllocations;
  return memory;
}

void releaseOnHost(void* memory) noexcept {
  --hostAllocations;
  ::operator delete(memory, kAlign);
}

void upload(void* to, const void* from, size_t bytes, Stream) {
  shim::call("upload");
  std::memcpy(to, from, bytes);
}

void download(void* to, const void* from, size_t bytes, Stream) {
  shim::call("download");
  std::memcpy(to, from, bytes);
}

Event makeEvent() {
  shim::call("makeEvent");
  return reinterpret_cast<Event>(new bool(false));
}

void endEvent(Event event) noexcept {
  delete reinterpret_cast<bool*>(event);
}

void record(Event event, Stream) {
  shim::call("record");
  *reinterpret_cast<bool*>(event) = false;
}

/// Each one is waited for once.
bool isDone(Event event) {
  shim::call("isDone");
  const std::lock_guard lock(mutex);
  return !hangs && std::exchange(*reinterpret_cast<bool*>(event), true);
}

int64_t clockNs() noexcept {
  return clock;
}

/// No time goes by but in the count.
void rest(int64_t waitedNs) noexcept {
  clock += std::max(int64_t{1000}, waitedNs / 8);
}

}  // namespace runtime
}  // namespace rg::gpu
