// SPDX-License-Identifier: LGPL-2.1-or-later
// Results for readers of frames of which a GstVideoCropMeta shows a part. videocrop leaves frames
// and metas as they are and attaches one, wherever downstream takes it.
#pragma once

#include "gst/meta/result_meta.hpp"

#include <gst/video/video.h>

#include <memory>
#include <optional>

namespace rg {

/// The part that is shown of a frame; none where that is all of it, or where the meta contradicts
/// the caps' size or its own memory's.
[[nodiscard]] std::optional<objects::Placement> shownPart(GstBuffer* buffer, Size caps,
                                                          Size madeFor);

/// A result as of the part that is shown. Null for null.
template <class Payload>
[[nodiscard]] std::shared_ptr<const Payload> asShown(GstBuffer* buffer, Size caps,
                                                     std::shared_ptr<const Payload> result) {
  const auto part = result ? shownPart(buffer, caps, result->size) : std::nullopt;
  return part ? objects::place(result, *part) : result;
}

/// The result on a buffer, as of the part that is shown; null where there is none.
template <class Payload>
[[nodiscard]] std::shared_ptr<const Payload> findShown(GstBuffer* buffer, Size caps) {
  return asShown(buffer, caps, findResult<Payload>(buffer));
}

}  // namespace rg
