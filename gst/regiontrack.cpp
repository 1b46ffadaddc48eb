// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-regiontrack
 * @title: regiontrack
 *
 * bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge in one element, for applications that take
 * one. Its properties are those of the five, under their own names; one that several have is set
 * for all of them, but for method, which is bgremove's. camera is auto here: while the camera moves
 * the whole frame is divided, as hsvsegment does without bgremove, unless scope says otherwise.
 *
 * The children have the names of their elements and can be reached through GstChildProxy as well
 * (prmmotion::method); one that is none is an error when the bin starts. Element messages come from
 * the children.
 *
 * |[
 * gst-launch-1.0 -q filesrc location=clip.avi ! decodebin ! videoconvert !
 *   regiontrack threshold=30 max-lost-time=4 ! regionwrite ! fakesink
 * ]|
 */
#include "core/background/background.hpp"
#include "gst/elements.hpp"
#include "gst/support/filter.hpp"
#include "gst/support/properties.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <string_view>
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

/// A property of some of the children, which the bin has too.
struct Proxied {
  const Property* property = nullptr;
  std::array<bool, kChildren.size()> isOf{};
};

/// Filled with the class. In an array, as there may be no memory.
struct ProxiedList {
  std::array<Proxied, 64> list;
  guint count = 0;
};
ProxiedList proxied;

struct RegionTrack {
  std::mutex mutex;     ///< Protects `unknown`; nothing is called while it is held.
  std::string unknown;  ///< Asked for as a child, which there is none of.
  std::array<GstElement*, kChildren.size()> children{};  ///< The bin owns them.
};

/// Unlike bgremove by itself, behind which a mask is all that there may be.
constexpr const char* kCamera = "camera";
constexpr auto kCameraDefault = static_cast<int>(background::Camera::Auto);

/// What is in the instance itself needs no memory of its own: to make one can't fail.
struct Instance {
  GstBin parent;
  RegionTrack track;
};

gpointer parentClass = nullptr;

RegionTrack& trackOf(gpointer instance) {
  return reinterpret_cast<Instance*>(instance)->track;
}

/// The children that have a property, in their order; no more of them once visit() says false.
template <class Visit>
void visitChildren(GObject* bin, guint id, Visit visit) {
  const auto& isOf = proxied.list[id - 1].isOf;
  for (size_t i = 0; i < isOf.size(); ++i)
    if (isOf[i] && !visit(G_OBJECT(trackOf(bin).children[i]))) return;
}

/// Children refuse alike: what one has refused is not told to the others.
void setProperty(GObject* object, guint id, const GValue* value, GParamSpec* spec) {
  visitChildren(object, id, [&](GObject* child) {
    g_object_set_property(child, spec->name, value);
    GValue set = G_VALUE_INIT;
    g_value_init(&set, spec->value_type);
    g_object_get_property(child, spec->name, &set);
    const bool isTaken = g_param_values_cmp(spec, value, &set) == 0;
    g_value_unset(&set);
    return isTaken;
  });
}

/// What a frame took in all stages. Frames are those of the last one; those without a result of the
/// stage that had most, as a frame that one skips the others may skip, too.
GstStructure* sumOfStats(GObject* bin) {
  GstStructure* sum = nullptr;
  double mean = 0, worst = 0;
  guint64 dropped = 0;
  for (GstElement* child : trackOf(bin).children) {
    g_clear_pointer(&sum, gst_structure_free);
    g_object_get(child, "stats", &sum, nullptr);
    double ofMean = 0, ofWorst = 0;
    guint64 ofDropped = 0;
    gst_structure_get(sum, "dropped", G_TYPE_UINT64, &ofDropped, "ms-mean", G_TYPE_DOUBLE, &ofMean,
                      "ms-worst", G_TYPE_DOUBLE, &ofWorst, nullptr);
    dropped = std::max(dropped, ofDropped);
    mean += ofMean;
    worst += ofWorst;
  }
  gst_structure_set(sum, "dropped", G_TYPE_UINT64, dropped, "ms-mean", G_TYPE_DOUBLE, mean,
                    "ms-worst", G_TYPE_DOUBLE, worst, nullptr);
  return sum;
}

void getProperty(GObject* object, guint id, GValue* value, GParamSpec* spec) {
  if (id > proxied.count) return g_value_take_boxed(value, sumOfStats(object));
  visitChildren(object, id, [&](GObject* child) {
    g_object_get_property(child, spec->name, value);
    return false;
  });
}

void finalize(GObject* object) {
  std::destroy_at(&trackOf(object));
  G_OBJECT_CLASS(parentClass)->finalize(object);
}

