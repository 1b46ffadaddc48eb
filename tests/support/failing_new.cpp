// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/failing_new.hpp"

#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

constexpr int kNever = -1;
thread_local int passesLeft = kNever;

void countAllocation() {
  if (passesLeft == kNever) return;
  if (passesLeft-- == 0) throw std::bad_alloc();
}

void* orThrow(void* memory) {
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

// Those of arrays are left to the library or the sanitizer: new and delete must be of one kind.
void* operator new(size_t bytes) {
  countAllocation();
  return orThrow(std::malloc(bytes != 0 ? bytes : 1));
}
void* operator new(size_t bytes, std::align_val_t align) {
  countAllocation();
  const auto unit = static_cast<size_t>(align);
  return orThrow(std::aligned_alloc(unit, (bytes + unit - 1) / unit * unit));
}
void* operator new(size_t bytes, const std::nothrow_t&) noexcept {
  try {
    return ::operator new(bytes);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new(size_t bytes, std::align_val_t align, const std::nothrow_t&) noexcept {
  try {
    return ::operator new(bytes, align);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
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

namespace rg::testing {

FailingNew::FailingNew(int passes) {
  passesLeft = passes;
}

FailingNew::~FailingNew() {
  passesLeft = kNever;
}

bool FailingNew::hasFailed() const {
  return passesLeft == kNever;
}

}  // namespace rg::testing
