// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/cascade_file.hpp"
#include "gst/support/roi_metas.hpp"
#include "tests/core/detection/cascades.hpp"
#include "tests/support/cascade_files.hpp"
#include "tests/support/harness.hpp"
#include "tests/support/results.hpp"

#include <gst/video/gstvideometa.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sys/stat.h>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::CascadeFile;
using testing::Chain;
using testing::kHalvesXml;

std::string replaced(const char* what, const std::string& by) {
  std::string xml = kHalvesXml;
  const size_t at = xml.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return xml.replace(at, std::string(what).size(), by);
}

TEST(CascadeFiles, AreReadAsTheyAreMeant) {
  const auto read = parseCascade(kHalvesXml);
  ASSERT_TRUE(read) << read.error().message;
  const detection::Cascade expected = test::halvesCascade();
  const detection::Cascade& cascade = **read;
  EXPECT_EQ(cascade.window, expected.window);
  ASSERT_EQ(cascade.features.size(), 1u);
  EXPECT_FALSE(cascade.features[0].isTilted);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(cascade.features[0].rects[i].box, expected.features[0].rects[i].box);
    EXPECT_EQ(cascade.features[0].rects[i].weight, expected.features[0].rects[i].weight);
  }
  EXPECT_EQ(cascade.nodeFeatures, expected.nodeFeatures);
  EXPECT_EQ(cascade.leaves, expected.leaves);
  ASSERT_EQ(cascade.branches.size(), 2u);
  EXPECT_EQ(cascade.branches[0].threshold, .1F);
  EXPECT_EQ(cascade.branches[0].less, -1);
  EXPECT_EQ(cascade.branches[1].other, -2);
  ASSERT_EQ(cascade.stages.size(), 2u);
  EXPECT_EQ(cascade.stages[1].firstTree, 1);
  EXPECT_EQ(cascade.stages[1].trees, 1);
  EXPECT_NEAR(cascade.stages[1].threshold, 0, 1e-9);
}

TEST(CascadeFiles, WhatIsNoneIsRefused) {
  std::string deep = "<opencv_storage><cascade>";
  for (int i = 0; i < 10000; ++i) deep += "<_>";
  std::string many = "0 0 8 10 -1";
  for (int i = 0; i < 5000; ++i) many += " 1";
  const std::string nul("<opencv_storage>\0</opencv_storage>", 34);
  for (const std::string& xml :
       {std::string(),
        std::string("{}"),
        std::string("<opencv_storage>"),
        deep,
        nul,
        std::string("<opencv_storage></opencv_storage>"),
        std::string(kHalvesXml).substr(0, 700),
        std::string(kHalvesXml) + "<more/>",
        replaced("</cascade>", "</cascade><cascade/>"),
        replaced("BOOST", "FOREST"),
        replaced("HAAR", "LBP"),
        replaced("<featureType>HAAR</featureType>", ""),
        replaced("opencv-cascade-classifier", "opencv-haar-classifier"),
        replaced("<width>8</width>", "<width>0</width>"),
        replaced("<width>8</width>", "<width>-8</width>"),
        replaced("<width>8</width>", "<width>1e99</width>"),
        replaced("<width>8</width>", "<width>8 8</width>"),
        replaced("<width>8</width>", "<width>nan</width>"),
        replaced("<width>8</width>", "<width>eight</width>"),
        replaced("<width>8</width>", "<width>8.5</width>"),
        replaced("<width>8</width>", "<width>7</width>"),
        replaced("0 0 8 10 -1.", many),
        replaced("0 0 8 10 -1.", "0 0 8 10"),
        replaced("0 0 8 10 -1.", "0 0 8 10 inf"),
        replaced("0 0 8 10 -1.", "0 0 8 10 0"),
        replaced("0 0 8 10 -1.", "1 0 8 10 -1"),
        replaced("<_>0 0 8 10 -1.</_>", "<_>0 0 1 1 1</_><_>0 0 1 1 1</_><_>0 0 1 1 1</_>"),
        replaced("<tilted>0", "<tilted>1"),
        replaced("<tilted>0", "<tilted>"),
        replaced("0 -1 0 .5", "0 -1 1 .5"),
        replaced("0 -1 0 .5", "0 -1 -1 .5"),
        replaced("0 -1 0 .5", "0 -2 0 .5"),
        replaced("0 -1 0 .5", "0 1 0 .5"),
        replaced("0 -1 0 .5", "0 -1 0"),
        replaced("0 -1 0 .5", ""),
        replaced("0 -1 0 .5", "0 -1 0 1e400"),
        replaced("0 -1 0 .5", "0 -1 0 1e39"),
        replaced("<leafValues>-1 1</leafValues>", ""),
        replaced("-1 1</leaf", "-1 1 1</leaf"),
        replaced("<stageThreshold>1e-5</stageThreshold>",
                 "<stageThreshold>1e-5 2</stageThreshold>"),
        replaced("<weakClassifiers>", "<weak>")}) {
    const auto read = parseCascade(xml);
    EXPECT_FALSE(read) << xml.substr(0, 400);
  }
}

