// SPDX-License-Identifier: LGPL-2.1-or-later
// The element types of both plugins. regiontrack makes its children from them, not by the registry.
#pragma once

#include <gst/gst.h>

GType gst_region_bgremove_get_type();
GType gst_region_hsvsegment_get_type();
GType gst_region_srg_get_type();
GType gst_region_prmmotion_get_type();
GType gst_region_mrfmerge_get_type();
GType gst_region_haar_detect_get_type();
GType gst_region_mask_get_type();
GType gst_region_overlay_get_type();
GType gst_region_text_get_type();
GType gst_region_write_get_type();
GType gst_region_track_get_type();

GST_ELEMENT_REGISTER_DECLARE(bgremove)
GST_ELEMENT_REGISTER_DECLARE(hsvsegment)
GST_ELEMENT_REGISTER_DECLARE(srg)
GST_ELEMENT_REGISTER_DECLARE(prmmotion)
GST_ELEMENT_REGISTER_DECLARE(mrfmerge)
GST_ELEMENT_REGISTER_DECLARE(haardetect)
GST_ELEMENT_REGISTER_DECLARE(regionmask)
GST_ELEMENT_REGISTER_DECLARE(regionoverlay)
GST_ELEMENT_REGISTER_DECLARE(regionwrite)
GST_ELEMENT_REGISTER_DECLARE(regiontext)
GST_ELEMENT_REGISTER_DECLARE(regiontrack)
