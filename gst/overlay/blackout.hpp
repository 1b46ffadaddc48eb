// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes everything black that does not move.
#pragma once

#include "core/background/background.hpp"
#include "core/base/memory/image.hpp"
#include "core/objects/objects.hpp"

#include <gst/video/video.h>

namespace rg::overlay {

/// Writes 1 where something is to be kept and 0 elsewhere: the pixels of listed objects, or the
/// foreground. `keep` has the size of the frame; results of another size are scaled.
void markObjects(const objects::Objects& objects, Image<uint8_t>& keep);
void markForeground(const background::Foreground& foreground, Image<uint8_t>& keep);

/// Blackens the pixels where `keep` is 0. Alpha stays; a chroma sample goes when all of its pixels
/// do. The frame's format is one that the stages read.
void blacken(GstVideoFrame* frame, const Image<uint8_t>& keep);

}  // namespace rg::overlay
