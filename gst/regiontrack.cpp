// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-regiontrack
 * @title: regiontrack
 *
 * bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge in one element, for applications that take
 * one. The children have the names of their elements and their properties are set through
 * GstChildProxy; gst-inspect-1.0 on each of the five describes them. Element messages of mrfmerge
 * come from the child.
 *
 * |[
 * gst-launch-1.0 -q filesrc location=clip.avi ! decodebin ! videoconvert !
 *   regiontrack bgremove::threshold=30 mrfmerge::max-lost-time=4 ! regionwrite ! fakesink
 * ]|
 */
#include "gst/elements.hpp"
#include "gst/support/filter.hpp"
#include "gst/support/properties.hpp"

#include <array>
#include <memory>
#include <mutex>
#include <new>
#include <utility>

namespace rg {
namespace {

struct Child {
  const char* name;
  GType (*type)();
};

constexpr std::array kChildren{
    Child{"bgremove", gst_region_bgremove_get_type},
    Child{"hsvsegment", gst_region_hsvsegment_get_type},
    Child{"srg", gst_region_srg_get_type},
    Child{"prmmotion", gst_region_prmmotion_get_type},
    Child{"mrfmerge", gst_region_mrfmerge_get_type},
};

struct Settings {
  int threads = 0;
};
const Settings kDefaults;

constexpr std::array kProperties{
    property<Settings, &Settings::threads>(
        "threads",
        "Threads that each of the five elements works with; 0 = as many as there are cores, never "
        "more",
        0, 1024, Mutable::Ready),
};

struct RegionTrack {
  std::mutex settingsMutex;  ///< Protects `settings`; nothing is called while it is held.
  Settings settings;
  std::array<GstElement*, kChildren.size()> children{};  ///< The bin owns them.
};

/// What is in the instance itself needs no memory of its own: to make one can't fail.
struct Instance {
  GstBin parent;
  RegionTrack track;
};

gpointer parentClass = nullptr;

RegionTrack& trackOf(gpointer instance) {
  return reinterpret_cast<Instance*>(instance)->track;
}

void setProperty(GObject* object, guint id, const GValue* value, GParamSpec*) {
  RegionTrack& track = trackOf(object);
  {
    const std::lock_guard lock(track.settingsMutex);
    kProperties[id - 1].set(&track.settings, value);
  }
  for (GstElement* child : track.children)
    g_object_set_property(G_OBJECT(child), kProperties[id - 1].name, value);
}

void getProperty(GObject* object, guint id, GValue* value, GParamSpec*) {
  RegionTrack& track = trackOf(object);
  const std::lock_guard lock(track.settingsMutex);
  kProperties[id - 1].get(&track.settings, value);
}

void finalize(GObject* object) {
  std::destroy_at(&trackOf(object));
  G_OBJECT_CLASS(parentClass)->finalize(object);
}

void addGhostPad(GstElement* bin, GstElement* child, const char* name) {
  GstPad* target = gst_element_get_static_pad(child, name);
  GstPadTemplate* padTemplate =
      gst_element_class_get_pad_template(GST_ELEMENT_GET_CLASS(bin), name);
  gst_element_add_pad(bin, gst_ghost_pad_new_from_template(name, target, padTemplate));
  gst_object_unref(target);
}

void initInstance(GTypeInstance* instance, gpointer) {
  RegionTrack& track = *new (&trackOf(instance)) RegionTrack;
  auto* bin = reinterpret_cast<GstElement*>(instance);
  for (size_t i = 0; i < kChildren.size(); ++i) {
    track.children[i] =
        GST_ELEMENT(g_object_new(kChildren[i].type(), "name", kChildren[i].name, nullptr));
    gst_bin_add(GST_BIN(bin), track.children[i]);
    if (i > 0) gst_element_link(track.children[i - 1], track.children[i]);
  }
  addGhostPad(bin, track.children.front(), "sink");
  addGhostPad(bin, track.children.back(), "src");
}

void initClass(gpointer klass, gpointer) {
  parentClass = g_type_class_peek_parent(klass);
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = setProperty;
  object->get_property = getProperty;
  object->finalize = finalize;
  installProperties(object, kProperties, &kDefaults);

  auto* element = GST_ELEMENT_CLASS(klass);
  gst_element_class_set_static_metadata(
      element, "Region tracking", "Filter/Analyzer/Video",
      "Finds, follows and describes what moves: bgremove, hsvsegment, srg, prmmotion and mrfmerge "
      "in one element, for applications that take one. Properties of the five are reached as "
      "CHILD::PROPERTY (bgremove::threshold=30). Attaches all their metas; pixels pass untouched",
      "The gst-regiongraph developers");
  gst_element_class_add_static_metadata(
      element, "example",
      "gst-launch-1.0 -q videotestsrc pattern=ball num-buffers=100 ! video/x-raw,format=I420 ! "
      "regiontrack bgremove::threshold=30 ! regionwrite ! fakesink");
  GstCaps* caps = gst_caps_from_string(kPixelCaps);
  for (const auto& [name, direction] : {std::pair{"sink", GST_PAD_SINK}, {"src", GST_PAD_SRC}})
    gst_element_class_add_pad_template(element,
                                       gst_pad_template_new(name, direction, GST_PAD_ALWAYS, caps));
  gst_caps_unref(caps);
}

GType registerTrack() {
  GTypeInfo info{};
  info.class_size = sizeof(GstBinClass);
  info.class_init = initClass;
  info.instance_size = sizeof(Instance);
  info.instance_init = initInstance;
  return g_type_register_static(GST_TYPE_BIN, "GstRegionTrack", &info, static_cast<GTypeFlags>(0));
}

}  // namespace
}  // namespace rg

GType gst_region_track_get_type() {
  static const GType type = rg::registerTrack();
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(regiontrack, "regiontrack", GST_RANK_NONE, gst_region_track_get_type())
