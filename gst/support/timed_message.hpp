// SPDX-License-Identifier: LGPL-2.1-or-later
// Element messages that say when the frame is that they tell of.
#pragma once

#include <gst/base/gstbasetransform.h>

namespace rg {

/// Posts in the element's name, with pts, stream-time and running-time added. Takes the structure.
void postTimedMessage(GstBaseTransform* element, GstDebugCategory* category, GstClockTime pts,
                      GstStructure* fields);

}  // namespace rg
