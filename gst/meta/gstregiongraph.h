/* SPDX-License-Identifier: LGPL-2.1-or-later */
/**
 * SECTION:gstregiongraph
 * @title: Region graph metas
 * @short_description: what the regiongraph elements say of a frame, as metas on its buffer
 *
 * bgremove attaches a foreground meta, hsvsegment labels, srg a graph, prmmotion motion, mrfmerge
 * objects. A meta is immutable; copies and scaled versions of the buffer share it, cropped ones
 * lose it. Coordinates are pixels of the frame that was analysed, whose size each meta tells: on a
 * buffer that was scaled since, multiply by the ratio of the sizes.
 *
 * The functions may be called from any thread while the buffer is alive. An index out of range
 * gives FALSE and leaves the output as it was.
 *
 * Since: 0.1, but for what says otherwise.
 */
#ifndef GST_REGION_GRAPH_H
#define GST_REGION_GRAPH_H

#include "gstregiontypes.h"
#include "gstregionversion.h"

#include <gst/gst.h>

G_BEGIN_DECLS

/**
 * gst_buffer_get_region_foreground_meta:
 * @buffer: a buffer that passed bgremove
 *
 * Returns: (transfer none) (nullable): what bgremove says of it
 */
GST_REGION_API GstRegionForegroundMeta* gst_buffer_get_region_foreground_meta(GstBuffer* buffer);
/**
 * gst_buffer_get_region_labels_meta:
 * @buffer: a buffer that passed hsvsegment
 *
 * Returns: (transfer none) (nullable): what hsvsegment says of it
 */
GST_REGION_API GstRegionLabelsMeta* gst_buffer_get_region_labels_meta(GstBuffer* buffer);
/**
 * gst_buffer_get_region_graph_meta:
 * @buffer: a buffer that passed srg
 *
 * Returns: (transfer none) (nullable): what srg says of it
 */
GST_REGION_API GstRegionGraphMeta* gst_buffer_get_region_graph_meta(GstBuffer* buffer);
/**
 * gst_buffer_get_region_motion_meta:
 * @buffer: a buffer that passed prmmotion
 *
 * Returns: (transfer none) (nullable): what prmmotion says of it
 */
GST_REGION_API GstRegionMotionMeta* gst_buffer_get_region_motion_meta(GstBuffer* buffer);
/**
 * gst_buffer_get_region_objects_meta:
 * @buffer: a buffer that passed mrfmerge
 *
 * Returns: (transfer none) (nullable): what mrfmerge says of it
 */
GST_REGION_API GstRegionObjectsMeta* gst_buffer_get_region_objects_meta(GstBuffer* buffer);

/**
 * gst_region_foreground_meta_get_status:
 * @meta: a foreground meta
 * @width: (out) (optional): width of the analysed frame
 * @height: (out) (optional): height of the analysed frame
 *
 * Returns: how far the result can be relied on
 */
GST_REGION_API GstRegionStatus gst_region_foreground_meta_get_status(GstRegionForegroundMeta* meta,
                                                                     gint* width, gint* height);
/**
 * gst_region_foreground_meta_get_scene_event:
 * @meta: a foreground meta
 * @shift_x: (out) (optional): how many pixels the camera looks off to the right of its place
 * @shift_y: (out) (optional): the same downwards
 *
 * Returns: what happened to the scene as a whole in this very frame
 */
GST_REGION_API GstRegionSceneEvent gst_region_foreground_meta_get_scene_event(
    GstRegionForegroundMeta* meta, gint* shift_x, gint* shift_y);
/**
 * gst_region_foreground_meta_is_camera_moving:
 * @meta: a foreground meta
 *
 * Returns: whether the camera moves, as bgremove's property camera has it: nothing is foreground
 * then. FALSE in skipped frames
 *
 * Since: 0.2
 */
GST_REGION_API gboolean gst_region_foreground_meta_is_camera_moving(GstRegionForegroundMeta* meta);
/**
 * gst_region_foreground_meta_get_n_areas:
 * @meta: a foreground meta
 *
 * Returns: how many connected parts the foreground has
 */
