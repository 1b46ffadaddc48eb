// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/memory/executor.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <stdexcept>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace rg {
namespace {

/// A call's tasks come after what its thread did before, and before what it does next. TBB sees to
/// that; ThreadSanitizer does not see TBB, and is told.
class Handover {
 public:
  Handover() { release(begun_); }
  ~Handover() { acquire(done_); }
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;

  template <class... Arguments>
  void run(const Task<Arguments...>& task, Arguments... arguments) {
    acquire(begun_);
    task(arguments...);
    release(done_);
  }

 private:
#if defined(__SANITIZE_THREAD__)
  static void acquire(char& place) {
    __tsan_acquire(&place);
  }
  static void release(char& place) {
    __tsan_release(&place);
  }
#else
  static void acquire(char& /*place*/) {}
  static void release(char& /*place*/) {}
#endif

  char begun_ = 0, done_ = 0;
};

}  // namespace

class Executor::Arena : public tbb::task_arena {
 public:
  using tbb::task_arena::task_arena;

  /// Starts the threads before there is work, which goes on with fewer where no more can be had.
  void wake(int threads) {
    try {
      execute([&] { tbb::parallel_for(0, threads, [](int) {}); });
    } catch (const std::runtime_error&) {
    }
  }
};

Executor::Executor(int threads) {
  const int cores = std::max(1, tbb::this_task_arena::max_concurrency());
  threads_ = threads <= 0 ? cores : std::min(threads, cores);
  if (threads_ <= 1) return;
  arena_ = std::make_unique<Arena>(threads_);
  arena_->wake(threads_);
}

Executor::~Executor() = default;
Executor::Executor(Executor&&) noexcept = default;
Executor& Executor::operator=(Executor&&) noexcept = default;

void Executor::forRows(int rows, Task<int, int> task) const {
  constexpr int kLeastRows = 16;  // Below this, waking a thread costs more than the rows.
  if (rows <= 0) return;
  if (!arena_ || rows < 2 * kLeastRows) return task(0, rows);
  Handover handover;
  arena_->execute([&] {
    const int grain = std::max(kLeastRows, rows / (4 * threads_));
    tbb::parallel_for(tbb::blocked_range<int>(0, rows, static_cast<size_t>(grain)),
                      [&](const auto& band) { handover.run(task, band.begin(), band.end()); });
  });
}

void Executor::forEach(int count, Task<int> task) const {
  if (!arena_ || count < 2) {
    for (int i = 0; i < count; ++i) task(i);
    return;
  }
  Handover handover;
  arena_->execute([&] { tbb::parallel_for(0, count, [&](int i) { handover.run(task, i); }); });
}

void Executor::forEach(int count, Task<int, int> task) const {
  if (!arena_ || count < 2) {
    for (int i = 0; i < count; ++i) task(i, 0);
    return;
  }
  forEach(count, [&](int i) { task(i, tbb::this_task_arena::current_thread_index()); });
}

}  // namespace rg
