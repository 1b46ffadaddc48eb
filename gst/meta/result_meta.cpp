// SPDX-License-Identifier: LGPL-2.1-or-later
// Registration of the five metas, and what happens to them when buffers are copied, scaled or sent
// elsewhere.
#include "gst/meta/result_meta.hpp"

#include "gst/meta/stored_result.hpp"

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

#if GST_CHECK_VERSION(1, 28, 0)
/// Crops, flips, and frames that were drawn into others: what stays in view follows.
template <class Payload>
gboolean placeMeta(GstBuffer* to, GstMeta* meta, const GstVideoMetaTransformMatrix& drawn) {
  const auto sizeOf = [](const GstVideoInfo* info) {
    return Size{GST_VIDEO_INFO_WIDTH(info), GST_VIDEO_INFO_HEIGHT(info)};
  };
  const auto boxOf = [](const GstVideoRectangle& r) { return Box{r.x, r.y, r.w, r.h}; };
  const auto placement =
      objects::placementOf({sizeOf(drawn.in_info), sizeOf(drawn.out_info),
                            boxOf(drawn.in_rectangle), boxOf(drawn.out_rectangle), drawn.matrix});
  if (!placement) return FALSE;
  try {
    attachResult(to,
                 objects::place(reinterpret_cast<ResultMeta<Payload>*>(meta)->result, *placement));
    return TRUE;
  } catch (const std::bad_alloc&) {
    return FALSE;
  }
}
#endif

/// A copy of the whole frame and a scaled frame share the result, which tells the size that it was
/// made for. Anything else would put it in the wrong place, so it is dropped.
template <class Payload>
gboolean transformMeta(GstBuffer* to, GstMeta* meta, GstBuffer*, GQuark type, gpointer data) {
#if GST_CHECK_VERSION(1, 28, 0)
  if (GST_VIDEO_META_TRANSFORM_IS_MATRIX(type))
    return placeMeta<Payload>(to, meta, *static_cast<GstVideoMetaTransformMatrix*>(data));
#endif
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

#if GST_CHECK_VERSION(1, 24, 0)
template <class Payload>
gboolean serializeMeta(const GstMeta* meta, GstByteArrayInterface* data, guint8* version) {
  const auto& result = reinterpret_cast<const ResultMeta<Payload>*>(meta)->result;
  *version = kStoredVersion;
  try {
    const std::vector<uint8_t> bytes = result ? store(*result) : std::vector<uint8_t>();
    return result && gst_byte_array_interface_append_data(data, bytes.data(), bytes.size());
  } catch (const std::bad_alloc&) {
    return FALSE;
  }
}

bool joinWhatIsThere(background::Foreground&, GstBuffer*) {
  return true;
}
bool joinWhatIsThere(segmentation::Labels& labels, GstBuffer* buffer) {
  return join(labels, findResult<background::Foreground>(buffer));
}
bool joinWhatIsThere(graph::Graph& graph, GstBuffer* buffer) {
  return join(graph, findResult<segmentation::Labels>(buffer));
}
bool joinWhatIsThere(motion::Motion& motion, GstBuffer* buffer) {
  return join(motion, findResult<graph::Graph>(buffer));
}
bool joinWhatIsThere(objects::Objects& objects, GstBuffer* buffer) {
  return join(objects, findResult<motion::Motion>(buffer));
}

template <class Payload>
GstMeta* deserializeMeta(const GstMetaInfo* info, GstBuffer* buffer, const guint8* data, gsize size,
                         guint8 version) {
  if (version != kStoredVersion) return nullptr;
  try {
    auto result = restore<Payload>({data, size});
    if (!result || !joinWhatIsThere(*result, buffer)) return nullptr;
    attachResult<Payload>(buffer, std::move(result));
    return gst_buffer_get_meta(buffer, info->api);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

template <class Payload>
const GstMetaInfo* registerInfo(GType api, const char* name) {
  GstMetaInfo* info = gst_meta_info_new(api, name, sizeof(ResultMeta<Payload>));
  info->init_func = initMeta<Payload>;
  info->free_func = freeMeta<Payload>;
  info->transform_func = transformMeta<Payload>;
  info->serialize_func = serializeMeta<Payload>;
  info->deserialize_func = deserializeMeta<Payload>;
  return gst_meta_info_register(info);
}
#else
template <class Payload>
const GstMetaInfo* registerInfo(GType api, const char* name) {
  return gst_meta_register(api, name, sizeof(ResultMeta<Payload>), initMeta<Payload>,
                           freeMeta<Payload>, transformMeta<Payload>);
}
#endif

}  // namespace
}  // namespace rg

/// Who knows the type knows the meta: a program asks for it before buffers come from elsewhere.
#define RG_DEFINE_META(lower, room, Payload)                                           \
  GType gst_region_##lower##_meta_api_get_type(void) {                                 \
    return gst_region_##lower##_meta_get_info()->api;                                  \
  }                                                                                    \
  const GstMetaInfo* gst_region_##lower##_meta_get_info(void) {                        \
    static const GstMetaInfo* const info = rg::registerInfo<rg::room::Payload>(        \
        rg::registerApi("GstRegion" #Payload "MetaAPI"), "GstRegion" #Payload "Meta"); \
    return info;                                                                       \
  }                                                                                    \
  GstRegion##Payload##Meta* gst_buffer_get_region_##lower##_meta(GstBuffer* buffer) {  \
    g_return_val_if_fail(GST_IS_BUFFER(buffer), nullptr);                              \
    return reinterpret_cast<GstRegion##Payload##Meta*>(                                \
        gst_buffer_get_meta(buffer, gst_region_##lower##_meta_api_get_type()));        \
  }

RG_DEFINE_META(foreground, background, Foreground)
RG_DEFINE_META(labels, segmentation, Labels)
RG_DEFINE_META(graph, graph, Graph)
RG_DEFINE_META(motion, motion, Motion)
RG_DEFINE_META(objects, objects, Objects)
