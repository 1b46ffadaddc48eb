// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/capture_time.hpp"

namespace rg {
namespace {

constexpr uint64_t kNtpEpochNs = 2'208'988'800 * GST_SECOND;  // 1970 in NTP time, from 1900.

}  // namespace

std::optional<uint64_t> captureTimeOf(GstBuffer* buffer) {
  gpointer state = nullptr;
  while (GstMeta* found = gst_buffer_iterate_meta_filtered(buffer, &state,
                                                           GST_REFERENCE_TIMESTAMP_META_API_TYPE)) {
    const auto* meta = reinterpret_cast<GstReferenceTimestampMeta*>(found);
    if (!meta->reference || gst_caps_get_size(meta->reference) == 0) continue;
    const GstStructure* reference = gst_caps_get_structure(meta->reference, 0);
    if (gst_structure_has_name(reference, "timestamp/x-unix")) return meta->timestamp;
    if (gst_structure_has_name(reference, "timestamp/x-ntp") && meta->timestamp >= kNtpEpochNs)
      return meta->timestamp - kNtpEpochNs;
  }
  return std::nullopt;
}

}  // namespace rg
