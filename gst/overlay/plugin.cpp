// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/elements.hpp"
#include "gst/meta/result_meta.hpp"

#include <gst/gst.h>

static gboolean pluginInit(GstPlugin* plugin) {
  rg::registerMetas();
  return GST_ELEMENT_REGISTER(regionoverlay, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, regiongraphoverlay,
                  "Draws what the elements of regiongraph found", pluginInit, REGIONGRAPH_VERSION,
                  "LGPL", "gst-regiongraph", "https://gstreamer.freedesktop.org")
