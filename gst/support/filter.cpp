// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/filter.hpp"

#include "gst/support/guarded.hpp"

#include <utility>

#define RG_PIXEL_FORMATS "{ BGRx, RGBx, BGRA, RGBA, BGR, RGB, NV12, I420, GRAY8 }"
#define RG_SIZES \
  "width=(int)[1,16384], height=(int)[1,16384], framerate=(fraction)[0/1,2147483647/1]"

namespace rg {

const char* const kPixelCaps = "video/x-raw, format=(string)" RG_PIXEL_FORMATS ", " RG_SIZES;
const char* const kMetaCaps = "video/x-raw(ANY), " RG_SIZES;

namespace {

/// Larger frames are refused: labels and sums are sized for this many pixels (8K: 8192x4320).
constexpr int64_t kMaxPixels = int64_t{8192} * 4320;

struct Instance {
  GstBaseTransform parent;
  Filter* filter;
};

struct Class {
  GstBaseTransformClass parent;
  const FilterDescription* description;
  GstDebugCategory* category;
};

gpointer parentClass = nullptr;

Class* classOf(gpointer instance) {
  return G_TYPE_INSTANCE_GET_CLASS(instance, 0, Class);
}
Filter& filterOf(gpointer instance) {
  return *reinterpret_cast<Instance*>(instance)->filter;
}

}  // namespace

/// The vfuncs; a struct so that it can be the filter's friend.
struct FilterShell {
  static void setProperty(GObject* object, guint id, const GValue* value, GParamSpec*) {
    Filter& filter = filterOf(object);
    const std::lock_guard lock(filter.settingsMutex());
    classOf(object)->description->properties[id - 1].set(filter.settings(), value);
  }

  static void getProperty(GObject* object, guint id, GValue* value, GParamSpec*) {
    Filter& filter = filterOf(object);
    const std::lock_guard lock(filter.settingsMutex());
    classOf(object)->description->properties[id - 1].get(filter.settings(), value);
  }

  static void finalize(GObject* object) {
    delete reinterpret_cast<Instance*>(object)->filter;
    G_OBJECT_CLASS(parentClass)->finalize(object);
  }

  static gboolean start(GstBaseTransform* element) {
    return guarded(element, FALSE, [&]() -> gboolean {
      Filter& filter = filterOf(element);
      filter.clock_ = {};
      filter.streamId_.clear();
      filter.hasCaps_ = false;
      return filter.start();
    });
  }

  static gboolean stop(GstBaseTransform* element) {
    return guarded(element, FALSE, [&]() -> gboolean {
      filterOf(element).dropHeld();
      filterOf(element).reset(Reset::Stream);
      filterOf(element).stop();
      return TRUE;
    });
  }

  static gboolean setCaps(GstBaseTransform* element, GstCaps* caps, GstCaps*) {
    return guarded(element, FALSE, [&]() -> gboolean {
      Filter& filter = filterOf(element);
      GstVideoInfo info;
      if (!gst_video_info_from_caps(&info, caps)) return FALSE;
      const int64_t pixels = int64_t{GST_VIDEO_INFO_WIDTH(&info)} * GST_VIDEO_INFO_HEIGHT(&info);
      if (pixels <= 0 || pixels > kMaxPixels) {
        GST_ELEMENT_ERROR(
            element, STREAM, FORMAT,
            ("Frames of %dx%d are too large.", GST_VIDEO_INFO_WIDTH(&info),
             GST_VIDEO_INFO_HEIGHT(&info)),
            ("At most %" G_GINT64_FORMAT " pixels; put videoscale in front.", kMaxPixels));
        return FALSE;
      }
      if (!filter.hasCaps_ || !samePixels(filter.info_, info)) {
        filter.reset(Reset::Stream);
        filter.clock_.restart();
        filter.isFirst_ = true;
      }
      filter.info_ = info;
      filter.hasCaps_ = true;
      filter.isDownstreamNew_ = true;
      filter.clock_.setFramerate(GST_VIDEO_INFO_FPS_N(&info), GST_VIDEO_INFO_FPS_D(&info));
      return TRUE;
    });
  }

  /// Whether the pixels of both mean the same, so that what was learnt stays true.
  static bool samePixels(const GstVideoInfo& a, const GstVideoInfo& b) {
    return GST_VIDEO_INFO_FORMAT(&a) == GST_VIDEO_INFO_FORMAT(&b) &&
           GST_VIDEO_INFO_WIDTH(&a) == GST_VIDEO_INFO_WIDTH(&b) &&
           GST_VIDEO_INFO_HEIGHT(&a) == GST_VIDEO_INFO_HEIGHT(&b) &&
           gst_video_colorimetry_is_equal(&a.colorimetry, &b.colorimetry);
  }

