// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/elements.hpp"
#include "gst/meta/result_meta.hpp"

#include <gst/gst.h>

static gboolean pluginInit(GstPlugin* plugin) {
  rg::registerMetas();
  gboolean isComplete = TRUE;
  isComplete &= GST_ELEMENT_REGISTER(bgremove, plugin);
  isComplete &= GST_ELEMENT_REGISTER(hsvsegment, plugin);
  isComplete &= GST_ELEMENT_REGISTER(srg, plugin);
  isComplete &= GST_ELEMENT_REGISTER(prmmotion, plugin);
  isComplete &= GST_ELEMENT_REGISTER(mrfmerge, plugin);
  isComplete &= GST_ELEMENT_REGISTER(haardetect, plugin);
  isComplete &= GST_ELEMENT_REGISTER(regionmask, plugin);
  isComplete &= GST_ELEMENT_REGISTER(regiontext, plugin);
  isComplete &= GST_ELEMENT_REGISTER(regiontrack, plugin);
  isComplete &= GST_ELEMENT_REGISTER(regionwrite, plugin);
  return isComplete;
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, regiongraph,
                  "Finds, follows and describes what moves in surveillance video", pluginInit,
                  REGIONGRAPH_VERSION, "LGPL", "gst-regiongraph",
                  "https://gstreamer.freedesktop.org")
