// SPDX-License-Identifier: LGPL-2.1-or-later
// bgremove's mask and areas-of-interest, and hsvsegment's hues, as a user sets them.
#include "gst/meta/result_meta.hpp"
#include "tests/support/harness.hpp"

#include <glib/gstdio.h>
#include <gtest/gtest.h>

#include <png.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Chain;
using testing::paint;
using testing::square;

constexpr const char* kMethods[] = {"hybrid", "paper training-frames=4", "frame-difference"};

/// A name in the temporary folder; what is made there goes with it.
class PathInTemp {
 public:
  explicit PathInTemp(const std::string& name)
      : path_(std::string(g_get_tmp_dir()) + "/regiongraph-" + name + '-' +
              std::to_string(getpid()) + '-' + std::to_string(g_get_monotonic_time())) {}
  ~PathInTemp() { g_remove(path_.c_str()); }
  PathInTemp(const PathInTemp&) = delete;
  PathInTemp& operator=(const PathInTemp&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A PNG of 2x1 pixels, the left one white, for as long as it lives.
class LeftHalf {
 public:
  LeftHalf() {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 2;
    image.height = 1;
    image.format = PNG_FORMAT_GRAY;
    const png_byte pixels[] = {255, 0};
    EXPECT_TRUE(png_image_write_to_file(&image, path_.c_str(), 0, pixels, 2, nullptr));
  }
  ~LeftHalf() { g_unlink(path_.c_str()); }
  LeftHalf(const LeftHalf&) = delete;
  LeftHalf& operator=(const LeftHalf&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_ = std::string(g_get_tmp_dir()) + "/regiongraph-left-half-" +
                      std::to_string(g_get_real_time()) + ".png";
};

/// The right border of what is foreground when a square appears in the middle; 0 = nothing.
int rightBorder(Chain& chain, int& index, int side = 16) {
  BufferPtr out;
  for (const int x : {-100, -100, 24}) out = chain.pass(paint({}, index++, square(x, 16, side)));
  const auto foreground = findResult<background::Foreground>(out.get());
  int right = 0;
  for (const Box& area : foreground->areas) right = std::max(right, area.right());
  return right;
}

void learnWall(Chain& chain, int& index) {
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(chain.pass(paint({}, index++, square(-100, 16, 16))));
}

TEST(InterestProperties, LimitTheForegroundOfEveryMethodWhilePlaying) {
  const LeftHalf file;
  for (const std::string method : kMethods) {
    SCOPED_TRACE(method);
    Chain chain("bgremove method=" + method);
    int index = 0;
    learnWall(chain, index);
    EXPECT_GT(rightBorder(chain, index), 32);
    GstElement* element = chain.element("bgremove");
    g_object_set(element, "mask", file.path().c_str(), nullptr);
    EXPECT_EQ(rightBorder(chain, index), 32);
    g_object_set(element, "mask", "", "areas-of-interest", "exclude 0.5,0 1,0 1,1 0.5,1", nullptr);
    EXPECT_EQ(rightBorder(chain, index), 32);
    g_object_set(element, "areas-of-interest", "", nullptr);
    EXPECT_GT(rightBorder(chain, index), 32);
    gst_object_unref(element);
    EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  }
}

TEST(InterestProperties, ABadValueWhilePlayingWarnsOnceAndChangesNothing) {
  const LeftHalf file;
  Chain chain("bgremove mask=" + file.path());
  int index = 0;
  learnWall(chain, index);
  GstElement* element = chain.element("bgremove");
  g_object_set(element, "mask", "/nowhere/mask.png", nullptr);
  EXPECT_EQ(rightBorder(chain, index), 32);
  const std::string complaint = chain.complaint(GST_MESSAGE_WARNING);
  EXPECT_NE(complaint.find("/nowhere/mask.png"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("PNG"), std::string::npos) << complaint;
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  gst_object_unref(element);
}

/// The error that an element posts when it is started with such a property.
std::string errorOf(const char* factory, const char* property, const char* value) {
  GstElement* element = gst_element_factory_make(factory, nullptr);
  gst_object_ref_sink(element);
  GstBus* bus = gst_bus_new();
  gst_element_set_bus(element, bus);
  g_object_set(element, property, value, nullptr);
  EXPECT_EQ(gst_element_set_state(element, GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  std::string text;
  if (GstMessage* message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR)) {
    GError* error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    text = error->message;
    g_error_free(error);
    gst_message_unref(message);
  }
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_bus(element, nullptr);
  gst_object_unref(bus);
  gst_object_unref(element);
  return text;
}

TEST(InterestProperties, ABadValueAtTheStartIsAnErrorThatNamesTheRemedy) {
  EXPECT_NE(errorOf("bgremove", "mask", "/nowhere/mask.png").find("give the path of a PNG"),
            std::string::npos);
  EXPECT_NE(errorOf("bgremove", "mask", "/dev/null").find("give the path of a PNG"),
            std::string::npos);
  EXPECT_NE(errorOf("bgremove", "areas-of-interest", "0,0 1,1").find("Areas are written as"),
            std::string::npos);
  EXPECT_NE(errorOf("hsvsegment", "background-hue", "green").find("degrees"), std::string::npos);
  EXPECT_NE(errorOf("hsvsegment", "object-hue", "10").find("object-hue"), std::string::npos);
}

TEST(InterestProperties, WhatIsNoRegularFileIsAnErrorAtTheStart) {
  const PathInTemp folder("folder"), pipe("pipe"), socket("socket");
  ASSERT_EQ(g_mkdir(folder.path().c_str(), 0700), 0);
  ASSERT_EQ(mkfifo(pipe.path().c_str(), 0600), 0);
  ASSERT_EQ(mknod(socket.path().c_str(), S_IFSOCK | 0600, 0), 0);
  for (const char* path : {folder.path().c_str(), pipe.path().c_str(), socket.path().c_str(),
                           "/dev/zero", "/dev/tty", "/proc/self/mem"}) {
    const std::string error = errorOf("bgremove", "mask", path);
    EXPECT_NE(error.find("in a regular file"), std::string::npos) << path << ": " << error;
  }
}

TEST(InterestProperties, APipeWhilePlayingWarnsAndChangesNothing) {
  const LeftHalf file;
  const PathInTemp pipe("pipe");
  ASSERT_EQ(mkfifo(pipe.path().c_str(), 0600), 0);
  Chain chain("bgremove mask=" + file.path());
  int index = 0;
  learnWall(chain, index);
  GstElement* element = chain.element("bgremove");
  g_object_set(element, "mask", pipe.path().c_str(), nullptr);
  EXPECT_EQ(rightBorder(chain, index), 32);
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("it is a pipe"), std::string::npos);
  gst_object_unref(element);
}

TEST(InterestProperties, ALinkToAPictureIsFollowed) {
  const LeftHalf file;
  const PathInTemp link("link");
  ASSERT_EQ(::symlink(file.path().c_str(), link.path().c_str()), 0);
  Chain chain("bgremove mask=" + link.path());
  int index = 0;
  learnWall(chain, index);
  EXPECT_EQ(rightBorder(chain, index), 32);
}

TEST(InterestProperties, AHugePictureIsRefused) {
  const PathInTemp sparse("sparse"), wide("wide");
  ASSERT_TRUE(g_file_set_contents(sparse.path().c_str(), "", 0, nullptr));
  ASSERT_EQ(::truncate(sparse.path().c_str(), off_t{1} << 40), 0);
  EXPECT_NE(errorOf("bgremove", "mask", sparse.path().c_str()).find("256 MiB"), std::string::npos);
  // The head of a PNG of 16384x16384 pixels; no more is read.
  constexpr char kHead[] =
      "\x89PNG\r\n\x1a\n"
      "\0\0\0\x0dIHDR\0\0\x40\0\0\0\x40\0\x08\0\0\0\0\x8c\xa3\x4f\x58"
      "\0\0\0\0IDAT\x35\xaf\x06\x1e";
  ASSERT_TRUE(g_file_set_contents(wide.path().c_str(), kHead, sizeof kHead - 1, nullptr));
  const std::string error = errorOf("bgremove", "mask", wide.path().c_str());
  EXPECT_NE(error.find("35 million"), std::string::npos) << error;
}

/// A polygon round the middle of so many points.
std::string starOf(size_t points) {
  std::string text;
  for (size_t i = 0; i < points; ++i) text += i % 2 == 0 ? "0.1,0.1 " : "0.9,0.8 ";
  return text;
}

TEST(InterestProperties, TooManyPointsAreAnErrorThatNamesTheRemedy) {
  for (const std::string& text : {starOf(1'000'000), starOf(1001), std::string(5'000'000, ' '),
                                  starOf(500) + ';' + starOf(501), std::string(3'000'000, 'x')}) {
    const std::string error = errorOf("bgremove", "areas-of-interest", text.c_str());
    EXPECT_NE(error.find("1000 points"), std::string::npos) << error;
    EXPECT_LT(error.size(), 500u);
  }
}

TEST(InterestProperties, AMillionPointsWhilePlayingWarnOnceAndChangeNothing) {
  Chain chain("bgremove areas-of-interest=\"0,0 0.5,0 0.5,1 0,1\"");
  int index = 0;
  learnWall(chain, index);
  GstElement* element = chain.element("bgremove");
  g_object_set(element, "areas-of-interest", starOf(1'000'000).c_str(), nullptr);
  EXPECT_EQ(rightBorder(chain, index), 32);
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("1000 points"), std::string::npos);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  g_object_set(element, "areas-of-interest", starOf(1000).c_str(), nullptr);
  EXPECT_TRUE(chain.pass(paint({}, index, square(24, 16, 16))));
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  gst_object_unref(element);
}

TEST(HueProperties, MakeAHueMaskThatRegionmaskShows) {
  Chain chain("hsvsegment background-hue=auto ! regionmask source=hue");
  const BufferPtr out = chain.pass(paint({}, 0, square(5, 5, 9)));
  ASSERT_TRUE(out);
  // The frame is grey: nothing has a hue.
  for (const uint8_t value : testing::bytesOf(out.get())) ASSERT_EQ(value, 128);
}

TEST(HueProperties, AMaskNobodyDecidedIsAnErrorThatNamesTheProperty) {
  Chain chain("hsvsegment ! regionmask source=hue");
  EXPECT_EQ(chain.push(paint({}, 0, square(5, 5, 9))), GST_FLOW_ERROR);
  EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find("background-hue"), std::string::npos);
}

TEST(ScopeAreas, GivesRegionsInAndAroundTheAreasOnly) {
  Chain chain("bgremove method=frame-difference ! hsvsegment scope=areas");
  int index = 0;
  learnWall(chain, index);
  const BufferPtr out = chain.pass(paint({}, index, square(10, 10, 16)));
  const auto labels = findResult<segmentation::Labels>(out.get());
  EXPECT_EQ(labels->scope, segmentation::Scope::Areas);
  EXPECT_NE(labels->ids.at(18, 18), segmentation::kNoRegion);
  EXPECT_NE(labels->ids.at(6, 18), segmentation::kNoRegion);
  EXPECT_EQ(labels->ids.at(60, 40), segmentation::kNoRegion);
}

}  // namespace
}  // namespace rg
