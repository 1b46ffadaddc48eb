// SPDX-License-Identifier: LGPL-2.1-or-later
// What elements of others, which know nothing of ours, carry on and see. Some have come with newer
// versions of GStreamer than the oldest that this is built for.
#include "gst/meta/stored_result.hpp"
#include "tests/support/busy_scene.hpp"
#include "tests/support/written_lines.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;

/// Whether there is such an element with such a property.
bool has(const char* factory, const char* property) {
  GstElement* element = gst_element_factory_make(factory, nullptr);
  if (!element) return false;
  const bool isFound = g_object_class_find_property(G_OBJECT_GET_CLASS(element), property);
  gst_object_unref(element);
  return isFound;
}

using Bytes = std::vector<uint8_t>;

template <class... Payloads>
std::vector<Bytes> results(GstBuffer* buffer) {
  const auto bytesOf = [](const auto& result) { return result ? store(*result) : Bytes(); };
  return {bytesOf(findResult<Payloads>(buffer))...};
}

/// A launch line, and what was attached to the frames that came to its element "end".
class Listener {
 public:
  explicit Listener(const std::string& line) : pipeline_(gst_parse_launch(line.c_str(), nullptr)) {
    GstElement* end = gst_bin_get_by_name(GST_BIN(pipeline_), "end");
    GstPad* pad = gst_element_get_static_pad(end, "sink");
    gst_pad_add_probe(
        pad, GST_PAD_PROBE_TYPE_BUFFER,
        [](GstPad*, GstPadProbeInfo* info, gpointer self) {
          static_cast<Listener*>(self)->hear(GST_PAD_PROBE_INFO_BUFFER(info));
          return GST_PAD_PROBE_OK;
        },
        this, nullptr);
    gst_object_unref(pad);
    gst_object_unref(end);
  }
  ~Listener() { gst_object_unref(pipeline_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  void begin() { gst_element_set_state(pipeline_, GST_STATE_PLAYING); }
  GstMessageType playToEnd() { return testing::playToEnd(pipeline_); }

  std::vector<std::vector<Bytes>> frames;
  int objects = 0;

 private:
  void hear(GstBuffer* buffer) {
    frames.push_back(results<background::Foreground, segmentation::Labels, graph::Graph,
                             motion::Motion, objects::Objects>(buffer));
    objects += testing::objectsOn(buffer);
  }

  GstElement* pipeline_;
};

class OthersElements : public testing::WrittenLines {};

TEST_F(OthersElements, CarryAllResultsThroughASocket) {
  if (!has("unixfdsink", "wait-for-connection"))
    GTEST_SKIP() << "no unixfdsink here that waits for a reader";
  constexpr size_t kFrames = 40;
  const std::string socket = " socket-path=" + path_;
  Listener near("videotestsrc pattern=ball num-buffers=" + std::to_string(kFrames) +
                " ! video/x-raw,format=I420,width=160,height=120,framerate=25/1 ! " +
                testing::kQuickStages +
                " ! unixfdsink name=end sync=false "
                "wait-for-connection=true" +
                socket);
  Listener far("unixfdsrc" + socket + " ! fakesink name=end sync=false");
  near.begin();
  EXPECT_EQ(far.playToEnd(), GST_MESSAGE_EOS);
  EXPECT_EQ(near.playToEnd(), GST_MESSAGE_EOS);
  EXPECT_EQ(near.frames.size(), kFrames);
  EXPECT_GT(near.objects, 0);
  EXPECT_TRUE(far.frames == near.frames);
}

constexpr const char* kGreenLines =
    "objectdetectionoverlay draw-labels=false object-detection-outline-color=4278255360";

/// The places that are purely green, which no busy frame has by itself.
Image<uint8_t> greenOf(GstBuffer* buffer, const Caps& caps) {
  Image<uint8_t> green(Size{caps.width, caps.height});
  const std::vector<uint8_t> bgra = testing::bytesOf(buffer);
  for (int y = 0; y < caps.height; ++y)
    for (int x = 0; x < caps.width; ++x) {
      const uint8_t* at = &bgra[4 * static_cast<size_t>(y * caps.width + x)];
      green.at(x, y) = at[0] == 0 && at[1] == 255 && at[2] == 0;
    }
  return green;
}

/// Whether a place lies on a box's edge, or so far from it as a line is wide.
bool isOnEdge(const Box& box, Point at, int width) {
  const Box outer{box.x - width, box.y - width, box.width + 2 * width, box.height + 2 * width};
  const Box inner{box.x + 1 + width, box.y + 1 + width, box.width - 2 - 2 * width,
                  box.height - 2 - 2 * width};
  return outer.contains(at) && !inner.contains(at);
}

TEST(OthersElement, DrawsTheDetectionsWhereTheObjectsAre) {
#ifndef REGIONGRAPH_HAS_ANALYTICS
  GTEST_SKIP() << "built without GstAnalytics";
#endif
  if (!has("objectdetectionoverlay", "object-detection-outline-color"))
    GTEST_SKIP() << "no objectdetectionoverlay here";
  const Caps caps{"BGRA", 160, 120};
  Chain chain(std::string(testing::kQuickStages) + " ! " + kGreenLines, caps);
  int index = 0;
  ASSERT_TRUE(testing::showObjects(chain, index));
  const BufferPtr shown = chain.pass(testing::busyFrame(caps, index));
  const auto objects = findResult<objects::Objects>(shown.get());
  std::vector<Box> boxes;
  for (const objects::Object& object : objects->objects)
    if (objects::isListed(object.state))
      boxes.push_back(intersect(object.box, boundsOf(Size{caps.width, caps.height})));
  ASSERT_FALSE(boxes.empty());
  const Image<uint8_t> green = greenOf(shown.get(), caps);
  const auto isOnSome = [&](Point at, int width) {
    return std::any_of(boxes.begin(), boxes.end(),
                       [&](const Box& box) { return isOnEdge(box, at, width); });
  };
  for (int y = 0; y < caps.height; ++y)
    for (int x = 0; x < caps.width; ++x) {
      const bool isGreen = green.at(x, y) != 0;
      EXPECT_TRUE(isGreen || !isOnSome({x, y}, 0)) << "nothing drawn at " << x << ',' << y;
      EXPECT_TRUE(!isGreen || isOnSome({x, y}, 2)) << "drawn at " << x << ',' << y;
    }
}

}  // namespace
}  // namespace rg