/// The end of a chain that could not start.
std::string complaintOf(const std::string& path, GstStateChangeReturn& started) {
  GstElement* element = gst_element_factory_make("haardetect", nullptr);
  gst_object_ref_sink(element);
  const testing::BusPtr bus(gst_bus_new());
  gst_element_set_bus(element, bus.get());
  g_object_set(element, "cascade", path.c_str(), nullptr);
  started = gst_element_set_state(element, GST_STATE_PAUSED);
  std::string text;
  if (GstMessage* message = gst_bus_pop_filtered(bus.get(), GST_MESSAGE_ERROR)) {
    GError* error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    text = error->message;
    g_error_free(error);
    gst_message_unref(message);
  }
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_bus(element, nullptr);
  gst_object_unref(element);
  return text;
}

TEST(HaarDetect, WithoutAReadableCascadeItDoesNotStart) {
  const std::string folder = g_get_tmp_dir();
  const std::string pipe = folder + "/regiongraph-pipe-" + std::to_string(getpid());
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const CascadeFile broken("<opencv_storage>");
  for (const std::string& path : {std::string("/no/such/file.xml"), folder, pipe, broken.path()}) {
    GstStateChangeReturn started = GST_STATE_CHANGE_SUCCESS;
    const std::string text = complaintOf(path, started);
    EXPECT_EQ(started, GST_STATE_CHANGE_FAILURE) << path;
    EXPECT_NE(text.find(path), std::string::npos) << text;
    EXPECT_NE(text.find("/usr/share/opencv4/haarcascades"), std::string::npos) << text;
  }
  std::filesystem::remove(pipe);
  GstStateChangeReturn started = GST_STATE_CHANGE_SUCCESS;
  EXPECT_NE(complaintOf("", started).find("cascade is not set"), std::string::npos);
  EXPECT_EQ(started, GST_STATE_CHANGE_FAILURE);
  const CascadeFile good;
  EXPECT_EQ(complaintOf(good.path(), started), "");
  EXPECT_EQ(started, GST_STATE_CHANGE_SUCCESS);
}

/// Bright left halves beside dark right ones.
BufferPtr frameOf(const Caps& caps, int index, const std::vector<Box>& things) {
  return testing::paint(caps, index, [&](int x, int y) -> uint8_t {
    for (const Box& box : things)
      if (box.contains({x, y})) return 2 * (x - box.x) < box.width ? 200 : 50;
    return 120;
  });
}

struct Region {
  std::string type, label, model;
  Box box;
  double centreX = 0;
};

/// Those that say something of a class, and what.
std::vector<Region> regionsOn(GstBuffer* buffer, const char* param) {
  std::vector<Region> regions;
  gpointer state = nullptr;
  while (GstMeta* meta = gst_buffer_iterate_meta_filtered(
             buffer, &state, GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE)) {
    auto* roi = reinterpret_cast<GstVideoRegionOfInterestMeta*>(meta);
    const GstStructure* said = gst_video_region_of_interest_meta_get_param(roi, param);
    if (!said) continue;
    double left = 0, right = 0;
    EXPECT_TRUE(gst_structure_get(said, "x_min", G_TYPE_DOUBLE, &left, "x_max", G_TYPE_DOUBLE,
                                  &right, nullptr));
    const char* model = gst_structure_get_string(said, "model_name");
    regions.push_back({g_quark_to_string(roi->roi_type),
                       gst_structure_get_string(said, "label"),
                       model ? model : "",
                       {static_cast<int>(roi->x), static_cast<int>(roi->y),
                        static_cast<int>(roi->w), static_cast<int>(roi->h)},
                       (left + right) / 2});
  }
  return regions;
}

