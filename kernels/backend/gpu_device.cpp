// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/gpu_device.hpp"

#include "kernels/runtime.hpp"

#include <utility>

namespace rg::gpu {
namespace {

class GpuMemory final : public DeviceMemory {
 public:
  GpuMemory(std::shared_ptr<Lane> lane, size_t bytes)
      : lane_(std::move(lane)), memory_(runtime::allocate(bytes + kBehind, lane_->stream())) {}
  ~GpuMemory() override { lane_->release(memory_); }
  GpuMemory(const GpuMemory&) = delete;
  GpuMemory& operator=(const GpuMemory&) = delete;

  [[nodiscard]] void* data() const override { return memory_; }
  void upload(const void* from, size_t bytes) override {
    lane_->enter();
    lane_->staging().upload(memory_, from, bytes);
  }
  void download(void* to, size_t bytes) override {
    lane_->enter();
    lane_->staging().download({{to, memory_, bytes}});
  }

 private:
  static constexpr size_t kBehind = 64;  ///< Kernels load whole words (loadQuadAnywhere).

  std::shared_ptr<Lane> lane_;
  void* memory_;
};

}  // namespace

Lane::Lane(int device) : device_(device) {
  enter();
  stream_ = runtime::makeStream();
  queue_ = std::make_unique<LaunchQueue>(stream_);
  staging_ = std::make_unique<Staging>(stream());
}

Lane::~Lane() {
  staging_.reset();
  queue_.reset();
  runtime::endStream(stream_);
}

void Lane::enter() const {
  if (staging_) staging_->expectAlive();
  runtime::choose(device_);
}

void Lane::release(void* memory) const noexcept {
  queue_->submitQuietly();
  runtime::release(memory, stream());
}

Scratch::~Scratch() {
  for (const Block& block : blocks_)
    if (block.memory != nullptr) lane_->release(block.memory);
}

void* Scratch::takeBytes(size_t bytes) {
  if (used_ == blocks_.size()) blocks_.push_back({nullptr, 0});
  Block& block = blocks_[used_];
  if (block.bytes < bytes) {
    if (block.memory != nullptr) lane_->release(block.memory);
    block = {nullptr, 0};
    block = {runtime::allocate(bytes, lane_->stream()), bytes};
  }
  ++used_;
  return block.memory;
}

std::unique_ptr<DeviceMemory> GpuDevice::allocate(size_t bytes) {
  lane_->enter();
  return std::make_unique<GpuMemory>(lane_, bytes);
}

Result<std::shared_ptr<Device>> openDevice(int device, const std::shared_ptr<Device>& neighbour) {
  if (const auto* other = dynamic_cast<GpuDevice*>(neighbour.get()))
    return std::shared_ptr<Device>(std::make_shared<GpuDevice>(other->name(), other->lane()));
  const int count = runtime::countDevices();
  if (count == 0) return Error{"no CUDA device can be used: " + runtime::whyNone()};
  if (device < 0 || device >= count)
    return Error{"there is no CUDA device " + std::to_string(device) + "; device-id must be 0 to " +
                 std::to_string(count - 1)};
  try {
    return std::shared_ptr<Device>(
        std::make_shared<GpuDevice>(runtime::nameOf(device), std::make_shared<Lane>(device)));
  } catch (const DeviceError& error) {
    return Error{"CUDA device " + std::to_string(device) + " can't be used: " + error.what()};
  }
}

}  // namespace rg::gpu
