// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a stage's work runs: on the calling thread, or on several.
#pragma once

#include <memory>
#include <type_traits>

namespace rg {

/// What a call is given to do: a borrowed callable, so that no frame allocates for it. It must live
/// until the call returns.
template <class... Arguments>
class Task {
 public:
  template <class Callable>
  requires(!std::is_same_v<Callable, Task> && std::is_invocable_v<const Callable&, Arguments...>)
      Task(const Callable& callable)  // NOLINT(google-explicit-constructor)
      : callable_(&callable), call_([](const void* borrowed, Arguments... arguments) {
          (*static_cast<const Callable*>(borrowed))(arguments...);
        }) {}

  void operator()(Arguments... arguments) const { call_(callable_, arguments...); }

 private:
  const void* callable_;
  void (*call_)(const void*, Arguments...);
};

/// Runs tasks on a fixed number of threads. Results must not depend on that number: tasks write to
/// places of their own, and what they share are sums, minima and maxima of integers.
class Executor {
 public:
  /// threads: 0 = as many as the machine has cores; never more than that.
  explicit Executor(int threads);
  ~Executor();
  Executor(Executor&&) noexcept;
  Executor& operator=(Executor&&) noexcept;

  [[nodiscard]] int threads() const { return threads_; }

  /// Calls task(first, last) for bands of rows that together cover 0 … rows − 1 once each.
  void forRows(int rows, Task<int, int> task) const;
  /// Calls task(i) for i = 0 … count − 1, in any order.
  void forEach(int count, Task<int> task) const;
  /// The same; task(i, thread) may use what is kept for thread 0 … threads() − 1.
  void forEach(int count, Task<int, int> task) const;

 private:
  class Arena;
  int threads_;
  std::unique_ptr<Arena> arena_;  ///< None for a single thread.
};

}  // namespace rg