  static gboolean sinkEvent(GstBaseTransform* element, GstEvent* event) {
    guarded(element, FALSE, [&]() -> gboolean {
      handleEvent(filterOf(element), event);
      return TRUE;
    });
    return GST_BASE_TRANSFORM_CLASS(parentClass)->sink_event(element, event);
  }

  static gboolean srcEvent(GstBaseTransform* element, GstEvent* event) {
    if (GST_EVENT_TYPE(event) == GST_EVENT_RECONFIGURE) filterOf(element).isDownstreamNew_ = true;
    return GST_BASE_TRANSFORM_CLASS(parentClass)->src_event(element, event);
  }

  static void handleEvent(Filter& filter, GstEvent* event) {
    switch (GST_EVENT_TYPE(event)) {
      case GST_EVENT_CAPS:
      case GST_EVENT_SEGMENT:
      case GST_EVENT_GAP:
        filter.sendHeld();
        break;
      case GST_EVENT_STREAM_START: {
        filter.sendHeld();
        const gchar* id = nullptr;
        gst_event_parse_stream_start(event, &id);
        if (!filter.streamId_.empty() && filter.streamId_ != id) {
          filter.reset(Reset::Stream);
          filter.clock_.restart();
        }
        filter.streamId_ = id;
        break;
      }
      case GST_EVENT_FLUSH_STOP:
        filter.dropHeld();
        filter.reset(Reset::Flush);
        filter.clock_.restart();
        break;
      case GST_EVENT_EOS:
        filter.sendHeld();
        filter.endOfStream();
        break;
      default:
        break;
    }
  }

  static GstFlowReturn transform(GstBaseTransform* element, GstBuffer* buffer) {
    return guarded(element, GST_FLOW_ERROR, [&] {
      Filter& filter = filterOf(element);
      const GstClockTime time =
          gst_segment_to_stream_time(&element->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
      if (GST_CLOCK_TIME_IS_VALID(time)) gst_object_sync_values(GST_OBJECT(element), time);
      const Tick tick = filter.clock_.advance(buffer);
      if (tick.reset) filter.reset(*tick.reset);
      const bool isUsable = !GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_GAP) &&
                            !GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_CORRUPTED);
      const bool isFirst = std::exchange(filter.isFirst_, false);
      const bool isDownstreamNew = filter.isDownstreamNew_.exchange(false);
      return filter.process({buffer, filter.info_, tick.time, isFirst, isDownstreamNew, isUsable});
    });
  }

  static GstFlowReturn generateOutput(GstBaseTransform* element, GstBuffer** out) {
    const GstFlowReturn flow = GST_BASE_TRANSFORM_CLASS(parentClass)->generate_output(element, out);
    Filter& filter = filterOf(element);
    if (flow != GST_FLOW_OK || filter.latency() == 0) return flow;
    return guarded(element, GST_FLOW_ERROR, [&] {
      if (*out) filter.hold(std::exchange(*out, nullptr));
      *out = filter.release(false);
      return GST_FLOW_OK;
    });
  }

  /// Frames that are held back at any time; 0 where their rate is not known.
  static guint64 heldFrames(Filter& filter) {
    const GstVideoInfo& info = filter.info_;
    if (GST_VIDEO_INFO_FPS_N(&info) <= 0 || GST_VIDEO_INFO_FPS_D(&info) <= 0) return 0;
    return gst_util_uint64_scale_ceil(
        filter.latency(), static_cast<guint64>(GST_VIDEO_INFO_FPS_N(&info)),
        static_cast<guint64>(GST_VIDEO_INFO_FPS_D(&info)) * GST_SECOND);
  }

  /// A frame leaves when the first one comes that is later by the latency.
  static GstClockTime wholeLatency(Filter& filter) {
    const guint64 frames = heldFrames(filter);
    if (frames == 0) return filter.latency();
    return gst_util_uint64_scale_ceil(
        frames, static_cast<guint64>(GST_VIDEO_INFO_FPS_D(&filter.info_)) * GST_SECOND,
        static_cast<guint64>(GST_VIDEO_INFO_FPS_N(&filter.info_)));
  }

