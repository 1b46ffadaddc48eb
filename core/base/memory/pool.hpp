// SPDX-License-Identifier: LGPL-2.1-or-later
// Results that return to where they came from, so that a running pipeline does not allocate.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

namespace rg {

/// Hands out objects of type T by shared_ptr. The last reference gives the object back with its
/// memory; a reused object keeps its old contents, so whoever takes one must write every field.
/// No more are kept than were in use at once lately. References may outlive the pool and may be
/// dropped on any thread.
template <class T>
class Pool {
 public:
  Pool() : shelf_(std::make_shared<Shelf>()) {}
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() { drop(); }

  [[nodiscard]] std::shared_ptr<T> take() {
    std::unique_ptr<Node> node = shelf_->take();
    if (!node) node = std::make_unique<Node>(shelf_);
    node->generation = shelf_->countTaken();
    Node* taken = node.release();
    return {&taken->object, DropSources{}, InNode<T>{taken}};
  }

  /// Frees what is not in use now, and what is, once it comes back.
  void drop() noexcept { shelf_->drop(); }

 private:
  struct Shelf;

  /// An object with the place for its reference counts.
  struct Node {
    explicit Node(const std::shared_ptr<Shelf>& shelf) : home(shelf) {}
    T object{};
    std::weak_ptr<Shelf> home;
    uint64_t generation = 0;  ///< Of the shelf when it was taken.
    std::unique_ptr<Node> next;
    alignas(std::max_align_t) std::byte counts[64];
  };

  struct Shelf {
    static constexpr int kWindow = 256;  ///< Of takes, for which a maximum counts.

    std::mutex mutex;  ///< Protects all; nothing is called while it is held.
    std::unique_ptr<Node> first;
    size_t kept = 0;                  ///< In the list.
    uint64_t generation = 0;          ///< Nodes of an older one are not kept.
    size_t inUse = 0;                 ///< Of this generation.
    size_t most = 0, mostBefore = 0;  ///< Of inUse in this window and in the one before.
    int taken = 0;                    ///< In this window.

    std::unique_ptr<Node> take() {
      const std::lock_guard lock(mutex);
      std::unique_ptr<Node> node = std::move(first);
      if (!node) return nullptr;
      first = std::move(node->next);
      --kept;
      return node;
    }

    uint64_t countTaken() {
      const std::lock_guard lock(mutex);
      most = std::max(most, ++inUse);
      if (++taken == kWindow) {
        taken = 0;
        mostBefore = std::exchange(most, inUse);
      }
      return generation;
    }

    /// Takes the node, or leaves it where there are enough.
    void put(std::unique_ptr<Node>& node) {
      const std::lock_guard lock(mutex);
      if (node->generation != generation) return;
      --inUse;
      if (inUse + kept >= std::max(most, mostBefore)) return;
      node->next = std::move(first);
      first = std::move(node);
      ++kept;
    }

    void drop() noexcept {
      std::unique_ptr<Node> dropped;
      {
        const std::lock_guard lock(mutex);
        dropped = std::move(first);
        ++generation;
        kept = inUse = most = mostBefore = 0;
      }
      while (dropped) dropped = std::move(dropped->next);
    }
  };

  /// Results hold the results that they were made from; a shelved one must not keep those alive.
  struct DropSources {
    void operator()(T* used) const noexcept {
      if constexpr (requires { used->dropSources(); }) used->dropSources();
    }
  };

  /// Puts the reference counts beside the object. They are given up last of all, and the node with
  /// them.
  template <class U>
  struct InNode {
    using value_type = U;
    Node* node;

    explicit InNode(Node* taken) : node(taken) {}
    template <class V>
    InNode(const InNode<V>& other) : node(other.node) {}  // NOLINT(google-explicit-constructor)
    [[nodiscard]] U* allocate(size_t) {
      static_assert(sizeof(U) <= sizeof(Node::counts) && alignof(U) <= alignof(std::max_align_t));
      return reinterpret_cast<U*>(node->counts);
    }
    void deallocate(U*, size_t) noexcept {
      std::unique_ptr<Node> used(node);
      if (const auto shelf = used->home.lock()) shelf->put(used);
    }
    friend bool operator==(const InNode& a, const InNode& b) { return a.node == b.node; }
  };

  const std::shared_ptr<Shelf> shelf_;
};

}  // namespace rg
