// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/kernels/gpu_memory.hpp"

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cuda_runtime.h>
#include <mutex>
#include <new>
#include <pthread.h>
#include <sys/mman.h>

namespace rg::test {
namespace {

constexpr size_t kArenaBytes = size_t{1} << 29, kStackBytes = size_t{64} << 20;
/// Every block begins with as much of its own, so that what follows is aligned like this.
constexpr size_t kAlign = 256;

/// Blocks of powers of two; what is released is kept for the next of that size.
class Arena {
 public:
  void begin(std::byte* memory, size_t bytes) {
    next_ = begin_ = memory;
    end_ = memory + bytes;
  }

  /// Null when it is used up.
  void* take(size_t bytes) {
    const auto kind = static_cast<size_t>(std::bit_width((bytes + kAlign - 1) | kAlign));
    const std::lock_guard lock(mutex_);
    Block* block = free_[kind];
    if (block != nullptr) {
      free_[kind] = block->next;
    } else {
      const size_t whole = kAlign + (size_t{1} << kind);
      if (static_cast<size_t>(end_ - next_) < whole) return nullptr;
      block = new (next_) Block{kind, nullptr};
      next_ += whole;
    }
    return reinterpret_cast<std::byte*>(block) + kAlign;
  }

  [[nodiscard]] bool owns(const void* memory) const {
    const auto* at = static_cast<const std::byte*>(memory);
    return at >= begin_ && at < end_;
  }

  void give(void* memory) {
    auto* block = reinterpret_cast<Block*>(static_cast<std::byte*>(memory) - kAlign);
    const std::lock_guard lock(mutex_);
    block->next = free_[block->kind];
    free_[block->kind] = block;
  }

 private:
  struct Block {
    size_t kind;
    Block* next;
  };

  std::mutex mutex_;
  std::byte *begin_ = nullptr, *next_ = nullptr, *end_ = nullptr;
  std::array<Block*, 64> free_{};
};

Arena arena;
std::atomic<bool> isShared = false;

void* callAndLeave(void* run) {
  const int status = reinterpret_cast<int (*)()>(run)();
  std::fflush(nullptr);
  std::_Exit(status);
}

void* takeMemory(size_t bytes, size_t align) {
  void* memory = nullptr;
  if (isShared && align <= kAlign)
    memory = arena.take(bytes);
  else
    memory = std::aligned_alloc(align, (bytes + align - 1) / align * align);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void giveMemory(void* memory) {
  if (arena.owns(memory))
    arena.give(memory);
  else
    std::free(memory);
}

}  // namespace

int callInGpuMemory(int (*run)()) {
  void* const memory = mmap(nullptr, kArenaBytes + kStackBytes, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {
    std::perror("mmap");
    std::_Exit(1);
  }
  const cudaError_t code =
      cudaHostRegister(memory, kArenaBytes + kStackBytes, cudaHostRegisterMapped);
  void* seen = nullptr;
  if (code != cudaSuccess || cudaHostGetDevicePointer(&seen, memory, 0) != cudaSuccess ||
      seen != memory) {
    std::fprintf(stderr, "the device does not see the host's memory: %s\n",
                 cudaGetErrorString(code));
    std::_Exit(1);
  }
  pthread_attr_t attributes;
  pthread_t thread{};
  auto* const stack = static_cast<std::byte*>(memory);
  arena.begin(stack + kStackBytes, kArenaBytes);
  isShared = true;
  if (pthread_attr_init(&attributes) == 0 &&
      pthread_attr_setstack(&attributes, stack, kStackBytes) == 0 &&
      pthread_create(&thread, &attributes, callAndLeave, reinterpret_cast<void*>(run)) == 0)
    pthread_join(thread, nullptr);
  std::fprintf(stderr, "no thread on memory that the device sees\n");
  std::_Exit(1);
}

}  // namespace rg::test

void* operator new(size_t bytes) {
  return rg::test::takeMemory(bytes, alignof(std::max_align_t));
}
void* operator new(size_t bytes, std::align_val_t align) {
  return rg::test::takeMemory(bytes, static_cast<size_t>(align));
}
void operator delete(void* memory) noexcept {
  rg::test::giveMemory(memory);
}
void operator delete(void* memory, size_t) noexcept {
  rg::test::giveMemory(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  rg::test::giveMemory(memory);
}
void operator delete(void* memory, size_t, std::align_val_t) noexcept {
  rg::test::giveMemory(memory);
}
