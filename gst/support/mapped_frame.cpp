// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/mapped_frame.hpp"

#include "gst/support/foreign_enum.hpp"

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
    case GST_VIDEO_FORMAT_NV12:
      return PixelFormat::Nv12;
    case GST_VIDEO_FORMAT_I420:
      return PixelFormat::I420;
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
                     range};
}

MappedFrame::MappedFrame(GstBuffer* buffer, const GstVideoInfo& info)
    : buffer_(buffer),
      map_{},
      isMapped_(gst_buffer_map(buffer, &map_, GST_MAP_READ) != FALSE),
      frame_(check(info)) {}

MappedFrame::~MappedFrame() {
  if (isMapped_) gst_buffer_unmap(buffer_, &map_);
}

Result<Frame> MappedFrame::check(const GstVideoInfo& info) const {
  if (!isMapped_) return Error{"the buffer's memory can't be mapped for reading"};
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
    const gsize offset = meta ? meta->offset[i] : info.offset[i];
    if (offset >= map_.size)
      return Error{"plane " + std::to_string(i) +
                   " starts behind the end of the buffer, which has " + std::to_string(map_.size) +
                   " bytes"};
    planes[i] = {map_.data + offset, map_.size - offset, meta ? meta->stride[i] : info.stride[i]};
  }
  return Frame::make(*layout, std::span(planes).first(count));
}

}  // namespace rg