std::string detectorLine(const CascadeFile& file, const std::string& properties) {
  return "haardetect threads=2 cascade=" + file.path() + " " + properties;
}

TEST(HaarDetect, InTheWholeFrameItAddsRegionsOfTheClass) {
  const CascadeFile file;
  for (const char* format : testing::kAllFormats) {
    Chain chain(detectorLine(file, "areas=frame label=half"), Caps{format, 160, 120});
    const std::vector<Box> things{{20, 30, 24, 30}, {100, 50, 40, 50}};
    BufferPtr in = frameOf(chain.caps(), 0, things);
    const auto bytes = testing::bytesOf(in.get());
    const BufferPtr out = chain.pass(std::move(in));
    ASSERT_TRUE(out) << chain.complaint(GST_MESSAGE_ERROR);
    EXPECT_EQ(testing::bytesOf(out.get()), bytes);
    const auto regions = regionsOn(out.get(), "detection");
    for (const Box& thing : things)
      EXPECT_TRUE(std::any_of(regions.begin(), regions.end(), [&](const Region& region) {
        const Box& box = region.box;
        return region.type == "half" && region.label == "half" &&
               thing.contains({box.x + box.width / 2, box.y + box.height / 2});
      })) << format;
  }
}

/// A frame on which mrfmerge has told objects, as if it stood before.
BufferPtr toldFrame(const Caps& caps, int index, const std::vector<Box>& things,
                    std::vector<objects::Object> list) {
  BufferPtr buffer = frameOf(caps, index, things);
  RoiMetas rois;
  const auto objects = testing::objects({caps.width, caps.height}, std::move(list));
  rois.add(buffer.get(), caps.info(), *objects);
  attachResult<objects::Objects>(buffer.get(), objects);
  return buffer;
}

TEST(HaarDetect, ObjectsGetTheClassThatIsSeenInThem) {
  const CascadeFile file;
  Chain chain(detectorLine(file, ""), Caps{"I420", 160, 120});
  const std::vector<Box> things{{20, 30, 24, 30}, {100, 50, 40, 50}};
  using objects::ObjectState;
  BufferPtr out = chain.pass(
      toldFrame(chain.caps(), 0, things,
                {testing::object(3, {18, 28, 28, 34}), testing::object(4, {60, 5, 20, 20}),
                 testing::object(9, {100, 50, 40, 50}, ObjectState::Occluded)}));
  ASSERT_TRUE(out) << chain.complaint(GST_MESSAGE_ERROR);
  auto regions = regionsOn(out.get(), "classification");
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_EQ(regions[0].type, "object");
  EXPECT_EQ(regions[0].box, (Box{18, 28, 28, 34}));
  EXPECT_EQ(regions[0].label.rfind("halves", 0), 0u) << regions[0].label;
  EXPECT_EQ(regions[0].model.rfind("haarcascade_halves", 0), 0u) << regions[0].model;
  EXPECT_NEAR(regions[0].centreX * 160, 32, 8);

  GstElement* element = chain.element("haardetect");
  g_object_set(element, "label", "walker\xff", nullptr);
  gst_object_unref(element);
  out = chain.pass(toldFrame(chain.caps(), 1, things, {testing::object(9, {100, 50, 40, 50})}));
  ASSERT_TRUE(out);
  regions = regionsOn(out.get(), "classification");
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_EQ(regions[0].label.rfind("walker", 0), 0u);
  EXPECT_TRUE(g_utf8_validate(regions[0].label.c_str(), -1, nullptr));
}

TEST(HaarDetect, OneOfTwoObjectsThatShareADetectionHasIt) {
  const CascadeFile file;
  Chain chain(detectorLine(file, "areas=frame"), Caps{"GRAY8", 160, 120});
  const std::vector<Box> things{{40, 30, 40, 50}};
  const BufferPtr out = chain.pass(
      toldFrame(chain.caps(), 0, things,
                {testing::object(1, {40, 30, 40, 50}), testing::object(2, {55, 50, 10, 12})}));
  ASSERT_TRUE(out);
  bool isOnLarge = false;
  for (const Region& region : regionsOn(out.get(), "classification"))
    isOnLarge = isOnLarge || region.box == Box{40, 30, 40, 50};
  EXPECT_TRUE(isOnLarge);
}

