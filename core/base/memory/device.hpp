// SPDX-License-Identifier: LGPL-2.1-or-later
// A processor other than the CPU that does a stage's work on pixels, and memory that it shares with
// the host by copies. Core knows no such processor; kernels/ does.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

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

/// An image's memory on a device, and which of the two is the newer one. One thread at a time.
class DeviceTwin {
 public:
  DeviceTwin(Device& device, size_t bytes) : memory_(device.allocate(bytes)), bytes_(bytes) {}

  [[nodiscard]] bool isOnHost() const { return newest_ != Newest::Device; }
  [[nodiscard]] bool isOnHostOnly() const { return newest_ == Newest::Host; }

  void readOnHost(void* host) {
    if (isOnHost()) return;
    memory_->download(host, bytes_);
    newest_ = Newest::Both;
  }
  void changeOnHost(void* host) {
    readOnHost(host);
    newest_ = Newest::Host;
  }
  void writeOnHost() { newest_ = Newest::Host; }

  const void* read(const void* host) {
    if (isOnHostOnly()) {
      memory_->upload(host, bytes_);
      newest_ = Newest::Both;
    }
    return memory_->data();
  }
  void* change(const void* host) {
    (void)read(host);
    return write();
  }
  void* write() {
    newest_ = Newest::Device;
    return memory_->data();
  }

 private:
  enum class Newest : unsigned char { Host, Device, Both };

  std::unique_ptr<DeviceMemory> memory_;
  size_t bytes_;
  Newest newest_ = Newest::Host;
};

}  // namespace rg
