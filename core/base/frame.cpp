// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/frame.hpp"

#include <string>

namespace rg {

int planeCount(PixelFormat format) {
  switch (format) {
    case PixelFormat::Nv12:
    case PixelFormat::Nv21:
    case PixelFormat::P010:
      return 2;
    case PixelFormat::Gbr:
    case PixelFormat::I420:
    case PixelFormat::Y42b:
    case PixelFormat::I420Ten:
      return 3;
    default:
      return 1;
  }
}

Size planeBytes(PixelFormat format, Size size, int plane) {
  const Size chroma{(size.width + 1) / 2, (size.height + 1) / 2};
  switch (format) {
    case PixelFormat::Bgrx:
    case PixelFormat::Rgbx:
    case PixelFormat::Bgra:
    case PixelFormat::Rgba:
      return {4 * size.width, size.height};
    case PixelFormat::Bgr:
    case PixelFormat::Rgb:
      return {3 * size.width, size.height};
    case PixelFormat::Nv12:
    case PixelFormat::Nv21:
      return plane == 0 ? size : Size{2 * chroma.width, chroma.height};
    case PixelFormat::P010:
      return plane == 0 ? Size{2 * size.width, size.height} : Size{4 * chroma.width, chroma.height};
    case PixelFormat::I420:
      return plane == 0 ? size : chroma;
    case PixelFormat::I420Ten:
      return plane == 0 ? Size{2 * size.width, size.height} : Size{2 * chroma.width, chroma.height};
    case PixelFormat::Y42b:
      return plane == 0 ? size : Size{chroma.width, size.height};
    case PixelFormat::Yuy2:
    case PixelFormat::Uyvy:
      return {4 * chroma.width, size.height};
    case PixelFormat::Gbr:
    case PixelFormat::Gray8:
      return size;
  }
  return {};
}

Result<Frame> Frame::make(const FrameLayout& layout, std::span<const PlaneMemory> planes) {
  if (layout.size.isEmpty()) return Error{"the frame has no pixels"};
  const int count = planeCount(layout.format);
  if (planes.size() < static_cast<size_t>(count))
    return Error{"the frame has " + std::to_string(planes.size()) + " planes, its format has " +
                 std::to_string(count)};
  Frame frame;
  frame.layout_ = layout;
  for (int i = 0; i < count; ++i) {
    const PlaneMemory& memory = planes[static_cast<size_t>(i)];
    const Size need = planeBytes(layout.format, layout.size, i);
    const std::string name = "plane " + std::to_string(i);
    if (memory.data == nullptr) return Error{name + " has no memory"};
    if (memory.strideBytes < need.width)
      return Error{name + " has a stride of " + std::to_string(memory.strideBytes) +
                   " bytes, a row has " + std::to_string(need.width)};
    const uint64_t rows = static_cast<uint64_t>(need.height) - 1;
    const auto stride = static_cast<uint64_t>(memory.strideBytes);
    const auto rowBytes = static_cast<uint64_t>(need.width);
    if (memory.bytes < rowBytes || (rows != 0 && stride > (memory.bytes - rowBytes) / rows))
      return Error{name + " ends before its last row: " + std::to_string(memory.bytes) +
                   " bytes for " + std::to_string(need.height) + " rows of " +
                   std::to_string(stride)};
    frame.planes_[static_cast<size_t>(i)] = {memory.data, need, memory.strideBytes};
  }
  return frame;
}

Frame Frame::ofOneTime() const {
  if (!layout_.isInterlaced) return *this;
  Frame field;
  field.layout_ = layout_;
  field.layout_.isInterlaced = false;
  field.layout_.size.height = (layout_.size.height + 1) / 2;
  for (size_t i = 0; i < planes_.size(); ++i) {
    field.planes_[i] = planes_[i];
    field.planes_[i].size.height = (planes_[i].size.height + 1) / 2;
    field.planes_[i].strideBytes *= 2;
  }
  return field;
}

}  // namespace rg
