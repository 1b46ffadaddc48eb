// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a stage's work runs: on the calling thread, or on several.
#pragma once

#include <functional>
#include <memory>

namespace rg {

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
  void forRows(int rows, const std::function<void(int first, int last)>& task) const;
  /// Calls task(i) for i = 0 … count − 1, in any order.
  void forEach(int count, const std::function<void(int i)>& task) const;
  /// The same; task(i, thread) may use what is kept for thread 0 … threads() − 1.
  void forEach(int count, const std::function<void(int i, int thread)>& task) const;

 private:
  class Arena;
  int threads_;
  std::unique_ptr<Arena> arena_;  ///< None for a single thread.
};

}  // namespace rg
