// SPDX-License-Identifier: LGPL-2.1-or-later
// A processor other than the CPU that does a stage's work on pixels, and memory that it shares with
// the host by copies. Core knows no such processor; kernels/ does.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace rg {

/// A call of a device that failed.
class DeviceError : public std::runtime_error {
 public:
  enum class Kind : unsigned char {
    Failed,  ///< This call only, out of memory for instance. What the device holds can be fetched.
    Lost,    ///< The device, and all that it held.
  };
  DeviceError(Kind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
  [[nodiscard]] bool isLost() const { return kind_ == Kind::Lost; }

 private:
  Kind kind_;
};

/// Memory of a device. Copies come in the order of the device's work.
class DeviceMemory {
 public:
  virtual ~DeviceMemory() = default;
  [[nodiscard]] virtual void* data() const = 0;
  /// Throws DeviceError.
  virtual void upload(const void* from, size_t bytes) = 0;
  /// Waits for all that was asked of the device before. Throws DeviceError.
  virtual void download(void* to, size_t bytes) = 0;
};

/// A stage asks it for the operations of its room (core/background/operations.hpp).
class Device {
 public:
  virtual ~Device() = default;
  /// What messages call it.
  [[nodiscard]] virtual std::string name() const = 0;
  /// Devices of one space see each other's memory, in the order in which they are asked.
  [[nodiscard]] virtual const void* space() const = 0;
  /// All bytes are 0. Throws DeviceError.
  [[nodiscard]] virtual std::unique_ptr<DeviceMemory> allocate(size_t bytes) = 0;

  /// Whether it is asked at all: until its first error.
  [[nodiscard]] bool isUp() const { return !error_; }
  /// Its first error.
  [[nodiscard]] const DeviceError* error() const { return error_.get(); }
  /// A device that fails and is then lost is lost.
  void fail(const DeviceError& error) {
    if (!error_ || error.isLost()) error_ = std::make_unique<DeviceError>(error);
  }

 private:
  std::unique_ptr<DeviceError> error_;
};

/// An image's memory on devices, and where its newest pixels are. Results are read by several
/// stages at once, each on a thread and perhaps on a device of its own: all calls may come
/// together, but for those that change the image.
class DeviceCopies {
 public:
  explicit DeviceCopies(size_t bytes) : bytes_(bytes) {}

  [[nodiscard]] bool isOnHost() const {
    const std::lock_guard lock(mutex_);
    return isOnHost_;
  }
  [[nodiscard]] bool isOnHostOnly() const {
    const std::lock_guard lock(mutex_);
    return isOnHost_ && newest() == nullptr;
  }

  void readOnHost(void* host) {
    const std::lock_guard lock(mutex_);
    bringToHost(host);
  }
  void changeOnHost(void* host) {
    const std::lock_guard lock(mutex_);
    bringToHost(host);
    makeOld();
  }
  void writeOnHost() {
    const std::lock_guard lock(mutex_);
    isOnHost_ = true;
    makeOld();
  }

  const void* read(Device& device, void* host) {
    const std::lock_guard lock(mutex_);
    return bringTo(device, host).memory->data();
  }
  void* change(Device& device, void* host) {
    const std::lock_guard lock(mutex_);
    return keepOnly(bringTo(device, host));
  }
  void* write(Device& device) {
    const std::lock_guard lock(mutex_);
    return keepOnly(copyOn(device));
  }

 private:
  struct Copy {
    const void* space;
    std::unique_ptr<DeviceMemory> memory;
    bool isNewest;
  };

  [[nodiscard]] const Copy* newest() const {
    for (const Copy& copy : copies_)
      if (copy.isNewest) return &copy;
    return nullptr;
  }
  void bringToHost(void* host) {
    if (isOnHost_) return;
    newest()->memory->download(host, bytes_);
    isOnHost_ = true;
  }
  Copy& copyOn(Device& device) {
    for (Copy& copy : copies_)
      if (copy.space == device.space()) return copy;
    copies_.reserve(copies_.size() + 1);
    return copies_.emplace_back(Copy{device.space(), device.allocate(bytes_), false});
  }
  /// From one device to another the pixels go by way of the host.
  Copy& bringTo(Device& device, void* host) {
    Copy& copy = copyOn(device);
    if (copy.isNewest) return copy;
    bringToHost(host);
    copy.memory->upload(host, bytes_);
    copy.isNewest = true;
    return copy;
  }
  void makeOld() {
    for (Copy& copy : copies_) copy.isNewest = false;
  }
  void* keepOnly(Copy& copy) {
    isOnHost_ = false;
    makeOld();
    copy.isNewest = true;
    return copy.memory->data();
  }

  mutable std::mutex mutex_;
  size_t bytes_;
  bool isOnHost_ = true;
  std::vector<Copy> copies_;  ///< One for each space.
};

/// Made when the first device asks; readers of one image may be the first together.
class LazyCopies {
 public:
  LazyCopies() = default;
  ~LazyCopies() { drop(); }
  LazyCopies(const LazyCopies&) = delete;
  LazyCopies& operator=(const LazyCopies&) = delete;

  explicit operator bool() const { return there() != nullptr; }
  DeviceCopies* operator->() const { return there(); }
  DeviceCopies& get(size_t bytes) {
    if (DeviceCopies* made = there()) return *made;
    auto fresh = std::make_unique<DeviceCopies>(bytes);
    DeviceCopies* other = nullptr;
    if (!copies_.compare_exchange_strong(other, fresh.get(), std::memory_order_acq_rel))
      return *other;
    return *fresh.release();
  }
  void drop() noexcept { delete copies_.exchange(nullptr); }
  /// Nobody else may look at either.
  void swap(LazyCopies& other) noexcept { copies_.store(other.copies_.exchange(copies_.load())); }

 private:
  [[nodiscard]] DeviceCopies* there() const { return copies_.load(std::memory_order_acquire); }
  std::atomic<DeviceCopies*> copies_ = nullptr;
};

}  // namespace rg
