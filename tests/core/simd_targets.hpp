// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs a test once for each SIMD target of this machine, and for one to four threads.
#pragma once

#include "core/base/memory/executor.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstdint>
#include <memory>
#include <string>

namespace rg::test {

/// Until the end of its life, dispatched functions run on one target only.
class TargetScope {
 public:
  explicit TargetScope(int64_t target) { set(target); }
  ~TargetScope() { set(0); }
  TargetScope(const TargetScope&) = delete;
  TargetScope& operator=(const TargetScope&) = delete;

 private:
  static void set(int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

/// Calls check() on each target; a failure names it.
template <class Check>
void forEachTarget(const Check& check) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const TargetScope scope(target);
    check();
  }
}

/// Calls check(shared executor) on each target with one to four threads, on any machine: an
/// executor has as many threads as the arena that it is made in.
template <class Check>
void forEachTargetAndThreads(const Check& check) {
  constexpr int kMostThreads = 4;
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, kMostThreads);
  forEachTarget([&] {
    for (int threads = 1; threads <= kMostThreads; ++threads)
      tbb::task_arena(kMostThreads).execute([&] {
        SCOPED_TRACE(std::to_string(threads) + " threads");
        const auto executor = std::make_shared<const Executor>(threads);
        ASSERT_EQ(executor->threads(), threads);
        check(executor);
      });
  });
}

}  // namespace rg::test
