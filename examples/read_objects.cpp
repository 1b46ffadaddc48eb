// SPDX-License-Identifier: LGPL-2.1-or-later
// An application that reads the objects of a video through the public header.
//
// usage: read_objects VIDEO
// Against an installed copy:
//   g++ read_objects.cpp $(pkg-config --cflags --libs gstregiongraph-1.0 gstreamer-app-1.0)
#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gstregiongraph.h>

#include <cstdio>
#include <memory>

namespace {

constexpr char kPipeline[] =
    "filesrc name=file ! decodebin ! videoconvert ! "
    "bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! "
    "appsink name=sink sync=false max-buffers=4";

struct Unref {
  void operator()(gpointer object) const { gst_object_unref(object); }
  void operator()(GstSample* sample) const { gst_sample_unref(sample); }
  void operator()(GstMessage* message) const { gst_message_unref(message); }
  void operator()(GError* error) const { g_error_free(error); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref>;

const char* nameOf(GstRegionObjectState state) {
  switch (state) {
    case GST_REGION_OBJECT_STATE_NEW:
      return "new";
    case GST_REGION_OBJECT_STATE_TRACKED:
      return "tracked";
    case GST_REGION_OBJECT_STATE_STOPPED:
      return "stopped";
    case GST_REGION_OBJECT_STATE_OCCLUDED:
      return "occluded";
    case GST_REGION_OBJECT_STATE_LOST:
      return "lost";
  }
  return "unknown";
}

void printObjects(int frame, GstBuffer* buffer) {
  GstRegionObjectsMeta* meta = gst_buffer_get_region_objects_meta(buffer);
  if (!meta) return;
  const guint count = gst_region_objects_meta_get_n_objects(meta);
  for (guint i = 0; i < count; ++i) {
    GstRegionObject object;
    if (!gst_region_objects_meta_get_object(meta, i, &object)) continue;
    std::printf("frame %d  object %" G_GUINT64_FORMAT "  %s  %dx%d at %d,%d", frame, object.id,
                nameOf(object.state), object.box.width, object.box.height, object.box.x,
                object.box.y);
    if (object.has_velocity) std::printf("  %.1f,%.1f px/s", object.velocity_x, object.velocity_y);
    std::printf("\n");
  }
}

/// Prints the pipeline's error, if it has one.
bool hasFailed(GstBus* bus) {
  const Owned<GstMessage> message(gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR));
  if (!message) return false;
  GError* error = nullptr;
  gst_message_parse_error(message.get(), &error, nullptr);
  const Owned<GError> owned(error);
  std::fprintf(stderr, "read_objects: %s\n", error->message);
  return true;
}

/// Prints the objects of every frame until the stream ends; false when it ended by an error.
bool readAll(GstAppSink* sink, GstBus* bus) {
  for (int frame = 1; !gst_app_sink_is_eos(sink);) {
    // Not every error reaches the sink as an end, so the bus is looked at whenever nothing comes.
    const Owned<GstSample> sample(gst_app_sink_try_pull_sample(sink, GST_SECOND / 10));
    if (sample)
      printObjects(frame++, gst_sample_get_buffer(sample.get()));
    else if (hasFailed(bus))
      return false;
  }
  return !hasFailed(bus);
}

int run(const char* video) {
  GError* error = nullptr;
  const Owned<GstElement> pipeline(gst_parse_launch(kPipeline, &error));
  if (error) {
    const Owned<GError> owned(error);
    std::fprintf(stderr, "read_objects: %s\n", error->message);
    return 1;
  }
  const Owned<GstElement> file(gst_bin_get_by_name(GST_BIN(pipeline.get()), "file"));
  const Owned<GstElement> sink(gst_bin_get_by_name(GST_BIN(pipeline.get()), "sink"));
  g_object_set(file.get(), "location", video, nullptr);
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  const Owned<GstBus> bus(gst_element_get_bus(pipeline.get()));
  const bool isComplete = readAll(GST_APP_SINK(sink.get()), bus.get());
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  return isComplete ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: read_objects VIDEO\n");
    return 2;
  }
  gst_init(nullptr, nullptr);
  return run(argv[1]);
}
