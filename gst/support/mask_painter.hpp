// SPDX-License-Identifier: LGPL-2.1-or-later
// Results as grey pictures.
#pragma once

#include <gst/video/video.h>

namespace rg {

enum class MaskSource : int { Foreground, Labels, Objects, Hue };

/// The element whose result the source shows.
[[nodiscard]] const char* producerOf(MaskSource source);

/// Gives caps the formats that the source is shown in: GRAY8, for labels GRAY16_BE or GRAY16_LE.
void setFormats(GstStructure* caps, MaskSource source);

/// Writes every pixel of `to`, whose format is one of setFormats(), and zeros behind rows that are
/// padded to 4 bytes. A result made for another size
/// is scaled to the nearest pixel, a skipped one is black, and so is a missing one. Returns whether
/// there was a result on the buffer.
bool paintMask(MaskSource source, GstBuffer* from, GstVideoFrame* to);

}  // namespace rg
