// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/stream_clock.hpp"

#include "core/base/time/time.hpp"

namespace rg {
namespace {

constexpr int64_t kGapNs = GST_SECOND;

}  // namespace

void StreamClock::setFramerate(int numerator, int denominator) {
  frameNs_ =
      numerator > 0 && denominator > 0
          ? static_cast<int64_t>(gst_util_uint64_scale(
                GST_SECOND, static_cast<guint64>(denominator), static_cast<guint64>(numerator)))
          : 0;
}

Tick StreamClock::advance(GstBuffer* buffer) {
  const GstClockTime pts = GST_BUFFER_PTS(buffer);
  const bool hasPts = GST_CLOCK_TIME_IS_VALID(pts) && pts <= G_MAXINT64;
  Tick tick;
  tick.time.isKnown = hasPts || frameNs_ > 0;
  if (hasPts)
    tick.time.ns = static_cast<int64_t>(pts);
  else if (last_)
    tick.time.ns = addTimes(*last_, frameNs_ > 0 ? frameNs_ : kNominalStepNs);
  if (last_) {
    if (tick.time.ns < *last_)
      tick.reset = Reset::Flush;
    else if (GST_BUFFER_IS_DISCONT(buffer) ||
             (hasPts && timeBetween(*last_, tick.time.ns) > kGapNs))
      tick.reset = Reset::Gap;
  }
  last_ = tick.time.ns;
  return tick;
}

}  // namespace rg