TEST(HaarDetect, WithoutObjectsItNamesWhatIsMissing) {
  const CascadeFile file;
  Chain chain(detectorLine(file, ""), Caps{"I420", 64, 48});
  EXPECT_EQ(chain.push(frameOf(chain.caps(), 0, {})), GST_FLOW_ERROR);
  EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find("mrfmerge"), std::string::npos);
}

TEST(HaarDetect, ItFollowsWhatTheFiveStagesFollow) {
  const CascadeFile file;
  Chain chain("bgremove training-frames=2 ! hsvsegment ! srg ! prmmotion ! mrfmerge ! " +
                  detectorLine(file, "min-neighbours=1 area-margin=0.5"),
              Caps{"I420", 160, 120});
  size_t frames = 0;
  for (int i = 0; i < 40; ++i) {
    std::vector<Box> things;
    if (i > 5) things.push_back({10 + 3 * (i - 5), 30, 24, 30});
    const BufferPtr out = chain.pass(frameOf(chain.caps(), i, things));
    ASSERT_TRUE(out) << chain.complaint(GST_MESSAGE_ERROR);
    for (const Region& region : regionsOn(out.get(), "classification"))
      frames += things.size() == 1 && !intersect(region.box, things[0]).isEmpty();
  }
  EXPECT_GT(frames, 10u);
}

TEST(HaarDetect, ItOutlivesWhatHappensToStreams) {
  const CascadeFile file;
  Chain chain(detectorLine(file, "areas=frame"), Caps{"I420", 160, 120});
  const auto findsOne = [&](int index) {
    const std::vector<Box> things{{20, 10, 24, 30}};
    const BufferPtr out = chain.pass(frameOf(chain.caps(), index, things));
    return out && !regionsOn(out.get(), "detection").empty();
  };
  EXPECT_TRUE(findsOne(0));
  chain.setCaps(Caps{"BGRx", 200, 60});
  EXPECT_TRUE(findsOne(1));
  gst_harness_push_event(chain.harness(), gst_event_new_flush_start());
  gst_harness_push_event(chain.harness(), gst_event_new_flush_stop(TRUE));
  chain.setCaps(Caps{"GRAY8", 64, 48});
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(chain.harness(), gst_event_new_segment(&segment));
  EXPECT_TRUE(findsOne(2));
  chain.setCaps(Caps{"GRAY8", 7, 9});  // Smaller than any window.
  EXPECT_TRUE(chain.pass(frameOf(chain.caps(), 3, {})));
  chain.setCaps(Caps{"GRAY8", 64, 48});
  BufferPtr gap = frameOf(chain.caps(), 4, {{20, 10, 24, 30}});
  GST_BUFFER_FLAG_SET(gap.get(), GST_BUFFER_FLAG_GAP);
  const BufferPtr passed = chain.pass(std::move(gap));
  ASSERT_TRUE(passed);
  EXPECT_TRUE(regionsOn(passed.get(), "detection").empty());
  EXPECT_TRUE(findsOne(5));
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
}

TEST(HaarDetect, BadMemoryIsCountedAndPassedOn) {
  const CascadeFile file;
  Chain chain(detectorLine(file, "areas=frame"), Caps{"I420", 64, 48});
  EXPECT_TRUE(chain.pass(frameOf(chain.caps(), 0, {{20, 10, 24, 30}})));
  BufferPtr small(gst_buffer_new_allocate(nullptr, 10, nullptr));
  EXPECT_TRUE(chain.pass(std::move(small)));
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("skipped"), std::string::npos);
  GstElement* element = chain.element("haardetect");
  guint64 bad = 0;
  g_object_get(element, "bad-buffers", &bad, nullptr);
  gst_object_unref(element);
  EXPECT_EQ(bad, 1u);
}

TEST(HaarDetect, ACascadeInUseStays) {
  const CascadeFile file;
  Chain chain(detectorLine(file, "areas=frame"), Caps{"I420", 64, 48});
  EXPECT_TRUE(chain.pass(frameOf(chain.caps(), 0, {{20, 10, 24, 30}})));
  GstElement* element = chain.element("haardetect");
  g_object_set(element, "cascade", "/no/such/file", nullptr);
  gchar* path = nullptr;
  g_object_get(element, "cascade", &path, nullptr);
  EXPECT_EQ(path, file.path());
  g_free(path);
  gst_object_unref(element);
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("cascade stays as it was"),
            std::string::npos);
}

}  // namespace
}  // namespace rg