/// The properties of the children that can be set; one that several have is one here, but for an
/// enum of another type (method): that is the first child's. Nobody steps their controllers.
void installProxied(GObjectClass* klass) {
  for (size_t i = 0; i < kChildren.size(); ++i) {
    const FilterDescription& about = descriptionOf(kChildren[i].type());
    for (const Property& property : about.properties) {
      if (property.when == Mutable::Never) continue;
      Proxied* const end = proxied.list.data() + proxied.count;
      Proxied* const known = std::find_if(proxied.list.data(), end, [&](const Proxied& other) {
        return std::string_view(other.property->name) == property.name;
      });
      if (known != end && known->property->enumType != property.enumType) continue;
      known->isOf[i] = true;
      if (known != end) continue;
      ++proxied.count;
      g_assert(proxied.count < proxied.list.size());
      known->property = &property;
      const auto flags = static_cast<GParamFlags>(flagsOf(property.when) & ~GST_PARAM_CONTROLLABLE);
      GParamSpec* spec = property.makeSpec(property, about.defaults, flags);
      if (std::string_view(property.name) == kCamera)
        G_PARAM_SPEC_ENUM(spec)->default_value = kCameraDefault;
      g_object_class_install_property(klass, proxied.count, spec);
    }
  }
}

/// Behind the children's.
void installStats(GObjectClass* klass) {
  g_object_class_install_property(
      klass, proxied.count + 1,
      g_param_spec_boxed("stats", "stats",
                         "Since the start: frames (guint64) that left, dropped (guint64: those "
                         "that a stage had no "
                         "result for), ms-mean (double: what the five stages took for a frame, "
                         "together) and ms-worst "
                         "(double: the sum of the stages' worst, which no frame took more than)",
                         GST_TYPE_STRUCTURE, flagsOf(Mutable::Never)));
}

/// A launch line or an application that sets a property of a child that is none would wait for it
/// for ever.
GObject* getChildByName(GstChildProxy* proxy, const gchar* name) {
  auto* parent = static_cast<GstChildProxyInterface*>(
      g_type_interface_peek_parent(GST_CHILD_PROXY_GET_INTERFACE(proxy)));
  GObject* child = parent->get_child_by_name(proxy, name);
  if (child) return child;
  RegionTrack& track = trackOf(proxy);
  try {
    const std::lock_guard lock(track.mutex);
    track.unknown = name;
  } catch (...) {  // No memory to tell of it.
  }
  return nullptr;
}

bool knowsItsChildren(GstElement* bin) {
  std::string unknown;
  {
    RegionTrack& track = trackOf(bin);
    const std::lock_guard lock(track.mutex);
    unknown.swap(track.unknown);
  }
  if (unknown.empty()) return true;
  GST_ELEMENT_ERROR(bin, RESOURCE, SETTINGS,
                    ("There is no child \"%s\" whose property could be set: the children are "
                     "bgremove, hsvsegment, srg, prmmotion and mrfmerge.",
                     unknown.c_str()),
                    (nullptr));
  return false;
}

GstStateChangeReturn changeState(GstElement* bin, GstStateChange change) {
  if (change == GST_STATE_CHANGE_NULL_TO_READY && !knowsItsChildren(bin))
    return GST_STATE_CHANGE_FAILURE;
  return GST_ELEMENT_CLASS(parentClass)->change_state(bin, change);
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
  g_object_set(track.children.front(), kCamera, kCameraDefault, nullptr);
  addGhostPad(bin, track.children.front(), "sink");
  addGhostPad(bin, track.children.back(), "src");
}

void initClass(gpointer klass, gpointer) {
  parentClass = g_type_class_peek_parent(klass);
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = setProperty;
  object->get_property = getProperty;
  object->finalize = finalize;
  installProxied(object);
  installStats(object);

  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = changeState;
  gst_element_class_set_static_metadata(
      element, "Region tracking", "Filter/Analyzer/Video",
      "Finds, follows and describes what moves: bgremove, hsvsegment, srg, prmmotion and mrfmerge "
      "in one element, for applications that take one. Properties of the five have their own names "
      "here too (threshold=30, or bgremove::threshold=30). Attaches all their metas; pixels pass "
      "untouched. Frames have at most 35389440 pixels (8192x4320)",
      "The gst-regiongraph developers");
  gst_element_class_add_static_metadata(
      element, "example",
      "gst-launch-1.0 -q videotestsrc pattern=ball num-buffers=100 ! video/x-raw,format=I420 ! "
      "regiontrack threshold=30 ! regionwrite ! fakesink");
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
  const GType type =
      g_type_register_static(GST_TYPE_BIN, "GstRegionTrack", &info, static_cast<GTypeFlags>(0));
  GInterfaceInfo proxy{};
  proxy.interface_init = [](gpointer interface, gpointer) {
    static_cast<GstChildProxyInterface*>(interface)->get_child_by_name = getChildByName;
  };
  g_type_add_interface_static(type, GST_TYPE_CHILD_PROXY, &proxy);
  return type;
}

}  // namespace
}  // namespace rg

GType gst_region_track_get_type() {
  static const GType type = rg::registerTrack();
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(regiontrack, "regiontrack", GST_RANK_NONE, gst_region_track_get_type())
