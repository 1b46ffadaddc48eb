// SPDX-License-Identifier: LGPL-2.1-or-later
// Launches that a stream is given together: what has come before in the same order, with other
// arguments or not, as a graph.
//
// Nothing is captured: a graph is made of what was written down, so that no stream is in a state in
// which the calls of another thread fail, and whoever decides from frame to frame what is launched
// needs to know nothing of graphs.
#pragma once

#include "core/base/memory/device.hpp"
#include "kernels/command_list.hpp"
#include "kernels/launch_graph.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>

namespace rg::gpu {

/// Serves one stream; its calls may come from several threads.
class LaunchQueue {
 public:
  /// Fewer are launched one by one.
  static constexpr size_t kLeastInGraph = 4;
  /// Sequences that have a graph: some for each stage of a pipeline and each of its ways through a
  /// frame. What was used longest ago gives way.
  static constexpr size_t kMostGraphs = 32;

  explicit LaunchQueue(CUstream_st* stream) : stream_(stream) {}
  LaunchQueue(const LaunchQueue&) = delete;
  LaunchQueue& operator=(const LaunchQueue&) = delete;

  template <class... Arguments>
  void addKernel(const Launch& launch, const void* kernel, Command::HostCall hostCall,
                 const Arguments&... arguments) {
    const std::lock_guard lock(mutex_);
    pending_.addKernel(launch, kernel, hostCall, arguments...);
  }
  void addClear(void* to, size_t bytes);
  void addCopy(void* to, const void* from, size_t bytes);

  /// Gives the stream all that was added. A call that fails is done without a graph, or once more;
  /// throws DeviceError then, after all the others. The device is lost where that fails, too.
  void submit();
  /// The same, of whose failure the next submit() tells.
  void submitQuietly() noexcept;

  /// Since it was made.
  struct Counts {
    uint64_t single = 0;                           ///< Commands that were launched one by one.
    uint64_t inGraph = 0;                          ///< The others.
    uint64_t made = 0, updated = 0, launched = 0;  ///< Graphs; commands of graphs; graphs.
  };
  [[nodiscard]] Counts counts() const;

 private:
  struct End {
    void operator()(LaunchGraph* graph) const noexcept { runtime::endGraph(graph); }
  };
  struct Held {
    CommandList list;  ///< What it does.
    uint64_t lastUse = 0;
    std::unique_ptr<LaunchGraph, End> graph;
  };

  void submitPending();
  bool submitAsGraph();
  Held* findGraph();
  Held& makeGraph();
  bool hasComeBefore();
  void bringUpToDate(Held& held);
  void submitEach();
  void runOnce(size_t index);

  CUstream_st* const stream_;
  mutable std::mutex mutex_;  ///< Protects the rest; the stream is given commands with it.
  CommandList pending_;
  std::deque<Held> graphs_;
  std::array<uint64_t, 2 * kMostGraphs> seen_{};  ///< Hashes of the latest that had no graph.
  size_t nextSeen_ = 0;
  uint64_t submitted_ = 0;
  std::optional<DeviceError> untold_;  ///< For ever, once the device is lost.
  Counts counts_;
};

/// What the stream's queue holds, if it has one.
inline void submit(Stream stream) {
  if (stream.queue != nullptr) stream.queue->submit();
}

}  // namespace rg::gpu
