// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/precompiled/standard.hpp"

#include <gst/base/gstbasetransform.h>
#include <gst/gst.h>
#include <gst/video/video.h>
