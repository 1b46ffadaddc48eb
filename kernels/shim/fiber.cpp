// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/shim/fiber.hpp"

#include <array>
#include <cstdint>
#include <utility>

#if !defined(__x86_64__)
#include <ucontext.h>
#endif

namespace rg::gpu::shim {
namespace {

constexpr size_t kStackBytes = 64 * 1024;

}  // namespace

#if defined(__x86_64__)

// swapcontext asks the kernel for the signal mask at each switch, which takes a hundred times as
// long as the rest. What a call must keep goes to the stack, the stack pointer to *from; then the
// same from `to` on.
extern "C" void rgSwitchStack(void** from, void* to);
__asm__(
    ".text\n"
    ".globl rgSwitchStack\n"
    ".hidden rgSwitchStack\n"
    ".type rgSwitchStack, @function\n"
    "rgSwitchStack:\n"
    "  endbr64\n"
    "  pushq %rbp\n"
    "  pushq %rbx\n"
    "  pushq %r12\n"
    "  pushq %r13\n"
    "  pushq %r14\n"
    "  pushq %r15\n"
    "  movq %rsp, (%rdi)\n"
    "  movq %rsi, %rsp\n"
    "  popq %r15\n"
    "  popq %r14\n"
    "  popq %r13\n"
    "  popq %r12\n"
    "  popq %rbx\n"
    "  popq %rbp\n"
    "  ret\n"
    ".size rgSwitchStack, .-rgSwitchStack\n");

struct Fiber::State {
  Entry entry;
  void* argument;
  std::unique_ptr<std::byte[]> stack{new std::byte[kStackBytes]};
  void *inside = nullptr, *outside = nullptr;

  /// A new stack holds six registers and an address to return to; at a function's first
  /// instruction the stack pointer is eight beyond a multiple of sixteen.
  void begin() {
    const auto top = (reinterpret_cast<uintptr_t>(stack.get()) + kStackBytes) & ~uintptr_t{15};
    auto* slot = reinterpret_cast<void**>(top) - 2;
    *slot = reinterpret_cast<void*>(&State::run);
    for (int i = 0; i < 6; ++i) *--slot = nullptr;
    inside = slot;
  }
  void enter() {
    starting = this;
    rgSwitchStack(&outside, inside);
  }
  void leave() { rgSwitchStack(&inside, outside); }

  static void run() {
    State* const self = starting;
    self->entry(self->argument);
  }
  static thread_local State* starting;
};
thread_local Fiber::State* Fiber::State::starting = nullptr;

#else

struct Fiber::State {
  Entry entry;
  void* argument;
  std::unique_ptr<std::byte[]> stack{new std::byte[kStackBytes]};
  ucontext_t inside{}, outside{};

  void begin() {
    getcontext(&inside);
    inside.uc_stack.ss_sp = stack.get();
    inside.uc_stack.ss_size = kStackBytes;
    inside.uc_link = nullptr;
    makecontext(&inside, &State::run, 0);
  }
  void enter() {
    starting = this;
    swapcontext(&outside, &inside);
  }
  void leave() { swapcontext(&inside, &outside); }

  static void run() {
    State* const self = starting;
    self->entry(self->argument);
  }
  static thread_local State* starting;
};
thread_local Fiber::State* Fiber::State::starting = nullptr;

#endif

Fiber::Fiber(Entry entry, void* argument) : state_(new State{entry, argument}) {
  state_->begin();
}
Fiber::~Fiber() = default;
Fiber::Fiber(Fiber&&) noexcept = default;

void Fiber::resume() {
  state_->enter();
}
void Fiber::suspend() {
  state_->leave();
}
void Fiber::restart() {
  state_->begin();
}

}  // namespace rg::gpu::shim
