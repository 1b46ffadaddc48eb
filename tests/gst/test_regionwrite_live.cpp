// SPDX-License-Identifier: LGPL-2.1-or-later
// Readers that do not read, disks that are full and readers that die, in a live pipeline: the
// harness says in answer to the latency query that it is one.
#include "tests/support/busy_scene.hpp"
#include "tests/support/written_lines.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace rg {
namespace {

using testing::await;
using testing::Chain;
using testing::frameWith;
using testing::linesOf;
using testing::Watchdog;

constexpr int kManyObjects = 300;  // A line of some 60 kB.

uint64_t droppedBy(const Chain& chain) {
  GstElement* element = chain.element("regionwrite");
  guint64 dropped = 0;
  g_object_get(element, "dropped", &dropped, nullptr);
  gst_object_unref(element);
  return dropped;
}

int frameOf(const std::string& line) {
  int frame = 0;
  return std::sscanf(line.c_str(), R"({"schema":"1.0","frame":%d,)", &frame) == 1 ? frame : 0;
}

class RegionWriteLive : public testing::WrittenLines {
 protected:
  void SetUp() override {
    WrittenLines::SetUp();
    ASSERT_EQ(mkfifo(pipe().c_str(), 0600), 0);
  }
  [[nodiscard]] std::string pipe() const { return folder_ / "pipe"; }
  /// A pipe that holds as little as can be.
  [[nodiscard]] int openReader() const {
    const int reader = open(pipe().c_str(), O_RDONLY | O_NONBLOCK);
    fcntl(reader, F_SETPIPE_SZ, 4096);
    return reader;
  }
  /// Appends what there is to read.
  static void readSome(int reader, std::string& text) {
    char bytes[4096];
    for (ssize_t n = 0; (n = read(reader, bytes, sizeof bytes)) > 0;)
      text.append(bytes, static_cast<size_t>(n));
  }
  /// Frames that were taken until one was dropped.
  static int pushUntilFull(Chain& chain, int index) {
    const uint64_t before = droppedBy(chain);
    for (; droppedBy(chain) < before + 10; ++index) {
      EXPECT_TRUE(chain.pass(frameWith(index, kManyObjects)));
      if (index > 10'000) ADD_FAILURE() << "nothing was dropped";
      if (index > 10'000) break;
    }
    return index;
  }

  const Watchdog watchdog_{200};
};

/// The write of the first line can't return while nobody reads: no frame may wait for it.
TEST_F(RegionWriteLive, AReaderThatDoesNotReadStopsNoFrame) {
  const int reader = openReader();
  Chain chain("regionwrite location=" + pipe());
  const int pushed = pushUntilFull(chain, 0);
  const std::string warning = chain.complaint(GST_MESSAGE_WARNING);
  EXPECT_NE(warning.find("does not keep up"), std::string::npos) << warning;
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  const uint64_t dropped = droppedBy(chain);
  EXPECT_EQ(dropped, 10u);

  std::string text;
  await([&] {
    readSome(reader, text);
    return linesOf(text).size() + dropped == static_cast<size_t>(pushed);
  });
  EXPECT_EQ(droppedBy(chain), dropped);
  int before = 0;
  for (const std::string& line : linesOf(text)) {
    EXPECT_GT(frameOf(line), before);
    before = frameOf(line);
    EXPECT_EQ(line.back(), '}');
  }
  ASSERT_TRUE(chain.pass(frameWith(pushed, 1)));
  await([&] {
    readSome(reader, text);
    return frameOf(linesOf(text).back()) == pushed + 1;
  });
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  close(reader);
}

TEST_F(RegionWriteLive, AReaderThatDoesNotReadHoldsUpTheEndForAMoment) {
  const int reader = openReader();
  Chain chain("regionwrite location=" + pipe());
  const int pushed = pushUntilFull(chain, 0);
  EXPECT_TRUE(gst_harness_push_event(chain.harness(), gst_event_new_eos()));
  EXPECT_EQ(gst_element_set_state(chain.harness()->element, GST_STATE_NULL),
            GST_STATE_CHANGE_SUCCESS);
  std::string text;
  readSome(reader, text);
  EXPECT_EQ(linesOf(text).size() + droppedBy(chain), static_cast<size_t>(pushed));
  close(reader);
}

TEST_F(RegionWriteLive, AFullDiskIsToldOnceAndCounted) {
  Chain chain("regionwrite location=/dev/full");
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(chain.pass(frameWith(i, 1)));
  await([&] { return droppedBy(chain) == 50; });
  EXPECT_TRUE(gst_harness_push_event(chain.harness(), gst_event_new_eos()));
  EXPECT_EQ(droppedBy(chain), 50u);
  const std::string warning = chain.complaint(GST_MESSAGE_WARNING);
  EXPECT_NE(warning.find("No space left on device"), std::string::npos) << warning;
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

/// A file that may not grow for a while: whole lines before and behind.
TEST_F(RegionWriteLive, ADiskThatHasRoomAgainIsWrittenTo) {
  Chain chain("regionwrite location=" + path_);
  int index = 0;
  for (; index < 5; ++index) EXPECT_TRUE(chain.pass(frameWith(index, 3)));
  await([&] { return linesOf(written()).size() == 5; });
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit tight{std::filesystem::file_size(path_) + 100, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &tight);
  for (int i = 0; i < 7; ++i) (void)chain.pass(frameWith(index++, 3));
  await([&] { return droppedBy(chain) == 7; });
  setrlimit(RLIMIT_FSIZE, &before);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(chain.pass(frameWith(index++, 3)));
  await([&] { return linesOf(written()).size() == 9; });
  std::vector<int> frames;
  for (const std::string& line : linesOf(written())) frames.push_back(frameOf(line));
  EXPECT_EQ(frames, (std::vector<int>{1, 2, 3, 4, 5, 13, 14, 15, 16}));
  EXPECT_EQ(droppedBy(chain), 7u);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

TEST_F(RegionWriteLive, AReaderThatDiesIsFollowedByTheNext) {
  int reader = openReader();
  Chain chain("regionwrite location=" + pipe());
  std::string text;
  ASSERT_TRUE(chain.pass(frameWith(0, 1)));
  await([&] {
    readSome(reader, text);
    return linesOf(text).size() == 1;
  });
  close(reader);
  for (int i = 1; i < 6; ++i) EXPECT_TRUE(chain.pass(frameWith(i, 1)));
  await([&] { return droppedBy(chain) == 5; });
  reader = openReader();
  ASSERT_TRUE(chain.pass(frameWith(6, 1)));
  text.clear();
  await([&] {
    readSome(reader, text);
    return !linesOf(text).empty();
  });
  EXPECT_EQ(frameOf(text), 7);
  EXPECT_EQ(droppedBy(chain), 5u);
  // The first line finds a broken pipe, the next ones find none: the latest of those before a frame
  // is told.
  const std::string warning = chain.complaint(GST_MESSAGE_WARNING);
  EXPECT_TRUE(warning.find("Broken pipe") != std::string::npos ||
              warning.find("nobody reads from this pipe") != std::string::npos)
      << warning;
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  close(reader);
}

/// How a stream of five frames to a disk that is full ends.
GstMessageType endOf(const std::string& source, const std::string& writer, guint64& dropped) {
  GstElement* pipeline = gst_parse_launch(
      ("videotestsrc num-buffers=5 " + source +
       " ! video/x-raw,format=GRAY8,width=64,height=48 ! hsvsegment ! srg ! prmmotion ! mrfmerge ! "
       "regionwrite name=w location=/dev/full " +
       writer + " ! fakesink sync=false")
          .c_str(),
      nullptr);
  const GstMessageType type = testing::playToEnd(pipeline);
  GstElement* element = gst_bin_get_by_name(GST_BIN(pipeline), "w");
  g_object_get(element, "dropped", &dropped, nullptr);
  gst_object_unref(element);
  gst_object_unref(pipeline);
  return type;
}

TEST_F(RegionWriteLive, OnlyLivePipelinesDropUnlessToldOtherwise) {
  guint64 dropped = 0;
  EXPECT_EQ(endOf("is-live=true", "", dropped), GST_MESSAGE_EOS);
  EXPECT_EQ(dropped, 5u);
  EXPECT_EQ(endOf("", "", dropped), GST_MESSAGE_ERROR);
  EXPECT_EQ(endOf("", "drop=true", dropped), GST_MESSAGE_EOS);
  EXPECT_EQ(dropped, 5u);
  EXPECT_EQ(endOf("is-live=true", "drop=false", dropped), GST_MESSAGE_ERROR);
}

}  // namespace
}  // namespace rg
