// SPDX-License-Identifier: LGPL-2.1-or-later
// The allocator's functions, for all that is in the program, libraries as well: each block has a
// head before it that says how many bytes it is.
#include "tests/stress/heap_count.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <malloc.h>
#include <unistd.h>

// What glibc's own functions are called beside the names that are taken here.
extern "C" {
void* __libc_malloc(size_t bytes);
void* __libc_memalign(size_t alignment, size_t bytes);
void __libc_free(void* block);
}

namespace {

struct alignas(16) Head {
  size_t bytes;
  size_t offset;  ///< Of what the program has, in the block.
};
constexpr size_t kMostBytes = SIZE_MAX / 4;

std::atomic<size_t> inUse{0};

Head* headOf(void* memory) {
  return static_cast<Head*>(memory) - 1;
}

void* begin(void* block, size_t bytes, size_t offset) {
  if (!block) return nullptr;
  inUse += bytes;
  auto* memory = static_cast<uint8_t*>(block) + offset;
  *headOf(memory) = {bytes, offset};
  return memory;
}

void* allocate(size_t alignment, size_t bytes) {
  if (alignment > kMostBytes || bytes > kMostBytes) {
    errno = ENOMEM;
    return nullptr;
  }
  if (alignment <= sizeof(Head))
    return begin(__libc_malloc(sizeof(Head) + bytes), bytes, sizeof(Head));
  return begin(__libc_memalign(alignment, alignment + bytes), bytes, alignment);
}

}  // namespace

size_t rg::stress::bytesInUse() {
  return inUse;
}

extern "C" {

void* malloc(size_t bytes) {
  return allocate(0, bytes);
}

void free(void* memory) {
  if (!memory) return;
  const Head head = *headOf(memory);
  inUse -= head.bytes;
  __libc_free(static_cast<uint8_t*>(memory) - head.offset);
}

void* calloc(size_t count, size_t bytes) {
  size_t all = 0;
  if (__builtin_mul_overflow(count, bytes, &all)) all = SIZE_MAX;
  void* memory = allocate(0, all);
  // The compiler would make a call of calloc of malloc and memset.
  asm("" : "+r"(memory));
  return memory ? std::memset(memory, 0, all) : nullptr;
}

void* realloc(void* memory, size_t bytes) {
  if (!memory) return malloc(bytes);
  if (bytes == 0) {
    free(memory);
    return nullptr;
  }
  void* larger = malloc(bytes);
  if (!larger) return nullptr;
  std::memcpy(larger, memory, std::min(bytes, headOf(memory)->bytes));
  free(memory);
  return larger;
}

void* memalign(size_t alignment, size_t bytes) {
  return allocate(alignment, bytes);
}

void* aligned_alloc(size_t alignment, size_t bytes) {
  return allocate(alignment, bytes);
}

int posix_memalign(void** memory, size_t alignment, size_t bytes) {
  *memory = allocate(alignment, bytes);
  return *memory ? 0 : ENOMEM;
}

void* valloc(size_t bytes) {
  return allocate(static_cast<size_t>(sysconf(_SC_PAGESIZE)), bytes);
}

size_t malloc_usable_size(void* memory) {
  return memory ? headOf(memory)->bytes : 0;
}

}  // extern "C"
