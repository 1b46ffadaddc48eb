// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/gpu_device.hpp"
#include "kernels/picture.hpp"
#include "kernels/runtime.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

namespace rg::gpu {
namespace {

size_t bytesOf(ImageView<const uint8_t> plane) {
  return static_cast<size_t>(plane.strideBytes) * static_cast<size_t>(plane.height() - 1) +
         static_cast<size_t>(plane.width());
}

}  // namespace

/// Kernels read a copy: what another context has allocated can be copied, however it was allocated.
void GpuDevice::load(const Frame& there, Picture& picture) {
  lane_->enter();
  scratch_.begin();
  const Stream stream = lane_->stream();
  submit(stream);
  const FrameLayout& layout = there.layout();
  const auto count = static_cast<size_t>(planeCount(layout.format));
  std::array<PlaneMemory, Frame::kMaxPlanes> copies;
  for (size_t i = 0; i < count; ++i) {
    const ImageView<const uint8_t> plane = there.plane(static_cast<int>(i));
    const size_t bytes = bytesOf(plane);
    auto* copied = scratch_.take<uint8_t>(static_cast<int64_t>(bytes));
    runtime::bring(copied, plane.data, bytes, stream);
    copies[i] = {copied, bytes, plane.strideBytes};
  }
  const Result<Frame> frame = Frame::make(layout, std::span(copies).first(count));
  if (!frame) throw std::logic_error("a frame's copy differs from it: " + frame.error().message);
  const bool isGrey = layout.format == PixelFormat::Gray8;
  loadPlanes(*frame, picture.writeOn(*this, there.size(), isGrey), stream);
  picture.readOnHost();
}

}  // namespace rg::gpu
