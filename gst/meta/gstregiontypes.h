/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The metas, and the values that the functions of gstregiongraph.h read from them. */
#ifndef GST_REGION_TYPES_H
#define GST_REGION_TYPES_H

#include <glib-object.h>

G_BEGIN_DECLS

#ifndef GST_REGION_API
#define GST_REGION_API extern
#endif

/**
 * GstRegionStatus:
 * @GST_REGION_STATUS_OK: the result can be relied on
 * @GST_REGION_STATUS_TRAINING: the background is still being learnt
 * @GST_REGION_STATUS_SKIPPED: nothing was computed for this frame
 */
typedef enum {
  GST_REGION_STATUS_OK,
  GST_REGION_STATUS_TRAINING,
  GST_REGION_STATUS_SKIPPED
} GstRegionStatus;

/**
 * GstRegionSceneEvent:
 * @GST_REGION_SCENE_EVENT_NONE: nothing but what moves
 * @GST_REGION_SCENE_EVENT_LIGHT_SWITCHED: most of the picture changed its brightness at once
 * @GST_REGION_SCENE_EVENT_NIGHT_SWITCHED: the picture lost its colour, or got some
 * @GST_REGION_SCENE_EVENT_CAMERA_MOVED: another scene for good, also where the camera was covered
 * @GST_REGION_SCENE_EVENT_CAMERA_SHAKEN: the camera was pushed by a few pixels
 * @GST_REGION_SCENE_EVENT_TOO_DARK: from here on nothing can be seen
 * @GST_REGION_SCENE_EVENT_BRIGHT_AGAIN: the end of that
 * @GST_REGION_SCENE_EVENT_MODEL_LOST: a GPU was lost with the background model in it, which starts
 *   anew on the CPU
 * @GST_REGION_SCENE_EVENT_CAMERA_STARTED: from here on the camera moves, and nothing is foreground
 * @GST_REGION_SCENE_EVENT_CAMERA_STOPPED: the end of that
 */
typedef enum {
  GST_REGION_SCENE_EVENT_NONE,
  GST_REGION_SCENE_EVENT_LIGHT_SWITCHED,
  GST_REGION_SCENE_EVENT_NIGHT_SWITCHED,
  GST_REGION_SCENE_EVENT_CAMERA_MOVED,
  GST_REGION_SCENE_EVENT_CAMERA_SHAKEN,
  GST_REGION_SCENE_EVENT_TOO_DARK,
  GST_REGION_SCENE_EVENT_BRIGHT_AGAIN,
  GST_REGION_SCENE_EVENT_MODEL_LOST,
  GST_REGION_SCENE_EVENT_CAMERA_STARTED,
  GST_REGION_SCENE_EVENT_CAMERA_STOPPED
} GstRegionSceneEvent;

/**
 * GstRegionScope:
 * @GST_REGION_SCOPE_FRAME: every pixel has a region
 * @GST_REGION_SCOPE_FOREGROUND: only foreground pixels have one, the rest has label 0
 * @GST_REGION_SCOPE_AREAS: only pixels in and near the foreground's areas have one
 */
typedef enum {
  GST_REGION_SCOPE_FRAME,
  GST_REGION_SCOPE_FOREGROUND,
  GST_REGION_SCOPE_AREAS
} GstRegionScope;

/**
 * GstRegionObjectState:
 * @GST_REGION_OBJECT_STATE_NEW: seen too briefly to be trusted
 * @GST_REGION_OBJECT_STATE_TRACKED: seen and moving
 * @GST_REGION_OBJECT_STATE_STOPPED: seen and standing
 * @GST_REGION_OBJECT_STATE_OCCLUDED: hidden; its box is predicted
 * @GST_REGION_OBJECT_STATE_LOST: not seen for a while, may come back
 */
typedef enum {
  GST_REGION_OBJECT_STATE_NEW,
  GST_REGION_OBJECT_STATE_TRACKED,
  GST_REGION_OBJECT_STATE_STOPPED,
  GST_REGION_OBJECT_STATE_OCCLUDED,
  GST_REGION_OBJECT_STATE_LOST
} GstRegionObjectState;

/**
 * GstRegionBox:
 * @x: left column
 * @y: top row
 * @width: columns
 * @height: rows
 */
