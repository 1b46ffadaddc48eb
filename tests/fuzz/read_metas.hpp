// SPDX-License-Identifier: LGPL-2.1-or-later
// What an application does with a buffer: it reads everything there is.
#pragma once

#include "tests/fuzz/bytes.hpp"

#include <gst/gst.h>

namespace rg::fuzz {

/// Reads all metas of the plugin and the regions of interest through the public interface, and ends
/// the process where what they say does not fit together.
void readMetas(GstBuffer* buffer);

/// Puts regions of interest on a buffer as a careless element upstream might.
void addRandomRois(GstBuffer* buffer, Bytes& bytes);

}  // namespace rg::fuzz
