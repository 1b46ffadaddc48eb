// SPDX-License-Identifier: LGPL-2.1-or-later
// Copies between the host's memory and a device's, by way of page-locked memory: from and to other
// memory the driver's copies wait for the device themselves, for as long as that takes, and what
// hangs would hang the caller.
#pragma once

#include "kernels/launch_queue.hpp"
#include "kernels/runtime.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <mutex>

namespace rg::gpu {

/// No frame's work takes a thousandth of it, not even where 64 streams share a device or a checker
/// slows each access down; a watchdog of the driver's, where there is one, ends what hangs before.
inline constexpr int64_t kHangNs = 10'000'000'000;

/// Serves one stream; its calls may come from several threads. They throw DeviceError, and say that
/// the device is lost when it has not come to the end of what it was given after kHangNs; from then
/// on at once.
class Staging {
 public:
  explicit Staging(Stream stream) : stream_(stream) {}
  ~Staging();
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  /// `from` may change as soon as it returns.
  void upload(void* to, const void* from, size_t bytes);
  struct Download {
    void* to;
    const void* from;
    size_t bytes;  ///< 0: nothing is done.
  };
  /// Waits for what the stream was given before, once for all of up to kMostTogether.
  void download(std::initializer_list<Download> copies);
  static constexpr size_t kMostTogether = 4;
  /// Throws where the device hangs.
  void expectAlive() const;

 private:
  /// Memory that a copy uses until its event has come.
  struct Block {
    void* memory = nullptr;
    size_t bytes = 0;
    Event copied = nullptr;
    enum class Use : unsigned char { None, Taken, Copied } use = Use::None;
  };
  static constexpr int kMostOfSize = 8;  ///< Copies on the way of one size; more wait.

  Block& take(size_t bytes);
  Block* findFree(size_t bytes, int& onTheWay);
  Block& make(size_t bytes);
  void waitFor(Block& block);
  void goOn(int64_t waitedNs);
  void give(Block& block, Block::Use use);

  const Stream stream_;
  std::atomic<bool> hangs_ = false;
  std::mutex mutex_;          ///< Protects the rest; nobody copies or waits for a copy with it.
  std::deque<Block> blocks_;  ///< Stay where they are.
};

}  // namespace rg::gpu
