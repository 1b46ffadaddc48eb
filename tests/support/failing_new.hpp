// SPDX-License-Identifier: LGPL-2.1-or-later
// An operator new that fails when a test says so. For executables that link failing_new.cpp.
#pragma once

namespace rg::testing {

/// While it lives, the allocation with operator new that comes after `passes` others on this thread
/// throws std::bad_alloc; the ones behind it pass again. One at a time.
class FailingNew {
 public:
  explicit FailingNew(int passes);
  ~FailingNew();
  FailingNew(const FailingNew&) = delete;
  FailingNew& operator=(const FailingNew&) = delete;

  /// Whether there were as many.
  [[nodiscard]] bool hasFailed() const;
};

}  // namespace rg::testing