typedef struct {
  gint x, y, width, height;
} GstRegionBox;

/**
 * GstRegionColour:
 * @red: 0 to 255
 * @green: 0 to 255
 * @blue: 0 to 255
 */
typedef struct {
  guint8 red, green, blue;
} GstRegionColour;

/**
 * GstRegionPlane:
 * @data: the first row; gst_region_plane_get_bytes() is for languages without pointers
 * @width: pixels in a row
 * @height: rows
 * @stride: bytes from one row to the next
 * @pixel_bytes: 1 (guint8) or 2 (guint16 of the machine's byte order)
 *
 * Pixels of a meta between map and unmap. Valid until unmap, also when the buffer is gone.
 */
typedef struct {
  gconstpointer data;
  gint width, height, stride;
  guint pixel_bytes;
  /*< private >*/
  gpointer _private[4];
} GstRegionPlane;

/**
 * GstRegion:
 * @id: its label, from 1
 * @area: pixels
 * @box: bounding box
 * @centroid_x: mean column of its pixels
 * @centroid_y: mean row of its pixels
 * @colour: mean colour
 */
typedef struct {
  guint id;
  guint area;
  GstRegionBox box;
  gdouble centroid_x, centroid_y;
  GstRegionColour colour;
  /*< private >*/
  gpointer _reserved[4];
} GstRegion;

/**
 * GstRegionArc:
 * @a: label of one region
 * @b: label of the other, larger than @a
 * @border: pairs of neighbouring pixels across the border
 * @contrast: mean over these pairs of the largest channel difference, in grey levels
 */
typedef struct {
  guint a, b;
  guint border;
  gdouble contrast;
  /*< private >*/
  gpointer _reserved[4];
} GstRegionArc;

/**
 * GstRegionVector:
 * @dx: pixels to the right since the previous frame
 * @dy: pixels downwards since the previous frame
 * @sad: sum of absolute differences at the best whole-pixel shift
 * @reliability: 0 (says nothing) to 1
 */
typedef struct {
  gdouble dx, dy;
  guint64 sad;
  gdouble reliability;
  /*< private >*/
  gpointer _reserved[4];
} GstRegionVector;

/**
 * GstRegionObject:
 * @id: its number, from 1, never used again within a stream
 * @state: what is known of it
 * @box: full extent, hidden parts included; may leave the frame
 * @area: pixels that belong to it in this frame
 * @centroid_x: mean column of its pixels
 * @centroid_y: mean row of its pixels
 * @has_velocity: whether the stream has times, and so the object a velocity
 * @velocity_x: pixels per second to the right
 * @velocity_y: pixels per second downwards
 * @age: frames since it was first seen
 * @colour: mean colour
 * @n_parents: objects that it came from by a merge or a split
 * @n_contour: points of its contour
 */
typedef struct {
  guint64 id;
  GstRegionObjectState state;
  GstRegionBox box;
  guint area;
  gdouble centroid_x, centroid_y;
  gboolean has_velocity;
  gdouble velocity_x, velocity_y;
  guint age;
  GstRegionColour colour;
  guint n_parents;
  guint n_contour;
  /*< private >*/
  gpointer _reserved[4];
} GstRegionObject;

typedef struct _GstRegionForegroundMeta GstRegionForegroundMeta;
typedef struct _GstRegionLabelsMeta GstRegionLabelsMeta;
typedef struct _GstRegionGraphMeta GstRegionGraphMeta;
typedef struct _GstRegionMotionMeta GstRegionMotionMeta;
typedef struct _GstRegionObjectsMeta GstRegionObjectsMeta;

/* The metas' types, for allocation queries and for iterating over a buffer's metas. From GStreamer
 * 1.24 on metas go along with buffers to other processes; who receives them without an element of
 * the plugin asks for the types first. */
GST_REGION_API GType gst_region_foreground_meta_api_get_type(void);
GST_REGION_API GType gst_region_labels_meta_api_get_type(void);
GST_REGION_API GType gst_region_graph_meta_api_get_type(void);
GST_REGION_API GType gst_region_motion_meta_api_get_type(void);
GST_REGION_API GType gst_region_objects_meta_api_get_type(void);

G_END_DECLS

#endif
