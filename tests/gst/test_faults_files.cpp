// SPDX-License-Identifier: LGPL-2.1-or-later
// Files that are not what they should be, and limits of the system on them, with objects in view.
#include "tests/support/busy_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <png.h>
#include <string>
#include <sys/resource.h>
#include <vector>

namespace rg {
namespace {

using testing::busyFrame;
using testing::campaign;
using testing::Caps;
using testing::Chain;
using testing::Chance;
using testing::showObjects;
using testing::Watchdog;

const Caps kSmall{"I420", 96, 64};

class Files : public ::testing::Test {
 protected:
  Files() {
    char name[] = "/tmp/regiongraph-files-XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~Files() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  void write(const std::string& name, const std::vector<char>& bytes) const {
    std::ofstream(path(name), std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

  /// A mask of 16x16 pixels, all white, as the bytes of a PNG.
  [[nodiscard]] std::vector<char> whiteMask() const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = image.height = 16;
    image.format = PNG_FORMAT_GRAY;
    const std::vector<png_byte> pixels(256, 255);
    EXPECT_TRUE(
        png_image_write_to_file(&image, path("white").c_str(), 0, pixels.data(), 16, nullptr));
    std::ifstream in(path("white"), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::filesystem::path folder_;
};

void setMask(Chain& chain, const std::string& path) {
  GstElement* element = chain.element("bgremove");
  g_object_set(element, "mask", path.c_str(), nullptr);
  gst_object_unref(element);
}

using MaskFiles = Files;

/// Cut anywhere, or with wrong bytes, while playing: the mask that was set before stays in use, and
/// the objects stay in view.
TEST_F(MaskFiles, ThatAreBrokenChangeNothing) {
  Chance chance;
  const std::vector<char> good = whiteMask();
  Chain chain(testing::kQuickStages, kSmall);
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  for (int round = 0; round < campaign(80); ++round) {
    std::vector<char> bytes = good;
    if (chance.isOneIn(2))
      bytes.resize(static_cast<size_t>(chance.below(static_cast<int>(good.size()))));
    else
      for (int i = chance.between(1, 9); i > 0; --i)
        bytes[static_cast<size_t>(chance.below(static_cast<int>(bytes.size())))] =
            static_cast<char>(chance.below(256));
    const std::string name = "mask" + std::to_string(round);
    write(name, bytes);
    setMask(chain, path(name));
    EXPECT_EQ(chain.push(busyFrame(kSmall, index++)), GST_FLOW_OK);
    while (GstBuffer* out = gst_harness_try_pull(chain.harness())) gst_buffer_unref(out);
  }
  setMask(chain, path("white"));
  EXPECT_TRUE(showObjects(chain, index));
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

/// Folders, devices, links to nowhere or in a circle, names too long or not text.
TEST_F(MaskFiles, ThatAreNoFilesChangeNothing) {
  const Watchdog watchdog(120);
  std::filesystem::create_symlink("circle", path("circle"));
  std::filesystem::create_symlink("nowhere", path("dangling"));
  Chain chain(testing::kQuickStages, kSmall);
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  for (const std::string& name :
       {path(""), path("circle"), path("dangling"), std::string("/dev/zero"),
        std::string("/dev/full"), std::string("/proc/self/mem"), std::string("/proc/kmsg/none"),
        std::string(300, 'a'), path(std::string(5000, '/')), std::string("\xff\xfe%s%n"),
        std::string("file:///etc/passwd"), std::string("/etc/passwd")}) {
    SCOPED_TRACE(name.substr(0, 40));
    setMask(chain, name);
    EXPECT_EQ(chain.push(busyFrame(kSmall, index++)), GST_FLOW_OK);
    EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING), "");
    EXPECT_TRUE(showObjects(chain, index));
  }
}

/// Puts the process's limit on a resource back when it goes.
class Limit {
 public:
  Limit(__rlimit_resource resource, rlim_t value) : resource_(resource) {
    getrlimit(resource, &before_);
    const rlimit tight{value, before_.rlim_max};
    setrlimit(resource, &tight);
  }
  ~Limit() { setrlimit(resource_, &before_); }
  Limit(const Limit&) = delete;
  Limit& operator=(const Limit&) = delete;

 private:
  __rlimit_resource resource_;
  rlimit before_{};
};

using FileLimits = Files;

/// No file may be opened any more: an error at the start, a warning while playing; later it works.
TEST_F(FileLimits, TooManyOpenFilesAreTold) {
  (void)whiteMask();
  Chain chain(std::string(testing::kQuickStages) + " ! regionwrite location=" + path("lines"),
              kSmall);
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  {
    const Limit none(RLIMIT_NOFILE, 0);
    setMask(chain, path("white"));
    EXPECT_EQ(chain.push(busyFrame(kSmall, index++)), GST_FLOW_OK);
    EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("Too many open files"), std::string::npos);
    setMask(chain, "");
    gst_element_set_state(chain.harness()->element, GST_STATE_NULL);
    EXPECT_EQ(gst_element_set_state(chain.harness()->element, GST_STATE_PLAYING),
              GST_STATE_CHANGE_FAILURE);
    EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find("Too many open files"), std::string::npos);
  }
  gst_element_set_state(chain.harness()->element, GST_STATE_NULL);
  ASSERT_EQ(gst_element_set_state(chain.harness()->element, GST_STATE_PLAYING),
            GST_STATE_CHANGE_SUCCESS);
  testing::beginStream(chain);
  index = 0;
  EXPECT_TRUE(showObjects(chain, index));
}

/// Writes until the file may not grow; the signal that comes then would end the process.
[[noreturn]] void writeBeyondTheLimit(const std::string& location) {
  signal(SIGXFSZ, SIG_DFL);
  Chain chain(std::string(testing::kQuickStages) + " ! regionwrite drop=false location=" + location,
              kSmall);
  const Limit small(RLIMIT_FSIZE, 4096);
  GstFlowReturn flow = GST_FLOW_OK;
  for (int i = 0; flow == GST_FLOW_OK && i < 1000; ++i) flow = chain.push(busyFrame(kSmall, i));
  const bool isTold = !chain.complaint(GST_MESSAGE_ERROR).empty();
  _exit(flow == GST_FLOW_ERROR && isTold ? 0 : 1);
}

using FileLimitsDeathTest = Files;

TEST_F(FileLimitsDeathTest, AFullFileIsAnErrorInsteadOfASignal) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string location = std::filesystem::temp_directory_path() / "regiongraph-limit.jsonl";
  EXPECT_EXIT(writeBeyondTheLimit(location), ::testing::ExitedWithCode(0), "");
  std::filesystem::remove(location);
}

/// A disk that is full from the start ends the stream with an error; the next start writes
/// elsewhere.
TEST_F(FileLimits, AFullDiskIsAnErrorAndTheNextStartWrites) {
  Chain chain(std::string(testing::kQuickStages) + " ! regionwrite drop=false location=/dev/full",
              kSmall);
  EXPECT_EQ(chain.push(busyFrame(kSmall, 0)), GST_FLOW_ERROR);
  EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find("No space left"), std::string::npos);
  gst_element_set_state(chain.harness()->element, GST_STATE_NULL);
  GstElement* element = chain.element("regionwrite");
  g_object_set(element, "location", path("lines").c_str(), nullptr);
  gst_object_unref(element);
  ASSERT_EQ(gst_element_set_state(chain.harness()->element, GST_STATE_PLAYING),
            GST_STATE_CHANGE_SUCCESS);
  testing::beginStream(chain);
  int index = 0;
  EXPECT_TRUE(showObjects(chain, index));
  EXPECT_GT(std::filesystem::file_size(path("lines")), 0u);
}

}  // namespace
}  // namespace rg
