// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/shown_result.hpp"

namespace rg {
namespace {

constexpr guint kLongestSide = 16384;

}  // namespace

std::optional<objects::Placement> shownPart(GstBuffer* buffer, Size caps, Size madeFor) {
  const GstVideoCropMeta* crop = gst_buffer_get_video_crop_meta(buffer);
  if (!crop || madeFor.isEmpty()) return std::nullopt;
  const GstVideoMeta* video = gst_buffer_get_video_meta(buffer);
  if (crop->x > kLongestSide || crop->y > kLongestSide || crop->width > kLongestSide ||
      crop->height > kLongestSide)
    return std::nullopt;
  if (video && (video->width > kLongestSide || video->height > kLongestSide)) return std::nullopt;
  const Size whole =
      video ? Size{static_cast<int>(video->width), static_cast<int>(video->height)} : madeFor;
  const Box part{static_cast<int>(crop->x), static_cast<int>(crop->y),
                 static_cast<int>(crop->width), static_cast<int>(crop->height)};
  const bool isSound = !part.isEmpty() && intersect(part, boundsOf(whole)) == part &&
                       Size{part.width, part.height} == caps;
  if (!isSound || part == boundsOf(whole)) return std::nullopt;
  return objects::Placement{whole, part};
}

}  // namespace rg