GST_REGION_API guint gst_region_foreground_meta_get_n_areas(GstRegionForegroundMeta* meta);
/**
 * gst_region_foreground_meta_get_area:
 * @meta: a foreground meta
 * @index: 0 to the number of areas - 1
 * @box: (out caller-allocates): bounding box of one connected part
 *
 * Returns: FALSE when @index is out of range
 */
GST_REGION_API gboolean gst_region_foreground_meta_get_area(GstRegionForegroundMeta* meta,
                                                            guint index, GstRegionBox* box);
/**
 * gst_region_foreground_meta_map:
 * @meta: a foreground meta
 * @plane: (out caller-allocates): 8 bits a pixel: 0 background, 128 shadow, 255 foreground
 * @error: why it failed
 *
 * Returns: FALSE when there is no mask (status skipped)
 */
GST_REGION_API gboolean gst_region_foreground_meta_map(GstRegionForegroundMeta* meta,
                                                       GstRegionPlane* plane, GError** error);

/**
 * gst_region_labels_meta_get_status:
 * @meta: a labels meta
 * @width: (out) (optional): width of the analysed frame
 * @height: (out) (optional): height of the analysed frame
 *
 * Returns: how far the result can be relied on
 */
GST_REGION_API GstRegionStatus gst_region_labels_meta_get_status(GstRegionLabelsMeta* meta,
                                                                 gint* width, gint* height);
/**
 * gst_region_labels_meta_get_scope:
 * @meta: a labels meta
 *
 * Returns: which pixels have a region
 */
GST_REGION_API GstRegionScope gst_region_labels_meta_get_scope(GstRegionLabelsMeta* meta);
/**
 * gst_region_labels_meta_get_n_regions:
 * @meta: a labels meta
 *
 * Returns: how many regions there are; their labels are 1 to this number
 */
GST_REGION_API guint gst_region_labels_meta_get_n_regions(GstRegionLabelsMeta* meta);
/**
 * gst_region_labels_meta_map:
 * @meta: a labels meta
 * @plane: (out caller-allocates): 16 bits a pixel: its region's label, 0 = none
 * @error: why it failed
 *
 * Returns: FALSE when there are no labels (status skipped)
 */
GST_REGION_API gboolean gst_region_labels_meta_map(GstRegionLabelsMeta* meta, GstRegionPlane* plane,
                                                   GError** error);

/**
 * gst_region_graph_meta_get_status:
 * @meta: a graph meta
 * @width: (out) (optional): width of the analysed frame
 * @height: (out) (optional): height of the analysed frame
 *
 * Returns: how far the result can be relied on
 */
GST_REGION_API GstRegionStatus gst_region_graph_meta_get_status(GstRegionGraphMeta* meta,
                                                                gint* width, gint* height);
/**
 * gst_region_graph_meta_get_n_regions:
 * @meta: a graph meta
 *
 * Returns: how many regions there are
 */
GST_REGION_API guint gst_region_graph_meta_get_n_regions(GstRegionGraphMeta* meta);
/**
 * gst_region_graph_meta_get_region:
 * @meta: a graph meta
 * @index: 0 to the number of regions - 1: the region with label @index + 1
 * @region: (out caller-allocates): its attributes
 *
 * Returns: FALSE when @index is out of range
 */
GST_REGION_API gboolean gst_region_graph_meta_get_region(GstRegionGraphMeta* meta, guint index,
                                                         GstRegion* region);
/**
 * gst_region_get_box:
 * @region: what gst_region_graph_meta_get_region() filled in
 * @x: (out) (optional): left column
 * @y: (out) (optional): top row
 * @width: (out) (optional): columns
 * @height: (out) (optional): rows
 *
 * Its box as plain numbers, for languages in which a struct inside another one does not outlive it.
 *
 * Since: 0.2
 */
GST_REGION_API void gst_region_get_box(const GstRegion* region, gint* x, gint* y, gint* width,
                                       gint* height);
