// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/alloc/failing_new.hpp"

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <dlfcn.h>
#include <new>
#include <pthread.h>

// What the linker's --wrap makes of calls of malloc in this program's own objects.
extern "C" {
void* __real_malloc(size_t bytes);
void* __real_calloc(size_t count, size_t bytes);
void* __real_realloc(void* memory, size_t bytes);
void* __real_aligned_alloc(size_t alignment, size_t bytes);
}

namespace rg::testing {
namespace {

/// Counts calls down to the one that fails. Any thread may call.
class Countdown {
 public:
  void arm(const Fault& fault) {
    staysSo_ = fault.staysSo;
    hasFailed_ = false;
    left_ = static_cast<int64_t>(fault.at);
    isArmed_ = fault.at != 0;
  }
  bool disarm() {
    isArmed_ = false;
    return hasFailed_.exchange(false);
  }
  bool fails() {
    if (!isArmed_.load(std::memory_order_relaxed)) return false;
    const int64_t left = --left_;
    const bool isFailing = left == 0 || (left < 0 && staysSo_);
    if (isFailing) hasFailed_ = true;
    return isFailing;
  }

 private:
  std::atomic<bool> isArmed_ = false, staysSo_ = false, hasFailed_ = false;
  std::atomic<int64_t> left_ = 0;
};

Countdown memory, threads;
std::atomic<uint64_t> calls = 0;

void* allocate(size_t bytes, size_t alignment) {
  calls.fetch_add(1, std::memory_order_relaxed);
  if (memory.fails()) throw std::bad_alloc();
  const size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  void* allocated = alignment > alignof(std::max_align_t) ? __real_aligned_alloc(alignment, rounded)
                                                          : __real_malloc(bytes == 0 ? 1 : bytes);
  if (!allocated) throw std::bad_alloc();
  return allocated;
}

}  // namespace

void armMemory(const Fault& fault) {
  memory.arm(fault);
}
void armThreads(const Fault& fault) {
  threads.arm(fault);
}
bool disarm() {
  const bool hasMemoryFailed = memory.disarm();
  return threads.disarm() || hasMemoryFailed;
}
uint64_t allocations() {
  return calls;
}

}  // namespace rg::testing

using rg::testing::allocate;

void* operator new(size_t bytes) {
  return allocate(bytes, 1);
}
void* operator new(size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, size_t, std::align_val_t) noexcept {
  std::free(memory);
}

extern "C" {

void* __wrap_malloc(size_t bytes) {
  return rg::testing::memory.fails() ? nullptr : __real_malloc(bytes);
}
void* __wrap_calloc(size_t count, size_t bytes) {
  return rg::testing::memory.fails() ? nullptr : __real_calloc(count, bytes);
}
void* __wrap_realloc(void* memory, size_t bytes) {
  return rg::testing::memory.fails() ? nullptr : __real_realloc(memory, bytes);
}
void* __wrap_aligned_alloc(size_t alignment, size_t bytes) {
  return rg::testing::memory.fails() ? nullptr : __real_aligned_alloc(alignment, bytes);
}

/// Found before the C library's by every library that starts threads.
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) {
  if (rg::testing::threads.fails()) return EAGAIN;
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  return create(thread, attributes, start, argument);
}
}
