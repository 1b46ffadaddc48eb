// SPDX-License-Identifier: LGPL-2.1-or-later
// A GPU as core's stages see it (core/base/memory/device.hpp): a stream of its own, memory, and the
// rooms' operations.
#pragma once

#include "core/base/memory/device.hpp"
#include "core/base/memory/frame_reader.hpp"
#include "kernels/backend/open_device.hpp"
#include "kernels/backend/rooms.hpp"
#include "kernels/backend/staging.hpp"
#include "kernels/launch_queue.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rg::gpu {

/// A stream of one device; what was made of it keeps it. Devices that share it see each other's
/// memory: what one is asked comes behind what the others were asked before.
class Lane {
 public:
  /// Throws DeviceError.
  explicit Lane(int device);
  ~Lane();
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;
  [[nodiscard]] Stream stream() const { return {stream_, queue_.get()}; }
  [[nodiscard]] const LaunchQueue& queue() const { return *queue_; }
  /// CUDA's calls go to the device that the calling thread has chosen last.
  /// Throws DeviceError, also where the device hangs.
  void enter() const;
  /// From any thread.
  void release(void* memory) const noexcept;
  /// Copies; after enter().
  [[nodiscard]] Staging& staging() { return *staging_; }

 private:
  int device_;
  CUstream_st* stream_ = nullptr;
  std::unique_ptr<LaunchQueue> queue_;
  std::unique_ptr<Staging> staging_;
};

/// Memory for the scratch of one operation at a time; what follows in the stream comes later and
/// may use it again.
class Scratch {
 public:
  explicit Scratch(std::shared_ptr<Lane> lane) : lane_(std::move(lane)) {}
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  /// Another operation begins.
  void begin() { used_ = 0; }
  /// Contents undefined. Throws DeviceError.
  template <class T>
  [[nodiscard]] T* take(int64_t count) {
    return static_cast<T*>(takeBytes(static_cast<size_t>(count) * sizeof(T)));
  }

 private:
  struct Block {
    void* memory;
    size_t bytes;
  };
  void* takeBytes(size_t bytes);

  std::shared_ptr<Lane> lane_;
  std::vector<Block> blocks_;  ///< One for each that an operation takes.
  size_t used_ = 0;
};

/// Serves one stage, on one thread at a time.
class GpuDevice final : public Device, public AllRooms, public FrameReader {
 public:
  GpuDevice(std::string name, std::shared_ptr<Lane> lane)
      : name_(std::move(name)), lane_(std::move(lane)), scratch_(lane_) {}

  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] const void* space() const override { return lane_.get(); }
  [[nodiscard]] std::unique_ptr<DeviceMemory> allocate(size_t bytes) override;
  void load(const Frame& there, Picture& picture) override;

  [[nodiscard]] const std::shared_ptr<Lane>& lane() const { return lane_; }
  [[nodiscard]] Scratch& scratch() { return scratch_; }

 private:
  std::string name_;
  std::shared_ptr<Lane> lane_;
  Scratch scratch_;
};

template <class Operations>
void RoomSource<Operations>::make(const Executor& executor,
                                  std::unique_ptr<Operations>& operations) {
  operations = operationsOn<Operations>(dynamic_cast<GpuDevice&>(*this), executor);
}

}  // namespace rg::gpu
