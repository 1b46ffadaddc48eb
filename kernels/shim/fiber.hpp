// SPDX-License-Identifier: LGPL-2.1-or-later
// A stack of its own for each thread of a block, and the way from one to another.
#pragma once

#include <cstddef>
#include <memory>

namespace rg::gpu::shim {

/// Runs `entry(argument)` from the first resume() on, until it suspends itself. entry must not
/// return; what it left on its stack is forgotten when the fiber is restarted or destroyed.
class Fiber {
 public:
  using Entry = void (*)(void*);
  Fiber(Entry entry, void* argument);
  ~Fiber();
  Fiber(Fiber&&) noexcept;
  Fiber& operator=(Fiber&&) = delete;

  void resume();
  /// From within: back to who resumed it.
  void suspend();
  /// The next resume() begins anew.
  void restart();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rg::gpu::shim
