// SPDX-License-Identifier: LGPL-2.1-or-later
// Registration of the five metas, and what happens to them when buffers are copied or scaled.
#include "gst/meta/result_meta.hpp"

#include <gst/video/gstvideometa.h>

#include <new>

namespace rg {
namespace {

template <class Payload>
gboolean initMeta(GstMeta* meta, gpointer, GstBuffer*) {
  new (&reinterpret_cast<ResultMeta<Payload>*>(meta)->result) std::shared_ptr<const Payload>();
  return TRUE;
}

template <class Payload>
void freeMeta(GstMeta* meta, GstBuffer*) {
  using Pointer = std::shared_ptr<const Payload>;
  reinterpret_cast<ResultMeta<Payload>*>(meta)->result.~Pointer();
}

/// A copy of the whole frame and a scaled frame share the result, which tells the size that it was
/// made for. Anything else would put it in the wrong place, so it is dropped.
template <class Payload>
gboolean transformMeta(GstBuffer* to, GstMeta* meta, GstBuffer*, GQuark type, gpointer data) {
  const bool isWholeCopy =
      GST_META_TRANSFORM_IS_COPY(type) && !static_cast<GstMetaTransformCopy*>(data)->region;
  if (!isWholeCopy && !GST_VIDEO_META_TRANSFORM_IS_SCALE(type)) return FALSE;
  attachResult(to, reinterpret_cast<ResultMeta<Payload>*>(meta)->result);
  return TRUE;
}

GType registerApi(const char* name) {
  static const gchar* tags[] = {GST_META_TAG_VIDEO_STR, GST_META_TAG_VIDEO_SIZE_STR,
                                GST_META_TAG_VIDEO_ORIENTATION_STR, nullptr};
  return gst_meta_api_type_register(name, tags);
}

template <class Payload>
const GstMetaInfo* registerInfo(GType api, const char* name) {
  return gst_meta_register(api, name, sizeof(ResultMeta<Payload>), initMeta<Payload>,
                           freeMeta<Payload>, transformMeta<Payload>);
}

}  // namespace
}  // namespace rg

#define RG_DEFINE_META(lower, room, Payload)                                          \
  GType gst_region_##lower##_meta_api_get_type(void) {                                \
    static const GType type = rg::registerApi("GstRegion" #Payload "MetaAPI");        \
    return type;                                                                      \
  }                                                                                   \
  const GstMetaInfo* gst_region_##lower##_meta_get_info(void) {                       \
    static const GstMetaInfo* const info = rg::registerInfo<rg::room::Payload>(       \
        gst_region_##lower##_meta_api_get_type(), "GstRegion" #Payload "Meta");       \
    return info;                                                                      \
  }                                                                                   \
  GstRegion##Payload##Meta* gst_buffer_get_region_##lower##_meta(GstBuffer* buffer) { \
    g_return_val_if_fail(GST_IS_BUFFER(buffer), nullptr);                             \
    return reinterpret_cast<GstRegion##Payload##Meta*>(                               \
        gst_buffer_get_meta(buffer, gst_region_##lower##_meta_api_get_type()));       \
  }

RG_DEFINE_META(foreground, background, Foreground)
RG_DEFINE_META(labels, segmentation, Labels)
RG_DEFINE_META(graph, graph, Graph)
RG_DEFINE_META(motion, motion, Motion)
RG_DEFINE_META(objects, objects, Objects)
