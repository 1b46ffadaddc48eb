// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/filter.hpp"

#include "gst/support/foreign_enum.hpp"
#include "gst/support/frame_hold.hpp"
#include "gst/support/guarded.hpp"
#include "gst/support/lost_results.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace rg {
namespace {

/// GObject can't refuse to make an instance. Where there was no memory for the filter, the element
/// has none: it keeps no property, and fails when it is started.
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
Filter* filterOf(gpointer instance) {
  return reinterpret_cast<Instance*>(instance)->filter;
}

/// Runs the body of a vfunc with the element's filter; `failed` without one.
template <class T, class Body>
T withFilter(gpointer element, T failed, Body body) noexcept {
  Filter* filter = filterOf(element);
  return filter ? guarded(element, failed, [&] { return body(*filter); }) : failed;
}

}  // namespace

/// The vfuncs; a struct so that it can be the filter's friend.
struct FilterShell {
  /// After an exception the element goes on as after a change of stream: whatever it left half done
  /// is dropped.
  template <class Body>
  static auto orAnew(Filter& filter, Body body) {
    try {
      return body();
    } catch (...) {
      filter.clock_.restart();
      filter.isDownstreamNew_ = true;
      filter.dropHeld();
      filter.reset(Reset::Stream);
      throw;
    }
  }

  static void warnUnchanged(GObject* object, const GParamSpec* spec, const char* reason) {
    GST_ELEMENT_WARNING(object, RESOURCE, SETTINGS, ("%s stays as it was: %s.", spec->name, reason),
                        (nullptr));
  }

  static void setProperty(GObject* object, guint id, const GValue* value, GParamSpec* spec) {
    Filter* filter = filterOf(object);
    if (!filter) return;
    try {
      const Property& property = classOf(object)->description->properties[id - 1];
      const std::lock_guard lock(filter->settingsMutex());
      const bool isInForce = filter->isRunning_ && property.when == Mutable::Ready;
      if (!isInForce) return property.set(filter->settings(), value);
    } catch (const std::invalid_argument& reason) {
      return warnUnchanged(object, spec, reason.what());
    } catch (...) {  // Only a text needs memory.
      return warnUnchanged(object, spec, "out of memory");
    }
    warnUnchanged(object, spec, "it can change in the states NULL and READY only");
  }

  static void getProperty(GObject* object, guint id, GValue* value, GParamSpec*) {
    const FilterDescription& about = *classOf(object)->description;
    Filter* filter = filterOf(object);
    if (!filter) return about.properties[id - 1].get(about.defaults, value);
    const std::lock_guard lock(filter->settingsMutex());
    about.properties[id - 1].get(filter->settings(), value);
  }

  static void finalize(GObject* object) {
    delete reinterpret_cast<Instance*>(object)->filter;
    G_OBJECT_CLASS(parentClass)->finalize(object);
  }

  static gboolean start(GstBaseTransform* element) {
    if (!filterOf(element))
      GST_ELEMENT_ERROR(element, RESOURCE, NO_SPACE_LEFT,
                        ("There was no memory to make this element: free some, and make another."),
                        (nullptr));
    return withFilter(element, FALSE, [](Filter& filter) -> gboolean {
      filter.clock_ = {};
      filter.streamId_.clear();
      filter.hasCaps_ = false;
      filter.setRunning(true);
      bool hasStarted = false;
      try {
        hasStarted = filter.start();
      } catch (...) {
        filter.setRunning(false);
        throw;
      }
      filter.setRunning(hasStarted);
      filter.wholeLatency_ = filter.latency();
      return hasStarted;
    });
  }

  static gboolean stop(GstBaseTransform* element) {
    return withFilter(element, FALSE, [](Filter& filter) -> gboolean {
      filter.dropHeld();
      filter.setRunning(false);
      filter.reset(Reset::Stream);
      filter.stop();
      return TRUE;
    });
  }

  static gboolean setCaps(GstBaseTransform* element, GstCaps* caps, GstCaps*) {
    return withFilter(element, FALSE, [&](Filter& filter) -> gboolean {
      GstVideoInfo info;
      if (!gst_video_info_from_caps(&info, caps)) return FALSE;
      if (!acceptsSize(element, info)) return FALSE;
      if (!filter.hasCaps_ || !samePixels(filter.info_, info)) {
        filter.reset(Reset::Stream);
        filter.clock_.restart();
        filter.isFirst_ = true;
      }
      filter.info_ = info;
      filter.hasCaps_ = true;
      filter.isDownstreamNew_ = true;
      filter.wholeLatency_ = latencyInFrames(filter.latency(), info);
      filter.clock_.setFramerate(GST_VIDEO_INFO_FPS_N(&info), GST_VIDEO_INFO_FPS_D(&info));
      return TRUE;
    });
  }