/**
 * gst_region_get_colour:
 * @region: what gst_region_graph_meta_get_region() filled in
 * @red: (out) (optional): 0 to 255
 * @green: (out) (optional): 0 to 255
 * @blue: (out) (optional): 0 to 255
 *
 * Its colour as plain numbers.
 *
 * Since: 0.2
 */
GST_REGION_API void gst_region_get_colour(const GstRegion* region, guint8* red, guint8* green,
                                          guint8* blue);
/**
 * gst_region_graph_meta_get_n_arcs:
 * @meta: a graph meta
 *
 * Returns: how many pairs of regions touch
 */
GST_REGION_API guint gst_region_graph_meta_get_n_arcs(GstRegionGraphMeta* meta);
/**
 * gst_region_graph_meta_get_arc:
 * @meta: a graph meta
 * @index: 0 to the number of arcs - 1, sorted by the labels
 * @arc: (out caller-allocates): its attributes
 *
 * Returns: FALSE when @index is out of range
 */
GST_REGION_API gboolean gst_region_graph_meta_get_arc(GstRegionGraphMeta* meta, guint index,
                                                      GstRegionArc* arc);

/**
 * gst_region_motion_meta_get_status:
 * @meta: a motion meta
 * @width: (out) (optional): width of the analysed frame
 * @height: (out) (optional): height of the analysed frame
 *
 * Returns: how far the result can be relied on; skipped where there is no previous frame
 */
GST_REGION_API GstRegionStatus gst_region_motion_meta_get_status(GstRegionMotionMeta* meta,
                                                                 gint* width, gint* height);
/**
 * gst_region_motion_meta_get_n_regions:
 * @meta: a motion meta
 *
 * Returns: how many regions there are
 */
GST_REGION_API guint gst_region_motion_meta_get_n_regions(GstRegionMotionMeta* meta);
/**
 * gst_region_motion_meta_get_vector:
 * @meta: a motion meta
 * @index: 0 to the number of regions - 1: the region with label @index + 1
 * @vector: (out caller-allocates): how it moved
 *
 * Returns: FALSE when @index is out of range
 */
GST_REGION_API gboolean gst_region_motion_meta_get_vector(GstRegionMotionMeta* meta, guint index,
                                                          GstRegionVector* vector);

/**
 * gst_region_objects_meta_get_status:
 * @meta: an objects meta
 * @width: (out) (optional): width of the analysed frame
 * @height: (out) (optional): height of the analysed frame
 *
 * Returns: how far the result can be relied on
 */
GST_REGION_API GstRegionStatus gst_region_objects_meta_get_status(GstRegionObjectsMeta* meta,
                                                                  gint* width, gint* height);
/**
 * gst_region_objects_meta_get_n_objects:
 * @meta: an objects meta
 *
 * Returns: how many objects there are
 */
GST_REGION_API guint gst_region_objects_meta_get_n_objects(GstRegionObjectsMeta* meta);
/**
 * gst_region_objects_meta_get_object:
 * @meta: an objects meta
 * @index: 0 to the number of objects - 1, sorted by id
 * @object: (out caller-allocates): what is known of it
 *
 * Returns: FALSE when @index is out of range
 */
GST_REGION_API gboolean gst_region_objects_meta_get_object(GstRegionObjectsMeta* meta, guint index,
                                                           GstRegionObject* object);
/**
 * gst_region_object_get_box:
 * @object: what gst_region_objects_meta_get_object() filled in
 * @x: (out) (optional): left column
 * @y: (out) (optional): top row
 * @width: (out) (optional): columns
 * @height: (out) (optional): rows
 *
 * Its box as plain numbers, for languages in which a struct inside another one does not outlive it.
 *
 * Since: 0.2
 */
GST_REGION_API void gst_region_object_get_box(const GstRegionObject* object, gint* x, gint* y,
                                              gint* width, gint* height);
