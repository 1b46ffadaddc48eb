// SPDX-License-Identifier: LGPL-2.1-or-later
// Results that return to where they came from, so that a running pipeline does not allocate.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace rg {

/// Hands out objects of type T by shared_ptr. The last reference gives the object back with its
/// memory; a reused object keeps its old contents, so whoever takes one must write every field.
/// References may outlive the pool and may be dropped on any thread.
template <class T>
class Pool {
 public:
  Pool() : shelf_(std::make_shared<Shelf>()) {}

  [[nodiscard]] std::shared_ptr<T> take() {
    std::unique_ptr<T> object;
    {
      const std::lock_guard lock(shelf_->mutex);
      if (!shelf_->free.empty()) {
        object = std::move(shelf_->free.back());
        shelf_->free.pop_back();
      }
    }
    if (!object) object = std::make_unique<T>();
    return {object.release(), [shelf = std::weak_ptr(shelf_)](T* used) { giveBack(shelf, used); }};
  }

 private:
  struct Shelf {
    std::mutex mutex;  ///< Protects `free`; nothing is called while it is held.
    std::vector<std::unique_ptr<T>> free;
  };

  static void giveBack(const std::weak_ptr<Shelf>& weak, T* used) noexcept {
    std::unique_ptr<T> object(used);
    const auto shelf = weak.lock();
    if (!shelf) return;
    release(*object);
    try {
      const std::lock_guard lock(shelf->mutex);
      shelf->free.push_back(std::move(object));
    } catch (...) {  // No memory to remember it: it is freed instead.
    }
  }
  /// Results hold the results that they were made from; a shelved one must not keep those alive.
  static void release(T& object) {
    if constexpr (requires { object.dropSources(); }) object.dropSources();
  }

  std::shared_ptr<Shelf> shelf_;
};

}  // namespace rg
