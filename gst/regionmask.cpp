// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-regionmask
 * @title: regionmask
 *
 * Turns what the elements before it found into video of the frame's size: a black and white mask
 * of the foreground or of the objects (GRAY8), or the number of each pixel's region (GRAY16_BE or
 * GRAY16_LE; pngenc takes GRAY16_BE). Time stamps are kept, and so are the metas of the regions,
 * so that regionwrite may follow. Only metas are read: frames may be in any format and memory.
 *
 * |[
 * gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert ! bgremove !
 *   regionmask source=foreground ! pngenc ! multifilesink location=mask-%06d.png
 * ]|
 */
#include "gst/elements.hpp"
#include "gst/support/filter.hpp"
#include "gst/support/guarded.hpp"
#include "gst/support/lost_results.hpp"
#include "gst/support/mask_painter.hpp"
#include "gst/support/properties.hpp"
#include "gst/support/shown_result.hpp"
#include "gst/support/video_map.hpp"

#include <gst/base/gstbasetransform.h>
#include <gst/video/video.h>

#include <array>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <utility>

namespace rg {
namespace {

constexpr const char* kMaskCaps =
    "video/x-raw, format=(string){ GRAY8, GRAY16_BE, GRAY16_LE }, width=(int)[1,16384], "
    "height=(int)[1,16384], framerate=(fraction)[0/1,2147483647/1]";

GType sourceType() {
  static const GEnumValue values[] = {
      {static_cast<int>(MaskSource::Foreground),
       "GRAY8: 255 where bgremove found foreground; its shadows are background", "foreground"},
      {static_cast<int>(MaskSource::Labels),
       "GRAY16_BE or GRAY16_LE: the number of the region from hsvsegment, 0 = none", "labels"},
      {static_cast<int>(MaskSource::Objects),
       "GRAY8: 255 where mrfmerge sees an object that is tracked or stopped", "objects"},
      {static_cast<int>(MaskSource::Hue),
       "GRAY8: 255 where hsvsegment finds an object's hue, 128 where a pixel has no colour, 0 "
       "where "
       "it has the background's hue; needs background-hue or object-hue there",
       "hue"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionMaskSource", values);
  return type;
}

struct Settings {
  MaskSource source = MaskSource::Foreground;
};
const Settings kDefaults;

constexpr std::array kProperties{
    enumProperty<Settings, &Settings::source>(
        "source", "What becomes video; decides the format of the output", sourceType,
        Mutable::Ready),
};

struct RegionMask {
  std::mutex settingsMutex;  ///< Protects the two below; nothing is called while it is held.
  Settings settings;
  std::optional<MaskSource> running;  ///< The source since the start: the output's format is its.
  GstVideoInfo output{};
  bool isFirst = true;
  bool hasWarned = false;

  [[nodiscard]] MaskSource source() {
    const std::lock_guard lock(settingsMutex);
    return running.value_or(settings.source);
  }
  void start() {
    const std::lock_guard lock(settingsMutex);
    running = settings.source;
  }
  void stop() {
    const std::lock_guard lock(settingsMutex);
    running.reset();
  }
};

/// What is in the instance itself needs no memory of its own: to make one can't fail.
struct Instance {
  GstBaseTransform parent;
  RegionMask mask;
};

GstDebugCategory* category = nullptr;
gpointer parentClass = nullptr;
#define GST_CAT_DEFAULT category

RegionMask& maskOf(gpointer instance) {
  return reinterpret_cast<Instance*>(instance)->mask;
}

void setProperty(GObject* object, guint id, const GValue* value, GParamSpec* spec) {
  RegionMask& mask = maskOf(object);
  {
    const std::lock_guard lock(mask.settingsMutex);
    if (!mask.running) return kProperties[id - 1].set(&mask.settings, value);
  }
  GST_ELEMENT_WARNING(
      object, RESOURCE, SETTINGS,
      ("%s stays as it was: it can change in the states NULL and READY only.", spec->name),
      (nullptr));
}

void getProperty(GObject* object, guint id, GValue* value, GParamSpec*) {
  RegionMask& mask = maskOf(object);
  const std::lock_guard lock(mask.settingsMutex);
  kProperties[id - 1].get(&mask.settings, value);
}

void finalize(GObject* object) {
  std::destroy_at(&maskOf(object));
  G_OBJECT_CLASS(parentClass)->finalize(object);
}

/// From frames to masks: size, rate and shape stay, the format is the source's. Colorimetry and
/// chroma-site go: grey that inherits those of limited-range video would be stretched by
/// videoconvert.
GstCaps* masksOf(GstCaps* frames, MaskSource source) {
  GstCaps* masks = gst_caps_new_empty();
  for (guint i = 0; i < gst_caps_get_size(frames); ++i) {
    GstStructure* mask = gst_structure_copy(gst_caps_get_structure(frames, i));
    gst_structure_remove_fields(mask, "colorimetry", "chroma-site", nullptr);
    setFormats(mask, source);
    masks = gst_caps_merge_structure(masks, mask);
  }
  return masks;
}

/// The frames that a mask may come from: any format in any memory.
GstCaps* framesOf(GstCaps* masks) {
  GstCaps* frames = gst_caps_new_empty();
  for (guint i = 0; i < gst_caps_get_size(masks); ++i) {
    GstStructure* frame = gst_structure_copy(gst_caps_get_structure(masks, i));
    gst_structure_remove_fields(frame, "format", "colorimetry", "chroma-site", nullptr);
    frames = gst_caps_merge_structure_full(frames, frame, gst_caps_features_new_any());
  }
  return frames;
}

GstCaps* transformCaps(GstBaseTransform* element, GstPadDirection from, GstCaps* caps,
                       GstCaps* filter) {
  GstCaps* result = from == GST_PAD_SINK ? masksOf(caps, maskOf(element).source()) : framesOf(caps);
  if (!filter) return result;
  GstCaps* filtered = gst_caps_intersect_full(filter, result, GST_CAPS_INTERSECT_FIRST);
  gst_caps_unref(result);
  return filtered;
}

gboolean setCaps(GstBaseTransform* element, GstCaps*, GstCaps* masks) {
  RegionMask& mask = maskOf(element);
  if (!gst_video_info_from_caps(&mask.output, masks) || !acceptsSize(element, mask.output))
    return FALSE;
  mask.isFirst = true;
  mask.hasWarned = false;
  return TRUE;
}

/// How large a buffer is on the other side. Frames may have any stride, so that their size says
/// nothing about the mask's.
gboolean transformSize(GstBaseTransform*, GstPadDirection from, GstCaps*, gsize size,
                       GstCaps* other, gsize* otherSize) {
  GstVideoInfo info;
  if (!gst_video_info_from_caps(&info, other)) return FALSE;
  *otherSize = from == GST_PAD_SINK ? GST_VIDEO_INFO_SIZE(&info) : size;
  return TRUE;
}

/// Masks come from a pool; one of our own where downstream offers none.
gboolean decideAllocation(GstBaseTransform* element, GstQuery* query) {
  if (gst_query_get_n_allocation_pools(query) == 0) {
    const auto size = static_cast<guint>(GST_VIDEO_INFO_SIZE(&maskOf(element).output));
    GstBufferPool* pool = gst_video_buffer_pool_new();
    gst_query_add_allocation_pool(query, pool, size, 0, 0);
    gst_object_unref(pool);
  }
  return GST_BASE_TRANSFORM_CLASS(parentClass)->decide_allocation(element, query);
}

gboolean proposeAllocation(GstBaseTransform*, GstQuery*, GstQuery* query) {
  gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
  gst_query_add_allocation_meta(query, GST_VIDEO_CROP_META_API_TYPE, nullptr);
  return TRUE;
}

template <class Payload>
void attachShown(GstBuffer* from, GstBuffer* to, Size size) {
  if (auto result = findShown<Payload>(from, size)) attachResult<Payload>(to, std::move(result));
}

/// The mask is of the part of a frame that is shown, and so are the region metas on it.
void attachShownParts(GstBuffer* from, GstBuffer* to, Size size) {
  attachShown<background::Foreground>(from, to, size);
  attachShown<segmentation::Labels>(from, to, size);
  attachShown<graph::Graph>(from, to, size);
  attachShown<motion::Motion>(from, to, size);
  attachShown<objects::Objects>(from, to, size);
}

/// The region metas go on: they tell the size that they were made for. Those about the frame's
/// memory don't, nor those of which videocrop shows a part without telling them.
gboolean transformMeta(GstBaseTransform* element, GstBuffer* to, GstMeta* meta, GstBuffer* from) {
  const GType api = meta->info->api;
  if (api == GST_VIDEO_CROP_META_API_TYPE) return FALSE;
  const bool isCropped = gst_buffer_get_video_crop_meta(from) != nullptr;
  if (isCropped && api == GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE) return FALSE;
  for (const GType ours : {metaInfo<background::Foreground>()->api,
                           metaInfo<segmentation::Labels>()->api, metaInfo<graph::Graph>()->api,
                           metaInfo<motion::Motion>()->api, metaInfo<objects::Objects>()->api})
    if (api == ours) return TRUE;
  if (api == GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE) return TRUE;
  return GST_BASE_TRANSFORM_CLASS(parentClass)->transform_meta(element, to, meta, from);
}

/// Reports a frame without a result: an error on the first one, since it will never come.
GstFlowReturn handleMissing(GstBaseTransform* element, MaskSource source) {
  RegionMask& mask = maskOf(element);
  const char* producer = producerOf(source);
  if (mask.isFirst) {
    GST_ELEMENT_ERROR(element, STREAM, FAILED,
                      ("%s", whyMissing(GST_ELEMENT(element), producer).c_str()), (nullptr));
    return GST_FLOW_ERROR;
  }
  if (!std::exchange(mask.hasWarned, true))
    GST_ELEMENT_WARNING(element, STREAM, FAILED,
                        ("The results of %s stopped; their masks are black.", producer), (nullptr));
  return GST_FLOW_OK;
}

GstFlowReturn transform(GstBaseTransform* element, GstBuffer* in, GstBuffer* out) {
  RegionMask& mask = maskOf(element);
  const MaskSource source = mask.source();
  VideoMap video(out, mask.output, GST_MAP_WRITE);
  if (!video.frame()) {
    GST_ELEMENT_ERROR(element, RESOURCE, WRITE, ("The output buffer can't be mapped."), (nullptr));
    return GST_FLOW_ERROR;
  }
  if (gst_buffer_get_video_crop_meta(in))
    attachShownParts(in, out,
                     {GST_VIDEO_INFO_WIDTH(&mask.output), GST_VIDEO_INFO_HEIGHT(&mask.output)});
  const bool wasThere = paintMask(source, in, video.frame());
  const GstFlowReturn flow = wasThere ? GST_FLOW_OK : handleMissing(element, source);
  mask.isFirst = false;
  return flow;
}

void addTemplate(GstElementClass* klass, const char* name, GstPadDirection direction,
                 const char* text) {
  GstCaps* caps = gst_caps_from_string(text);
  gst_element_class_add_pad_template(klass,
                                     gst_pad_template_new(name, direction, GST_PAD_ALWAYS, caps));
  gst_caps_unref(caps);
}

void initClass(gpointer klass, gpointer) {
  category = _gst_debug_category_new("regionmask", 0, "Region mask");
  parentClass = g_type_class_peek_parent(klass);

  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = setProperty;
  object->get_property = getProperty;
  object->finalize = finalize;
  installProperties(object, kProperties, &kDefaults);

  auto* element = GST_ELEMENT_CLASS(klass);
  gst_element_class_set_static_metadata(
      element, "Region mask", "Filter/Converter/Video",
      "Turns what the elements before it found into grey video of the frame's size: foreground or "
      "objects as a black and white mask (GRAY8), or the number of each pixel's region (GRAY16_BE "
      "or "
      "GRAY16_LE). Time stamps and region metas are kept. Needs bgremove, hsvsegment or mrfmerge, "
      "as "
      "source says",
      "The gst-regiongraph developers");
  gst_element_class_add_static_metadata(
      element, "example",
      "gst-launch-1.0 videotestsrc pattern=ball num-buffers=100 ! video/x-raw,format=I420 ! "
      "bgremove ! regionmask source=foreground ! pngenc ! multifilesink location=mask-%03d.png");
  addTemplate(element, "sink", GST_PAD_SINK, kMetaCaps);
  addTemplate(element, "src", GST_PAD_SRC, kMaskCaps);

  auto* transformClass = GST_BASE_TRANSFORM_CLASS(klass);
  transformClass->passthrough_on_same_caps = FALSE;
  transformClass->start = [](GstBaseTransform* self) -> gboolean {
    maskOf(self).start();
    return TRUE;
  };
  transformClass->stop = [](GstBaseTransform* self) -> gboolean {
    maskOf(self).stop();
    return TRUE;
  };
  transformClass->transform_caps = transformCaps;
  transformClass->set_caps = setCaps;
  transformClass->transform_size = transformSize;
  transformClass->decide_allocation = decideAllocation;
  transformClass->propose_allocation = proposeAllocation;
  transformClass->transform_meta = transformMeta;
  transformClass->transform = [](GstBaseTransform* self, GstBuffer* in, GstBuffer* out) {
    return guarded(self, GST_FLOW_ERROR, [&] { return transform(self, in, out); });
  };
}

GType registerMask() {
  GTypeInfo info{};
  info.class_size = sizeof(GstBaseTransformClass);
  info.class_init = initClass;
  info.instance_size = sizeof(Instance);
  info.instance_init = [](GTypeInstance* instance, gpointer) {
    new (&maskOf(instance)) RegionMask;
  };
  return g_type_register_static(GST_TYPE_BASE_TRANSFORM, "GstRegionMask", &info,
                                static_cast<GTypeFlags>(0));
}

}  // namespace
}  // namespace rg

GType gst_region_mask_get_type() {
  static const GType type = rg::registerMask();
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(regionmask, "regionmask", GST_RANK_NONE, gst_region_mask_get_type())