  /// Whether the pixels of both mean the same, so that what was learnt stays true.
  static bool samePixels(const GstVideoInfo& a, const GstVideoInfo& b) {
    return GST_VIDEO_INFO_FORMAT(&a) == GST_VIDEO_INFO_FORMAT(&b) &&
           GST_VIDEO_INFO_WIDTH(&a) == GST_VIDEO_INFO_WIDTH(&b) &&
           GST_VIDEO_INFO_HEIGHT(&a) == GST_VIDEO_INFO_HEIGHT(&b) &&
           GST_VIDEO_INFO_IS_INTERLACED(&a) == GST_VIDEO_INFO_IS_INTERLACED(&b) &&
           gst_video_colorimetry_is_equal(&a.colorimetry, &b.colorimetry);
  }

  static gboolean sinkEvent(GstBaseTransform* element, GstEvent* event) {
    withFilter(element, FALSE, [&](Filter& filter) -> gboolean {
      return orAnew(filter, [&] {
        handleEvent(filter, event);
        return TRUE;
      });
    });
    return GST_BASE_TRANSFORM_CLASS(parentClass)->sink_event(element, event);
  }

  static gboolean srcEvent(GstBaseTransform* element, GstEvent* event) {
    Filter* filter = filterOf(element);
    if (filter && GST_EVENT_TYPE(event) == GST_EVENT_RECONFIGURE) filter->isDownstreamNew_ = true;
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
        if (!id) id = "";
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

  /// Controllers follow the stream's time, which segments in bytes or frames don't have.
  static void controlProperties(GstBaseTransform* element, GstClockTime pts) {
    if (numberIn(element->segment.format) != GST_FORMAT_TIME) return;
    const GstClockTime time = gst_segment_to_stream_time(&element->segment, GST_FORMAT_TIME, pts);
    if (GST_CLOCK_TIME_IS_VALID(time)) gst_object_sync_values(GST_OBJECT(element), time);
  }

  static GstFlowReturn transform(GstBaseTransform* element, GstBuffer* buffer) {
    return withFilter(element, GST_FLOW_ERROR, [&](Filter& filter) {
      controlProperties(element, GST_BUFFER_PTS(buffer));
      return orAnew(filter, [&] { return look(filter, buffer); });
    });
  }

  static GstFlowReturn look(Filter& filter, GstBuffer* buffer) {
    const Tick tick = filter.clock_.advance(buffer);
    if (tick.reset) filter.reset(*tick.reset);
    const bool isUsable = !GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_GAP) &&
                          !GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_CORRUPTED);
    const bool isDownstreamNew = filter.isDownstreamNew_.exchange(false);
    const FilterFrame frame{buffer,          filter.info_,    tick.time,
                            filter.isFirst_, isDownstreamNew, isUsable};
    const GstClockTime before = gst_util_get_timestamp();
    const GstFlowReturn flow = filter.process(frame);
    filter.finish(frame, gst_util_get_timestamp() - before);
    filter.isFirst_ = false;
    return flow;
  }

  static GstFlowReturn generateOutput(GstBaseTransform* element, GstBuffer** out) {
    const GstFlowReturn flow = GST_BASE_TRANSFORM_CLASS(parentClass)->generate_output(element, out);
    return withFilter(element, GST_FLOW_ERROR, [&](Filter& filter) {
      if (flow != GST_FLOW_OK) return flow;
      if (*out) *out = filter.render(*out);
      if (filter.latency() == 0) return flow;
      return orAnew(filter, [&] {
        if (*out) filter.hold(std::exchange(*out, nullptr));
        *out = filter.release(false);
        return GST_FLOW_OK;
      });
    });
  }

  static gboolean query(GstBaseTransform* element, GstPadDirection direction, GstQuery* query) {
    const bool isHandled =
        GST_BASE_TRANSFORM_CLASS(parentClass)->query(element, direction, query) != FALSE;
    const Filter* filter = filterOf(element);
    if (isHandled && filter && direction == GST_PAD_SRC &&
        GST_QUERY_TYPE(query) == GST_QUERY_LATENCY) {
      gboolean isLive = FALSE;
      GstClockTime least = 0, most = 0;
      gst_query_parse_latency(query, &isLive, &least, &most);
      const GstClockTime own = filter->wholeLatency_;
      gst_query_set_latency(query, isLive, least + own,
                            GST_CLOCK_TIME_IS_VALID(most) ? most + own : most);
    }
    return isHandled;
  }

  /// Buffers go on as they came, so what upstream may allocate is for downstream to say; those that
  /// are held here come on top.
  static gboolean proposeAllocation(GstBaseTransform* element, GstQuery*, GstQuery* query) {
    const FilterDescription& about = *classOf(element)->description;
    if (about.srcCaps) {
      gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
      if (about.takesCrops)
        gst_query_add_allocation_meta(query, GST_VIDEO_CROP_META_API_TYPE, nullptr);
      return TRUE;
    }
    const gboolean isHandled = gst_pad_peer_query(GST_BASE_TRANSFORM_SRC_PAD(element), query);
    guint crop = 0;
    while (!about.takesCrops &&
           gst_query_find_allocation_meta(query, GST_VIDEO_CROP_META_API_TYPE, &crop))
      gst_query_remove_nth_allocation_meta(query, crop);
    Filter* filter = filterOf(element);
    if (isHandled && filter && filter->latency() > 0)
      raisePools(query, static_cast<guint>(std::min(framesIn(filter->latency(), filter->info_),
                                                    filter->mostHeld())));
    return isHandled;
  }

  static GstCaps* transformCaps(GstBaseTransform* element, GstPadDirection from, GstCaps*,
                                GstCaps* filter) {
    const FilterDescription& about = *classOf(element)->description;
    GstCaps* caps = gst_caps_from_string(from == GST_PAD_SINK ? about.srcCaps : about.caps);
    if (!filter) return caps;
    GstCaps* both = gst_caps_intersect_full(filter, caps, GST_CAPS_INTERSECT_FIRST);
    gst_caps_unref(caps);
    return both;
  }

  static void act(GstElement* element) {
    withFilter(element, FALSE, [](Filter& filter) -> gboolean {
      filter.act();
      return TRUE;
    });
  }

  static void addPadTemplates(GstElementClass* element, const FilterDescription& about) {
    const char* const srcCaps = about.srcCaps ? about.srcCaps : about.caps;
    for (const auto& [name, direction, text] :
         {std::tuple{"sink", GST_PAD_SINK, about.caps}, {"src", GST_PAD_SRC, srcCaps}}) {
      GstCaps* caps = gst_caps_from_string(text);
      gst_element_class_add_pad_template(
          element, gst_pad_template_new(name, direction, GST_PAD_ALWAYS, caps));
      gst_caps_unref(caps);
    }
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
    addPadTemplates(element, about);
    if (about.action)
      g_signal_new_class_handler(about.action, G_TYPE_FROM_CLASS(klass),
                                 static_cast<GSignalFlags>(G_SIGNAL_RUN_LAST | G_SIGNAL_ACTION),
                                 G_CALLBACK(act), nullptr, nullptr, nullptr, G_TYPE_NONE, 0);

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
    if (about.srcCaps) transformClass->transform_caps = transformCaps;
  }

  static void initInstance(GTypeInstance* instance, gpointer klass) {
    auto* element = reinterpret_cast<GstBaseTransform*>(instance);
    gst_base_transform_set_in_place(element, TRUE);
    try {
      reinterpret_cast<Instance*>(instance)->filter =
          static_cast<Class*>(klass)->description->create(element);
    } catch (...) {
      GST_CAT_ERROR_OBJECT(static_cast<Class*>(klass)->category, element, "out of memory");
    }
  }
};

GType registerFilter(const FilterDescription& description) {
  GTypeInfo info{};
  info.class_size = sizeof(Class);
  info.class_init = FilterShell::initClass;
  info.class_data = &description;
  info.instance_size = sizeof(Instance);
  info.instance_init = FilterShell::initInstance;
  const GType type = g_type_register_static(GST_TYPE_BASE_TRANSFORM, description.typeName, &info,
                                            static_cast<GTypeFlags>(0));
  nameType(type, description.elementName);
  return type;
}

const FilterDescription& descriptionOf(GType type) {
  gpointer klass = g_type_class_ref(type);
  const FilterDescription& description = *static_cast<Class*>(klass)->description;
  g_type_class_unref(klass);
  return description;
}

GstDebugCategory* Filter::category() const {
  return classOf(element_)->category;
}

}  // namespace rg
