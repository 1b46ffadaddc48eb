// SPDX-License-Identifier: LGPL-2.1-or-later
// Why the results of an element are not on the frames that arrive at another one.
#pragma once

#include <gst/gst.h>

#include <string>

namespace rg {

/// Says of a type which of the plugin's elements it is; `name` must live for ever.
void nameType(GType type, const char* name);

/// What is wrong and what to do, for an element that gets no result of `producer`: that is not in
/// the pipeline before it, or something between the two made new frames without metas.
[[nodiscard]] std::string whyMissing(GstElement* element, const char* producer);

}  // namespace rg