/**
 * gst_region_object_get_colour:
 * @object: what gst_region_objects_meta_get_object() filled in
 * @red: (out) (optional): 0 to 255
 * @green: (out) (optional): 0 to 255
 * @blue: (out) (optional): 0 to 255
 *
 * Its colour as plain numbers.
 *
 * Since: 0.2
 */
GST_REGION_API void gst_region_object_get_colour(const GstRegionObject* object, guint8* red,
                                                 guint8* green, guint8* blue);
/**
 * gst_region_objects_meta_get_parent:
 * @meta: an objects meta
 * @index: 0 to the number of objects - 1
 * @parent: 0 to the object's n_parents - 1
 *
 * Returns: the id of an object that it came from, 0 when an index is out of range
 */
GST_REGION_API guint64 gst_region_objects_meta_get_parent(GstRegionObjectsMeta* meta, guint index,
                                                          guint parent);
/**
 * gst_region_objects_meta_get_contour_point:
 * @meta: an objects meta
 * @index: 0 to the number of objects - 1
 * @point: 0 to the object's n_contour - 1, clockwise
 * @x: (out): column
 * @y: (out): row
 *
 * Returns: FALSE when an index is out of range
 */
GST_REGION_API gboolean gst_region_objects_meta_get_contour_point(GstRegionObjectsMeta* meta,
                                                                  guint index, guint point, gint* x,
                                                                  gint* y);
/**
 * gst_region_objects_meta_get_region_object:
 * @meta: an objects meta
 * @region: a label, from 1
 *
 * Returns: the id of the object that the region belongs to, 0 = none
 */
GST_REGION_API guint64 gst_region_objects_meta_get_region_object(GstRegionObjectsMeta* meta,
                                                                 guint region);
/**
 * gst_region_objects_meta_get_camera_motion:
 * @meta: an objects meta
 * @dx: (out): pixels that the middle of the background moved right since the previous frame
 * @dy: (out): pixels that the middle of the background moved downwards
 */
GST_REGION_API void gst_region_objects_meta_get_camera_motion(GstRegionObjectsMeta* meta,
                                                              gdouble* dx, gdouble* dy);
/**
 * gst_region_objects_meta_get_camera_matrix:
 * @meta: an objects meta
 *
 * The homography m: background at pixel (x, y) was at ((m0 x + m1 y + m2) / w, (m3 x + m4 y + m5)
 * / w) in the frame before, w = m6 x + m7 y + m8; (0, 0) is the middle of the left upper pixel.
 *
 * Returns: (transfer full) (array fixed-size=9): m, row by row, m8 is 1; g_free() frees it
 *
 * Since: 0.2
 */
GST_REGION_API gdouble* gst_region_objects_meta_get_camera_matrix(GstRegionObjectsMeta* meta);
/**
 * gst_region_objects_meta_map:
 * @meta: an objects meta
 * @plane: (out caller-allocates): 16 bits a pixel: 1 + index of its object, 0 = none
 * @error: why it failed
 *
 * Returns: FALSE when there are no objects (status skipped)
 */
GST_REGION_API gboolean gst_region_objects_meta_map(GstRegionObjectsMeta* meta,
                                                    GstRegionPlane* plane, GError** error);

/**
 * gst_region_plane_get_bytes:
 * @plane: what a map function filled in
 *
 * The pixels for whoever can't walk along @plane's data, or reads them later: one row after the
 * other, width * pixel_bytes bytes each, without what lies between rows in @plane. They stay as
 * they are for as long as the bytes are kept, also when @plane is unmapped and the buffer is gone.
 * Rows that have nothing between them are not copied.
 *
 * Returns: (transfer full) (nullable): the pixels; NULL when @plane is not mapped or memory is out
 *
 * Since: 0.2
 */
GST_REGION_API GBytes* gst_region_plane_get_bytes(const GstRegionPlane* plane);
/**
 * gst_region_plane_unmap:
 * @plane: what a map function filled in
 *
 * Ends the use of a plane. Does nothing for a plane that is not mapped.
 */
GST_REGION_API void gst_region_plane_unmap(GstRegionPlane* plane);

G_END_DECLS

#endif
