// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/mapped_frame.hpp"

#include "gst/support/foreign_enum.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace rg {
namespace {

std::optional<PixelFormat> formatOf(GstVideoFormat format) {
  switch (format) {
    case GST_VIDEO_FORMAT_BGRx:
      return PixelFormat::Bgrx;
    case GST_VIDEO_FORMAT_RGBx:
      return PixelFormat::Rgbx;
    case GST_VIDEO_FORMAT_BGRA:
      return PixelFormat::Bgra;
    case GST_VIDEO_FORMAT_RGBA:
      return PixelFormat::Rgba;
    case GST_VIDEO_FORMAT_BGR:
      return PixelFormat::Bgr;
    case GST_VIDEO_FORMAT_RGB:
      return PixelFormat::Rgb;
    case GST_VIDEO_FORMAT_GBR:
      return PixelFormat::Gbr;
    case GST_VIDEO_FORMAT_NV12:
      return PixelFormat::Nv12;
    case GST_VIDEO_FORMAT_NV21:
      return PixelFormat::Nv21;
    case GST_VIDEO_FORMAT_I420:
      return PixelFormat::I420;
    case GST_VIDEO_FORMAT_Y42B:
      return PixelFormat::Y42b;
    case GST_VIDEO_FORMAT_YUY2:
      return PixelFormat::Yuy2;
    case GST_VIDEO_FORMAT_UYVY:
      return PixelFormat::Uyvy;
    case GST_VIDEO_FORMAT_I420_10LE:
      return PixelFormat::I420Ten;
    case GST_VIDEO_FORMAT_P010_10LE:
      return PixelFormat::P010;
    case GST_VIDEO_FORMAT_GRAY8:
      return PixelFormat::Gray8;
    default:
      return std::nullopt;
  }
}

YuvMatrix matrixOf(int matrix) {
  switch (matrix) {
    case GST_VIDEO_COLOR_MATRIX_BT709:
      return YuvMatrix::Bt709;
    case GST_VIDEO_COLOR_MATRIX_BT2020:
      return YuvMatrix::Bt2020;
    case GST_VIDEO_COLOR_MATRIX_SMPTE240M:
      return YuvMatrix::Smpte240m;
    case GST_VIDEO_COLOR_MATRIX_FCC:
      return YuvMatrix::Fcc;
    default:
      return YuvMatrix::Bt601;
  }
}

}  // namespace

std::optional<FrameLayout> layoutOf(const GstVideoInfo& info) {
  const auto format = formatOf(GST_VIDEO_INFO_FORMAT(&info));
  if (!format) return std::nullopt;
  const auto range = numberIn(info.colorimetry.range) == GST_VIDEO_COLOR_RANGE_0_255
                         ? YuvRange::Full
                         : YuvRange::Limited;
  return FrameLayout{*format,
                     {GST_VIDEO_INFO_WIDTH(&info), GST_VIDEO_INFO_HEIGHT(&info)},
                     matrixOf(numberIn(info.colorimetry.matrix)),
                     range,
                     GST_VIDEO_INFO_IS_INTERLACED(&info) != FALSE};
}

MappedFrame::MappedFrame(GstBuffer* buffer, const GstVideoInfo& info, guint flags)
    : buffer_(buffer), flags_(flags), frame_(check(info)) {}

MappedFrame::~MappedFrame() {
  for (size_t i = 0; i < mapCount_; ++i) gst_buffer_unmap(buffer_, &maps_[i]);
}

/// Maps the memories from one on; false where they can't be.
bool MappedFrame::map(guint first, int count) {
  const auto flags = static_cast<GstMapFlags>(flags_);
  const bool isMapped =
      gst_buffer_map_range(buffer_, first, count, &maps_[mapCount_], flags) != FALSE;
  if (isMapped) ++mapCount_;
  return isMapped;
}

/// What may be read from a plane's first byte on. Cameras and decoders give each plane a memory of
/// its own, which is mapped alone: to map them as one would copy them.
Result<PlaneMemory> MappedFrame::find(uint64_t offset, int64_t strideBytes, Size bytes) {
  const Error unreadable{"the buffer's memory can't be mapped for reading"};
  const Error endsEarly{"a plane starts or ends behind the end of the buffer, which has " +
                        std::to_string(gst_buffer_get_size(buffer_)) + " bytes"};
  if (gst_buffer_n_memory(buffer_) <= 1) {
    if (mapCount_ == 0 && !map(0, -1)) return unreadable;
    if (offset >= maps_[0].size) return endsEarly;
    return PlaneMemory{maps_[0].data + offset, maps_[0].size - offset, strideBytes};
  }
  const auto rows = static_cast<uint64_t>(bytes.height - 1);
  const auto stride = static_cast<uint64_t>(std::max<int64_t>(strideBytes, 0));
  const uint64_t need = rows * stride + static_cast<uint64_t>(bytes.width);
  guint first = 0, count = 0;
  gsize skip = 0;
  if (offset > gst_buffer_get_size(buffer_) ||
      !gst_buffer_find_memory(buffer_, offset, need, &first, &count, &skip))
    return endsEarly;
  if (!map(first, static_cast<int>(count))) return unreadable;
  const GstMapInfo& mapped = maps_[mapCount_ - 1];
  return PlaneMemory{mapped.data + skip, mapped.size - skip, strideBytes};
}

Result<Frame> MappedFrame::check(const GstVideoInfo& info) {
  const auto layout = layoutOf(info);
  if (!layout) return Error{"the caps' format is not supported"};
  const GstVideoMeta* meta = gst_buffer_get_video_meta(buffer_);
  const auto count = static_cast<size_t>(planeCount(layout->format));
  if (meta && (numberIn(meta->format) != GST_VIDEO_INFO_FORMAT(&info) || meta->n_planes != count ||
               meta->width != static_cast<guint>(layout->size.width) ||
               meta->height != static_cast<guint>(layout->size.height)))
    return Error{"the buffer's GstVideoMeta says " + std::to_string(meta->width) + "x" +
                 std::to_string(meta->height) + " of format " +
                 std::to_string(numberIn(meta->format)) + " in " + std::to_string(meta->n_planes) +
                 " planes, the caps say otherwise"};
  std::array<PlaneMemory, Frame::kMaxPlanes> planes;
  for (size_t i = 0; i < count; ++i) {
    const auto plane =
        find(meta ? meta->offset[i] : info.offset[i], meta ? meta->stride[i] : info.stride[i],
             planeBytes(layout->format, layout->size, static_cast<int>(i)));
    if (!plane) return plane.error();
    planes[i] = *plane;
  }
  return Frame::make(*layout, std::span(planes).first(count));
}

}  // namespace rg
