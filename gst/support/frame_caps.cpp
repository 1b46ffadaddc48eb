// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/filter.hpp"

#define RG_COLOURS                                                              \
  "format=(string){ BGRx, RGBx, BGRA, RGBA, BGR, RGB, NV12, I420, NV21, YUY2, " \
  "UYVY, Y42B, GBR, I420_10LE, P010_10LE "
#define RG_SIZES \
  "width=(int)[1,16384], height=(int)[1,16384], framerate=(fraction)[0/1,2147483647/1]"

namespace rg {

/// Memory of a GPU is mapped as any other; GStreamer 1.22 asserts that none there is grey.
const char* const kPixelCaps = "video/x-raw, " RG_COLOURS ", GRAY8 }, " RG_SIZES
                               "; video/x-raw(memory:CUDAMemory), " RG_COLOURS "}, " RG_SIZES;
const char* const kMetaCaps = "video/x-raw(ANY), " RG_SIZES;

}  // namespace rg
