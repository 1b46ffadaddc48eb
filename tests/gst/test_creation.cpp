// SPDX-License-Identifier: LGPL-2.1-or-later
// Elements that there was no memory for, and texts that are too long.
#include "tests/support/failing_new.hpp"
#include "tests/support/harness.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace rg {
namespace {

using testing::BusPtr;
using testing::FailingNew;
using testing::MessagePtr;

std::vector<const char*> factories() {
  std::vector<const char*> all{"bgremove",   "hsvsegment", "srg",         "prmmotion",  "mrfmerge",
                               "regionmask", "regiontext", "regiontrack", "regionwrite"};
#ifdef REGIONGRAPH_HAS_OVERLAY
  all.push_back("regionoverlay");
#endif
  return all;
}

/// An element and the bus that it posts to.
class Element {
 public:
  explicit Element(GstElement* element) : element_(element), bus_(gst_bus_new()) {
    gst_object_ref_sink(element_);
    gst_element_set_bus(element_, bus_.get());
  }
  explicit Element(const char* factory) : Element(gst_element_factory_make(factory, nullptr)) {}
  ~Element() {
    gst_element_set_state(element_, GST_STATE_NULL);
    gst_element_set_bus(element_, nullptr);
    gst_bus_set_flushing(bus_.get(), TRUE);
    gst_object_unref(element_);
  }
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;
  [[nodiscard]] GstElement* get() const { return element_; }

  /// Text of the next error or warning; empty without one.
  [[nodiscard]] std::string complaint(GstMessageType type) const {
    const MessagePtr message(gst_bus_pop_filtered(bus_.get(), type));
    if (!message) return {};
    GError* error = nullptr;
    if (type == GST_MESSAGE_ERROR)
      gst_message_parse_error(message.get(), &error, nullptr);
    else
      gst_message_parse_warning(message.get(), &error, nullptr);
    std::string text = error->message;
    g_error_free(error);
    return text;
  }

 private:
  GstElement* element_;
  BusPtr bus_;
};

/// Reads each property of the plugin's elements, and writes back what it is.
void touchProperties(GstElement* element) {
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
  for (guint i = 0; i < count; ++i) {
    if ((specs[i]->flags & G_PARAM_READWRITE) != G_PARAM_READWRITE) continue;
    if (!g_type_is_a(G_OBJECT_TYPE(element), specs[i]->owner_type) ||
        specs[i]->owner_type != G_OBJECT_TYPE(element))
      continue;
    GValue value = G_VALUE_INIT;
    g_value_init(&value, specs[i]->value_type);
    g_object_get_property(G_OBJECT(element), specs[i]->name, &value);
    // What regiontrack has set of a child is lost with it.
    const bool isSetByBin = GST_IS_BIN(element) && std::string_view(specs[i]->name) == "camera";
    EXPECT_TRUE(isSetByBin || g_param_value_defaults(specs[i], &value)) << specs[i]->name;
    g_object_set_property(G_OBJECT(element), specs[i]->name, &value);
    g_value_unset(&value);
  }
  g_free(specs);
}

/// What an application may do with an element that it does not know to be none.
void useWhileNull(GstElement* element) {
  touchProperties(element);
  GstQuery* query = gst_query_new_latency();
  gst_element_query(element, query);
  gst_query_unref(query);
  for (GList* pads = element->pads; pads; pads = pads->next)
    gst_pad_send_event(GST_PAD(pads->data), GST_PAD_IS_SRC(pads->data)
                                                ? gst_event_new_reconfigure()
                                                : gst_event_new_flush_stop(TRUE));
}

TEST(Creation, WithoutMemoryGivesAnElementThatFailsToStart) {
  for (const char* factory : factories()) {
    SCOPED_TRACE(factory);
    int failures = 0;
    for (int passes = 0; passes < 1000; ++passes) {
      GstElement* made = nullptr;
      bool hasFailed = false;
      {
        const FailingNew fail(passes);
        made = gst_element_factory_make(factory, nullptr);
        hasFailed = fail.hasFailed();
      }
      ASSERT_TRUE(made);
      const Element element(made);
      useWhileNull(made);
      const GstStateChangeReturn started = gst_element_set_state(made, GST_STATE_PAUSED);
      if (!hasFailed) {
        EXPECT_NE(started, GST_STATE_CHANGE_FAILURE);
        break;
      }
      ++failures;
      EXPECT_EQ(started, GST_STATE_CHANGE_FAILURE) << passes;
      const std::string error = element.complaint(GST_MESSAGE_ERROR);
      EXPECT_NE(error.find("no memory to make this element"), std::string::npos) << error;
    }
    EXPECT_TRUE(failures > 0 || std::string(factory) == "regionmask");
  }
}

TEST(Properties, ATextThatThereIsNoMemoryForLeavesTheOldOne) {
  const Element element("regionwrite");
  g_object_set(element.get(), "location", "/before", nullptr);
  const std::string longText(200, 'x');
  {
    const FailingNew fail(0);
    g_object_set(element.get(), "location", longText.c_str(), nullptr);
  }
  gchar* location = nullptr;
  g_object_get(element.get(), "location", &location, nullptr);
  EXPECT_STREQ(location, "/before");
  g_free(location);
  EXPECT_NE(element.complaint(GST_MESSAGE_WARNING).find("location stays"), std::string::npos);
}

TEST(Properties, TextsAreCutWhereNoneMeansAnything) {
  const Element element("bgremove");
  g_object_set(element.get(), "areas-of-interest", std::string(3'000'000, ' ').c_str(), nullptr);
  gchar* text = nullptr;
  g_object_get(element.get(), "areas-of-interest", &text, nullptr);
  EXPECT_EQ(std::string(text).size(), size_t{1} << 20);
  g_free(text);
}

}  // namespace
}  // namespace rg
