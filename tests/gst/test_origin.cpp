// SPDX-License-Identifier: LGPL-2.1-or-later
// The user's own words in lines and messages.
#include "gst/support/origin.hpp"
#include "tests/support/busy_scene.hpp"
#include "tests/support/written_lines.hpp"

namespace rg {
namespace {

using testing::busyFrame;
using testing::bytesOf;
using testing::Caps;
using testing::Chain;
using testing::frameWith;
using testing::linesOf;
using testing::MessagePtr;

constexpr const char* kSet = " source=\"gate 3\" tags=\"site=north, lane=7\"";
constexpr const char* kTold = R"("source":"gate 3","tags":{"site":"north","lane":"7"})";
constexpr const char* kElements[] = {"bgremove", "mrfmerge", "regionwrite", "regiontext",
                                     "regiontrack"};

std::string textOf(GstElement* element, const char* name) {
  gchar* text = nullptr;
  g_object_get(element, name, &text, nullptr);
  std::string copy = text ? text : "(null)";
  g_free(text);
  return copy;
}

void expectTold(const GstStructure* fields) {
  EXPECT_STREQ(gst_structure_get_string(fields, "source"), "gate 3");
  GstStructure* tags = nullptr;
  ASSERT_TRUE(gst_structure_get(fields, "tags", GST_TYPE_STRUCTURE, &tags, nullptr));
  EXPECT_STREQ(gst_structure_get_string(tags, "site"), "north");
  EXPECT_STREQ(gst_structure_get_string(tags, "lane"), "7");
  gst_structure_free(tags);
}

/// The element messages that a chain has posted since.
std::vector<MessagePtr> messagesOf(Chain& chain) {
  std::vector<MessagePtr> messages;
  while (MessagePtr message = chain.message(GST_MESSAGE_ELEMENT))
    messages.push_back(std::move(message));
  return messages;
}

/// Objects come, the light goes out, and all ends.
std::vector<MessagePtr> eventfulStory(const std::string& stages) {
  const Caps caps{"I420", 96, 64};
  Chain chain(stages, caps);
  int index = 0;
  EXPECT_TRUE(testing::showObjects(chain, index));
  for (int i = 0; i < 30; ++i)
    EXPECT_TRUE(chain.pass(testing::paint(caps, index++, [](int, int) { return 16; })));
  gst_element_set_state(chain.harness()->element, GST_STATE_NULL);
  return messagesOf(chain);
}

TEST(Origin, IsInEveryMessage) {
  for (const std::string stages :
       {"bgremove training-frames=2 SET ! hsvsegment ! srg ! prmmotion ! "
        "mrfmerge SET",
        "regiontrack training-frames=2 SET"}) {
    SCOPED_TRACE(stages);
    std::string line = stages;
    for (size_t at = 0; (at = line.find("SET")) != std::string::npos;) line.replace(at, 3, kSet);
    bool isSceneTold = false, isObjectTold = false;
    for (const MessagePtr& message : eventfulStory(line)) {
      const GstStructure* fields = gst_message_get_structure(message.get());
      SCOPED_TRACE(gst_structure_get_name(fields));
      expectTold(fields);
      isSceneTold |= gst_structure_has_name(fields, "regiongraph-too-dark") != FALSE;
      isObjectTold |= gst_structure_has_name(fields, "regiongraph-object-end") != FALSE;
    }
    EXPECT_TRUE(isSceneTold && isObjectTold);
  }
}

TEST(Origin, IsInNoMessageByDefault) {
  const auto messages = eventfulStory(testing::kQuickStages);
  EXPECT_FALSE(messages.empty());
  for (const MessagePtr& message : messages) {
    const GstStructure* fields = gst_message_get_structure(message.get());
    EXPECT_FALSE(gst_structure_has_field(fields, "source"));
    EXPECT_FALSE(gst_structure_has_field(fields, "tags"));
  }
}

using OriginLines = testing::WrittenLines;

TEST_F(OriginLines, HaveItInJsonAndNotInCsv) {
  for (const std::string format : {"jsonl", "graph", "mot"}) {
    SCOPED_TRACE(format);
    {
      Chain chain("regionwrite format=" + format + kSet + " location=" + path_);
      for (int i = 0; i < 3; ++i) ASSERT_TRUE(chain.pass(frameWith(i, 1)));
    }
    const auto lines = linesOf(written());
    EXPECT_EQ(lines.size(), 3u);
    for (const std::string& line : lines)
      EXPECT_EQ(line.find(kTold) != std::string::npos, format != "mot") << line;
  }
}

TEST_F(OriginLines, OfRegiontextHaveItToo) {
  Chain chain("regiontext" + std::string(kSet));
  const auto out = chain.pass(frameWith(0, 1));
  ASSERT_TRUE(out);
  const auto bytes = bytesOf(out.get());
  EXPECT_NE(std::string(bytes.begin(), bytes.end()).find(kTold), std::string::npos);
}

/// A text that can't be read is refused at once, and what was set before stays.
TEST(Origin, IsRefusedWhereItCantBeTold) {
  const std::string tooLong = "a=" + std::string(text::kMostOriginBytes - 1, 'b');
  for (const char* name : kElements) {
    SCOPED_TRACE(name);
    Chain chain(std::string(name) + " name=e" +
                (name == kElements[2] ? " location=/dev/null" : ""));
    GstElement* element = chain.element(name);
    ASSERT_TRUE(element);
    EXPECT_EQ(textOf(element, "source"), "");
    EXPECT_EQ(textOf(element, "tags"), "");
    g_object_set(element, "source", "gate 3", "tags", "site=north, lane=7", nullptr);
    EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
    for (const char* text : {"site", "\xff=1", "a=\xff", tooLong.c_str()}) {
      g_object_set(element, "tags", text, nullptr);
      EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("tags stays as it was: "),
                std::string::npos);
      EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");  // Told once.
    }
    g_object_set(element, "source", "\xc3", nullptr);
    EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("not UTF-8"), std::string::npos);
    EXPECT_EQ(textOf(element, "source"), "gate 3");
    EXPECT_EQ(textOf(element, "tags"), "site=north, lane=7");
    g_object_set(element, "source", nullptr, "tags", "", nullptr);
    EXPECT_EQ(textOf(element, "source") + textOf(element, "tags"), "");
    gst_object_unref(element);
  }
}

TEST(Origin, OfRegiontrackIsThatOfItsChildren) {
  GstElement* bin = gst_element_factory_make("regiontrack", nullptr);
  g_object_set(bin, "source", "gate 3", "tags", "lane=7", nullptr);
  for (const char* name : {"bgremove", "mrfmerge"}) {
    GstElement* child = gst_bin_get_by_name(GST_BIN(bin), name);
    EXPECT_EQ(textOf(child, "source"), "gate 3");
    EXPECT_EQ(textOf(child, "tags"), "lane=7");
    gst_object_unref(child);
  }
  gst_object_unref(bin);
}

}  // namespace
}  // namespace rg