  static gboolean query(GstBaseTransform* element, GstPadDirection direction, GstQuery* query) {
    const bool isHandled =
        GST_BASE_TRANSFORM_CLASS(parentClass)->query(element, direction, query) != FALSE;
    if (isHandled && direction == GST_PAD_SRC && GST_QUERY_TYPE(query) == GST_QUERY_LATENCY) {
      gboolean isLive = FALSE;
      GstClockTime least = 0, most = 0;
      gst_query_parse_latency(query, &isLive, &least, &most);
      const GstClockTime own = wholeLatency(filterOf(element));
      gst_query_set_latency(query, isLive, least + own,
                            GST_CLOCK_TIME_IS_VALID(most) ? most + own : most);
    }
    return isHandled;
  }

  /// Buffers go on as they came, so what upstream may allocate is for downstream to say; those that
  /// are held here come on top.
  static gboolean proposeAllocation(GstBaseTransform* element, GstQuery*, GstQuery* query) {
    const gboolean isHandled = gst_pad_peer_query(GST_BASE_TRANSFORM_SRC_PAD(element), query);
    Filter& filter = filterOf(element);
    if (!isHandled || filter.latency() == 0) return isHandled;
    const auto held = static_cast<guint>(heldFrames(filter));
    for (guint i = 0; i < gst_query_get_n_allocation_pools(query); ++i) {
      GstBufferPool* pool = nullptr;
      guint size = 0, least = 0, most = 0;
      gst_query_parse_nth_allocation_pool(query, i, &pool, &size, &least, &most);
      gst_query_set_nth_allocation_pool(query, i, pool, size, least + held,
                                        most == 0 ? 0 : most + held);
      if (pool) gst_object_unref(pool);
    }
    return isHandled;
  }

  static void initClass(gpointer klass, gpointer data) {
    auto* self = static_cast<Class*>(klass);
    self->description = static_cast<const FilterDescription*>(data);
    const FilterDescription& about = *self->description;
    self->category = _gst_debug_category_new(about.elementName, 0, about.longName);
    parentClass = g_type_class_peek_parent(klass);

    auto* object = G_OBJECT_CLASS(klass);
    object->set_property = setProperty;
    object->get_property = getProperty;
    object->finalize = finalize;
    installProperties(object, about.properties, about.defaults);

    auto* element = GST_ELEMENT_CLASS(klass);
    gst_element_class_set_static_metadata(element, about.longName, about.klass, about.description,
                                          "The gst-regiongraph developers");
    gst_element_class_add_static_metadata(element, "example", about.example);
    GstCaps* caps = gst_caps_from_string(about.caps);
    for (const auto& [name, direction] : {std::pair{"sink", GST_PAD_SINK}, {"src", GST_PAD_SRC}})
      gst_element_class_add_pad_template(
          element, gst_pad_template_new(name, direction, GST_PAD_ALWAYS, caps));
    gst_caps_unref(caps);

    auto* transformClass = GST_BASE_TRANSFORM_CLASS(klass);
    transformClass->start = start;
    transformClass->stop = stop;
    transformClass->set_caps = setCaps;
    transformClass->sink_event = sinkEvent;
    transformClass->src_event = srcEvent;
    transformClass->transform_ip = transform;
    transformClass->generate_output = generateOutput;
    transformClass->query = query;
    transformClass->propose_allocation = proposeAllocation;
  }

  static void initInstance(GTypeInstance* instance, gpointer klass) {
    auto* element = reinterpret_cast<GstBaseTransform*>(instance);
    reinterpret_cast<Instance*>(instance)->filter =
        static_cast<Class*>(klass)->description->create(element);
    gst_base_transform_set_in_place(element, TRUE);
  }
};

GType registerFilter(const FilterDescription& description) {
  GTypeInfo info{};
  info.class_size = sizeof(Class);
  info.class_init = FilterShell::initClass;
  info.class_data = &description;
  info.instance_size = sizeof(Instance);
  info.instance_init = FilterShell::initInstance;
  return g_type_register_static(GST_TYPE_BASE_TRANSFORM, description.typeName, &info,
                                static_cast<GTypeFlags>(0));
}

GstDebugCategory* Filter::category() const {
  return classOf(element_)->category;
}

void Filter::sendHeld() {
  while (GstBuffer* buffer = release(true))
    gst_pad_push(GST_BASE_TRANSFORM_SRC_PAD(element_), buffer);
}

void Filter::postWarning(const std::string& text) const {
  GST_ELEMENT_WARNING(element_, STREAM, FAILED, ("%s", text.c_str()), (nullptr));
}

GstFlowReturn Filter::postError(const std::string& text) const {
  GST_ELEMENT_ERROR(element_, STREAM, FAILED, ("%s", text.c_str()), (nullptr));
  return GST_FLOW_ERROR;
}

}  // namespace rg
