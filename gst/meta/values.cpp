// SPDX-License-Identifier: LGPL-2.1-or-later
// Parts of the public values, for readers that can't keep a struct which lies inside another one.
#include "gst/meta/gstregiongraph.h"

namespace {

template <class Value>
void tellBox(const Value* value, gint* x, gint* y, gint* width, gint* height) {
  g_return_if_fail(value);
  if (x) *x = value->box.x;
  if (y) *y = value->box.y;
  if (width) *width = value->box.width;
  if (height) *height = value->box.height;
}

template <class Value>
void tellColour(const Value* value, guint8* red, guint8* green, guint8* blue) {
  g_return_if_fail(value);
  if (red) *red = value->colour.red;
  if (green) *green = value->colour.green;
  if (blue) *blue = value->colour.blue;
}

}  // namespace

void gst_region_get_box(const GstRegion* region, gint* x, gint* y, gint* width, gint* height) {
  tellBox(region, x, y, width, height);
}

void gst_region_get_colour(const GstRegion* region, guint8* red, guint8* green, guint8* blue) {
  tellColour(region, red, green, blue);
}

void gst_region_object_get_box(const GstRegionObject* object, gint* x, gint* y, gint* width,
                               gint* height) {
  tellBox(object, x, y, width, height);
}

void gst_region_object_get_colour(const GstRegionObject* object, guint8* red, guint8* green,
                                  guint8* blue) {
  tellColour(object, red, green, blue);
}
