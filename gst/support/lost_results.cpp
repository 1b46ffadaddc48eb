// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/lost_results.hpp"

#include <gst/base/gstbasetransform.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <vector>

namespace rg {
namespace {

constexpr int kMostElements = 100;  // Of a way upstream.

/// Elements of GStreamer that keep metas though they may make new frames, or that look as if.
constexpr std::array<std::string_view, 12> kKeepers{
    "capsfilter", "deinterlace", "identity",  "multiqueue",   "queue",      "queue2",
    "tee",        "valve",       "videorate", "videoconvert", "videoscale", "videoconvertscale"};

struct Unref {
  void operator()(gpointer object) const { gst_object_unref(object); }
};
using PadPtr = std::unique_ptr<GstPad, Unref>;
using ElementPtr = std::unique_ptr<GstElement, Unref>;

GQuark nameQuark() {
  static const GQuark quark = g_quark_from_static_string("regiongraph-element");
  return quark;
}

std::string nameOf(GstElement* element) {
  gchar* name = gst_object_get_name(GST_OBJECT(element));
  std::string text = name;
  g_free(name);
  return text;
}

bool isOurs(GstElement* element) {
  return g_type_get_qdata(G_OBJECT_TYPE(element), nameQuark()) != nullptr;
}

bool is(GstElement* element, std::string_view name) {
  const auto* marked =
      static_cast<const char*>(g_type_get_qdata(G_OBJECT_TYPE(element), nameQuark()));
  return marked && name == marked;
}

bool mayLoseMetas(GstElement* element) {
  if (isOurs(element)) return false;
  if (GST_IS_BASE_TRANSFORM(element)) {
    auto* transform = GST_BASE_TRANSFORM(element);
    if (gst_base_transform_is_passthrough(transform) || gst_base_transform_is_in_place(transform))
      return false;
  }
  const GstElementFactory* factory = gst_element_get_factory(element);
  return !factory ||
         std::find(kKeepers.begin(), kKeepers.end(), GST_OBJECT_NAME(factory)) == kKeepers.end();
}

/// The element's pad that frames come from, through the walls of bins; null without one.
PadPtr sourceOf(GstPad* sink) {
  PadPtr pad(gst_pad_get_peer(sink));
  for (int walls = 0; pad && walls < kMostElements; ++walls) {
    if (GST_IS_GHOST_PAD(pad.get())) {
      pad.reset(gst_ghost_pad_get_target(GST_GHOST_PAD(pad.get())));
    } else if (GST_IS_PROXY_PAD(pad.get())) {
      const PadPtr ghost(GST_PAD(gst_proxy_pad_get_internal(GST_PROXY_PAD(pad.get()))));
      pad.reset(ghost ? gst_pad_get_peer(ghost.get()) : nullptr);
    } else {
      return pad;
    }
  }
  return nullptr;
}

std::vector<PadPtr> sinksOf(GstElement* element) {
  std::vector<PadPtr> pads;
  GST_OBJECT_LOCK(element);
  for (const GList* item = element->sinkpads; item; item = item->next)
    pads.emplace_back(GST_PAD(gst_object_ref(item->data)));
  GST_OBJECT_UNLOCK(element);
  return pads;
}

/// The way from a producer to an element.
struct Way {
  std::string producer;
  std::vector<std::string> suspects;  ///< Those on it that may have lost metas, the first first.
};

bool find(GstElement* element, std::string_view producer, int depth, Way& way) {
  if (depth == 0) return false;
  for (const PadPtr& sink : sinksOf(element)) {
    const PadPtr source = sourceOf(sink.get());
    const ElementPtr upstream(source ? gst_pad_get_parent_element(source.get()) : nullptr);
    if (!upstream) continue;
    if (is(upstream.get(), producer)) {
      way.producer = nameOf(upstream.get());
      return true;
    }
    if (!find(upstream.get(), producer, depth - 1, way)) continue;
    if (mayLoseMetas(upstream.get())) way.suspects.push_back(nameOf(upstream.get()));
    return true;
  }
  return false;
}

}  // namespace

void nameType(GType type, const char* name) {
  g_type_set_qdata(type, nameQuark(), const_cast<char*>(name));
}

std::string whyMissing(GstElement* element, const char* producer) {
  Way way;
  const std::string who = producer;
  if (!find(element, producer, kMostElements, way))
    return "No result of " + who + " on the frames: add " + who +
           " to the pipeline before this element.";
  std::string where;
  for (const std::string& suspect : way.suspects) where += (where.empty() ? "" : " or ") + suspect;
  if (where.empty()) where = "an element between";
  return "The results of " + who + " were lost after " + way.producer + ", at " + where +
         ", which makes new frames without them: put it in front of the first stage, or behind " +
         nameOf(element) + ".";
}

}  // namespace rg
