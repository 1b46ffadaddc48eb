// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/launch_queue.hpp"

#include <algorithm>
#include <cstring>
#include <optional>

namespace rg::gpu {
namespace {

constexpr uint64_t kFnvOffset = 14695981039346656037u, kFnvPrime = 1099511628211u;

uint64_t mixed(uint64_t hash, uint64_t value) {
  return (hash ^ value) * kFnvPrime;
}

}  // namespace

CommandList::Places CommandList::placesOf(const Command& command) const {
  Places places{};
  auto* const first = const_cast<std::byte*>(argumentsOf(command));
  for (size_t i = 0; i < command.argumentCount; ++i) places[i] = first + command.places[i];
  return places;
}

bool CommandList::hasShapeOf(const CommandList& other) const {
  return std::equal(commands_.begin(), commands_.end(), other.commands_.begin(),
                    other.commands_.end(), [](const Command& a, const Command& b) {
                      return a.kind == b.kind && a.kernel == b.kernel && a.bytes == b.bytes;
                    });
}

uint64_t CommandList::hashOfShape() const {
  uint64_t hash = kFnvOffset;
  for (const Command& command : commands_) {
    hash = mixed(hash, static_cast<uint64_t>(command.kind));
    hash = mixed(hash, reinterpret_cast<uintptr_t>(command.kernel));
    hash = mixed(hash, command.bytes);
  }
  return hash;
}

bool CommandList::isSame(const CommandList& other, size_t i) const {
  const Command &a = commands_[i], &b = other.commands_[i];
  const auto sameExtent = [](const Extent& x, const Extent& y) {
    return x.x == y.x && x.y == y.y && x.z == y.z;
  };
  return a.to == b.to && a.from == b.from && sameExtent(a.launch.grid, b.launch.grid) &&
         sameExtent(a.launch.block, b.launch.block) &&
         std::memcmp(argumentsOf(a), other.argumentsOf(b), 8 * wordsOf(a)) == 0;
}

void CommandList::take(const CommandList& other, size_t i) {
  Command& command = commands_[i];
  const size_t first = command.firstWord;
  command = other.commands_[i];
  command.firstWord = first;
  std::memcpy(words_.data() + first, other.argumentsOf(other.commands_[i]), 8 * wordsOf(command));
}

void LaunchQueue::addClear(void* to, size_t bytes) {
  if (bytes == 0) return;
  const std::lock_guard lock(mutex_);
  pending_.addClear(to, bytes);
}

void LaunchQueue::addCopy(void* to, const void* from, size_t bytes) {
  if (bytes == 0) return;
  const std::lock_guard lock(mutex_);
  pending_.addCopy(to, from, bytes);
}

LaunchQueue::Counts LaunchQueue::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

void LaunchQueue::submit() {
  const std::lock_guard lock(mutex_);
  submitPending();
  if (!untold_) return;
  const DeviceError error = *untold_;
  if (!error.isLost()) untold_.reset();
  throw DeviceError(error);
}

void LaunchQueue::submitQuietly() noexcept {
  const std::lock_guard lock(mutex_);
  submitPending();
}

/// What can't be given to the stream is forgotten: the device is lost.
void LaunchQueue::submitPending() {
  if (pending_.size() == 0) return;
  ++submitted_;
  try {
    if (!submitAsGraph()) submitEach();
  } catch (const DeviceError& error) {
    if (!untold_ || error.isLost()) untold_.emplace(error);
  }
  pending_.clear();
}

/// Whether it did.
bool LaunchQueue::submitAsGraph() {
  if (pending_.size() < kLeastInGraph) return false;
  Held* held = findGraph();
  if (held == nullptr && !hasComeBefore()) return false;
  try {
    if (held != nullptr)
      bringUpToDate(*held);
    else
      held = &makeGraph();
    runtime::launch(*held->graph, stream_);
  } catch (const DeviceError& error) {
    std::erase_if(graphs_, [&](const Held& kept) { return &kept == held; });
    if (error.isLost()) throw;
    submitEach();
    throw;
  }
  held->lastUse = submitted_;
  ++counts_.launched;
  counts_.inGraph += pending_.size();
  return true;
}

LaunchQueue::Held* LaunchQueue::findGraph() {
  const auto found = std::find_if(graphs_.begin(), graphs_.end(),
                                  [&](const Held& held) { return held.list.hasShapeOf(pending_); });
  return found == graphs_.end() ? nullptr : &*found;
}

/// To make a graph takes longer than to launch what is in it: it is worth it for what comes again.
bool LaunchQueue::hasComeBefore() {
  const uint64_t hash = pending_.hashOfShape();
  if (std::find(seen_.begin(), seen_.end(), hash) != seen_.end()) return true;
  seen_[nextSeen_] = hash;
  nextSeen_ = (nextSeen_ + 1) % seen_.size();
  return false;
}

LaunchQueue::Held& LaunchQueue::makeGraph() {
  std::unique_ptr<LaunchGraph, End> graph(runtime::makeGraph(pending_));
  const auto oldest =
      std::min_element(graphs_.begin(), graphs_.end(),
                       [](const Held& a, const Held& b) { return a.lastUse < b.lastUse; });
  if (graphs_.size() == kMostGraphs) graphs_.erase(oldest);
  ++counts_.made;
  return graphs_.emplace_back(Held{pending_, submitted_, std::move(graph)});
}

void LaunchQueue::bringUpToDate(Held& held) {
  for (size_t i = 0; i < pending_.size(); ++i) {
    if (held.list.isSame(pending_, i)) continue;
    runtime::update(*held.graph, pending_, i);
    ++counts_.updated;
  }
  held.list = pending_;
}

/// One that fails has changed nothing.
void LaunchQueue::submitEach() {
  std::optional<DeviceError> failed;
  for (size_t i = 0; i < pending_.size(); ++i) {
    try {
      runOnce(i);
    } catch (const DeviceError& error) {
      if (error.isLost()) throw;
      failed = error;
      try {
        runOnce(i);
      } catch (const DeviceError& again) {
        throw DeviceError(DeviceError::Kind::Lost, again.what());
      }
    }
  }
  if (failed) throw DeviceError(*failed);
}

void LaunchQueue::runOnce(size_t index) {
  runtime::run(pending_, index, stream_);
  ++counts_.single;
}

}  // namespace rg::gpu
