// SPDX-License-Identifier: LGPL-2.1-or-later
// The files of regionwrite: appended to, moved away, begun anew, and written by one only.
#include "tests/support/written_lines.hpp"

#include <sys/stat.h>

namespace rg {
namespace {

using testing::BusPtr;
using testing::Chain;
using testing::frameWith;
using testing::linesOf;
using testing::MessagePtr;

class RegionWriteFiles : public testing::WrittenLines {
 protected:
  [[nodiscard]] std::string line(const std::string& more = "") const {
    return "regionwrite drop=false format=mot location=" + path_ + " " + more;
  }
  [[nodiscard]] std::string old(int i) const { return contentOf(path_ + "." + std::to_string(i)); }
  static void pass(Chain& chain, int first, int last) {
    for (int i = first; i < last; ++i) ASSERT_TRUE(chain.pass(frameWith(i, 1)));
  }
};

void reopen(const Chain& chain) {
  GstElement* element = chain.element("regionwrite");
  g_signal_emit_by_name(element, "reopen");
  gst_object_unref(element);
}

std::string mot(int first, int last) {
  std::string text;
  for (int frame = first; frame < last; ++frame)
    text += std::to_string(frame) + ",1,0,20,8,4,1,-1,-1,-1\n";
  return text;
}

TEST_F(RegionWriteFiles, AreEmptiedUnlessAppendedTo) {
  for (int round = 1; round <= 3; ++round) {
    Chain chain(line(round == 1 ? "" : "append=true"));
    pass(chain, 0, 2);
    EXPECT_EQ(linesOf(written()).size(), static_cast<size_t>(2 * round));
  }
  Chain chain(line());
  EXPECT_EQ(written(), "");
}

TEST_F(RegionWriteFiles, AppendingEndsALineThatACrashLeft) {
  std::ofstream(path_) << "1,2,3";
  Chain chain(line("append=true"));
  pass(chain, 0, 1);
  EXPECT_EQ(written(), "1,2,3\n" + mot(1, 2));
}

TEST_F(RegionWriteFiles, HaveOneHeaderEach) {
  const std::string header = "frame,id,area,x,y,w,h,cx,cy,dx,dy,reliability,object";
  for (int round = 0; round < 2; ++round) {
    Chain chain("regionwrite format=regions append=true location=" + path_);
    EXPECT_EQ(linesOf(written()), std::vector<std::string>{header});
  }
}

/// Starts an element that must not start; returns the error's text.
std::string startWith(const std::string& location) {
  GstElement* element = gst_element_factory_make("regionwrite", nullptr);
  gst_object_ref_sink(element);
  const BusPtr bus(gst_bus_new());
  gst_element_set_bus(element, bus.get());
  g_object_set(element, "location", location.c_str(), nullptr);
  EXPECT_EQ(gst_element_set_state(element, GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const MessagePtr message(gst_bus_pop_filtered(bus.get(), GST_MESSAGE_ERROR));
  GError* error = nullptr;
  if (message) gst_message_parse_error(message.get(), &error, nullptr);
  const std::string text = error ? error->message : "";
  g_clear_error(&error);
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_bus(element, nullptr);
  gst_object_unref(element);
  return text;
}

TEST_F(RegionWriteFiles, AreWrittenByOneOnly) {
  const std::string other = folder_ / "link";
  std::filesystem::create_symlink(path_, other);
  {
    Chain chain(line());
    pass(chain, 0, 2);
    for (const std::string& location : {path_, other})
      EXPECT_NE(startWith(location).find("another element or program writes there; give each"),
                std::string::npos);
    pass(chain, 2, 3);
    EXPECT_EQ(written(), mot(1, 4));
  }
  Chain chain(line());
  pass(chain, 0, 1);
}

TEST_F(RegionWriteFiles, StandardOutputIsWrittenByOneOnly) {
  const Chain chain("regionwrite format=mot");
  EXPECT_NE(startWith("-").find("another element writes there"), std::string::npos);
}

TEST_F(RegionWriteFiles, DevicesAreForAll) {
  const Chain one("regionwrite location=/dev/null"), two("regionwrite location=/dev/null");
}

TEST_F(RegionWriteFiles, GoOnUnderTheirNameAfterAnotherProgramMovedThem) {
  Chain chain(line());
  pass(chain, 0, 2);
  std::filesystem::rename(path_, path_ + ".moved");
  pass(chain, 2, 3);
  reopen(chain);
  pass(chain, 3, 5);
  EXPECT_EQ(contentOf(path_ + ".moved"), mot(1, 4));
  EXPECT_EQ(written(), mot(4, 6));
  reopen(chain);
  pass(chain, 5, 6);
  EXPECT_EQ(written(), mot(4, 7));
}

TEST_F(RegionWriteFiles, ReopeningAStoppedElementDoesNothing) {
  GstElement* element = gst_element_factory_make("regionwrite", nullptr);
  g_signal_emit_by_name(element, "reopen");
  gst_object_unref(element);
}

TEST_F(RegionWriteFiles, OthersAreBegunBySize) {
  const size_t bytes = mot(1, 4).size();
  Chain chain(line("max-files=2 max-file-size=" + std::to_string(bytes + 5)));
  pass(chain, 0, 8);
  EXPECT_EQ(old(2), mot(1, 4));
  EXPECT_EQ(old(1), mot(4, 7));
  EXPECT_EQ(written(), mot(7, 9));
  pass(chain, 8, 9);
  ASSERT_TRUE(chain.pass(frameWith(9, 1)));
  EXPECT_EQ(old(2), mot(4, 7));
  EXPECT_FALSE(std::filesystem::exists(path_ + ".3"));
}

TEST_F(RegionWriteFiles, OthersAreBegunByTime) {
  Chain chain(line("max-file-duration=" + std::to_string(100 * GST_MSECOND)));
  pass(chain, 0, 7);
  EXPECT_EQ(old(2), mot(1, 4));
  EXPECT_EQ(old(1), mot(4, 7));
  EXPECT_EQ(written(), mot(7, 8));
}

TEST_F(RegionWriteFiles, ALineThatIsLargerThanAFileIsWritten) {
  Chain chain(line("max-file-size=1"));
  pass(chain, 0, 3);
  EXPECT_EQ(old(2), mot(1, 2));
  EXPECT_EQ(old(1), mot(2, 3));
  EXPECT_EQ(written(), mot(3, 4));
}

/// LOCATION.1 is a folder: nothing is lost, and it is told.
TEST_F(RegionWriteFiles, GrowOnWhereNoOtherCanBeBegun) {
  std::filesystem::create_directory(path_ + ".1");
  Chain chain(line("max-files=1 max-file-size=1"));
  pass(chain, 0, 3);
  EXPECT_EQ(written(), mot(1, 4));
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("grows on"), std::string::npos);
}

}  // namespace
}  // namespace rg
