// SPDX-License-Identifier: LGPL-2.1-or-later
// How a stage's result travels on a buffer: shared by the elements and the library that reads it.
#pragma once

#include "core/objects/objects.hpp"
#include "gst/meta/gstregiongraph.h"

#include <gst/gst.h>

#include <memory>
#include <utility>

// Exported for the elements; not part of the public header, since a meta can only be made by one.
extern "C" {
GST_REGION_API const GstMetaInfo* gst_region_foreground_meta_get_info(void);
GST_REGION_API const GstMetaInfo* gst_region_labels_meta_get_info(void);
GST_REGION_API const GstMetaInfo* gst_region_graph_meta_get_info(void);
GST_REGION_API const GstMetaInfo* gst_region_motion_meta_get_info(void);
GST_REGION_API const GstMetaInfo* gst_region_objects_meta_get_info(void);
}

namespace rg {

/// The meta itself: an immutable result, shared by all buffers that were copied or scaled from the
/// one that it was attached to.
template <class Payload>
struct ResultMeta {
  GstMeta meta;
  std::shared_ptr<const Payload> result;
};

template <class Payload>
const GstMetaInfo* metaInfo();
template <>
inline const GstMetaInfo* metaInfo<background::Foreground>() {
  return gst_region_foreground_meta_get_info();
}
template <>
inline const GstMetaInfo* metaInfo<segmentation::Labels>() {
  return gst_region_labels_meta_get_info();
}
template <>
inline const GstMetaInfo* metaInfo<graph::Graph>() {
  return gst_region_graph_meta_get_info();
}
template <>
inline const GstMetaInfo* metaInfo<motion::Motion>() {
  return gst_region_motion_meta_get_info();
}
template <>
inline const GstMetaInfo* metaInfo<objects::Objects>() {
  return gst_region_objects_meta_get_info();
}

/// So that they are known to buffers that come from elsewhere before anybody has asked for one.
inline void registerMetas() {
  metaInfo<background::Foreground>();
  metaInfo<segmentation::Labels>();
  metaInfo<graph::Graph>();
  metaInfo<motion::Motion>();
  metaInfo<objects::Objects>();
}

/// The result on a buffer, null where there is none.
template <class Payload>
[[nodiscard]] std::shared_ptr<const Payload> findResult(GstBuffer* buffer) {
  const auto* meta =
      reinterpret_cast<ResultMeta<Payload>*>(gst_buffer_get_meta(buffer, metaInfo<Payload>()->api));
  return meta ? meta->result : nullptr;
}

/// Attaches a result in the place of an earlier one of its kind. The buffer must be writable.
template <class Payload>
void attachResult(GstBuffer* buffer, std::shared_ptr<const Payload> result) {
  const GstMetaInfo* info = metaInfo<Payload>();
  auto* meta = reinterpret_cast<ResultMeta<Payload>*>(gst_buffer_get_meta(buffer, info->api));
  if (!meta)
    meta = reinterpret_cast<ResultMeta<Payload>*>(gst_buffer_add_meta(buffer, info, nullptr));
  meta->result = std::move(result);
}

}  // namespace rg
