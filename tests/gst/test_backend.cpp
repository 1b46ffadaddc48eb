// SPDX-License-Identifier: LGPL-2.1-or-later
// Where there is no GPU: backend=auto takes the CPU, backend=cuda is an error that says why.
#include "tests/support/busy_scene.hpp"

#include <gtest/gtest.h>

#include <string>

namespace rg::testing {
namespace {

std::string activeBackend(GstElement* element) {
  gchar* text = nullptr;
  g_object_get(element, "active-backend", &text, nullptr);
  std::string name(text);
  g_free(text);
  return name;
}

std::string activeBackend(const Chain& chain) {
  GstElement* element = chain.element("bgremove");
  std::string name = activeBackend(element);
  gst_object_unref(element);
  return name;
}

class BackendWithoutGpu : public ::testing::Test {
 protected:
  void SetUp() override {
    Chain chain("bgremove backend=auto");
    if (activeBackend(chain) != "cpu") GTEST_SKIP() << "there is a GPU";
  }
};

TEST_F(BackendWithoutGpu, AutoFindsObjectsOnTheCpu) {
  Chain chain("bgremove training-frames=2 backend=auto ! hsvsegment ! srg ! prmmotion ! mrfmerge");
  int index = 0;
  EXPECT_TRUE(showObjects(chain, index));
  EXPECT_EQ(activeBackend(chain), "cpu");
  EXPECT_EQ(chain.message(GST_MESSAGE_WARNING), nullptr);
}

TEST_F(BackendWithoutGpu, CudaIsAnErrorThatNamesTheRemedy) {
  GstElement* element = gst_element_factory_make("bgremove", nullptr);
  gst_object_ref_sink(element);
  const BusPtr bus(gst_bus_new());
  gst_element_set_bus(element, bus.get());
  gst_util_set_object_arg(G_OBJECT(element), "backend", "cuda");
  EXPECT_EQ(gst_element_set_state(element, GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const MessagePtr message(gst_bus_pop_filtered(bus.get(), GST_MESSAGE_ERROR));
  ASSERT_TRUE(message);
  GError* error = nullptr;
  gst_message_parse_error(message.get(), &error, nullptr);
  EXPECT_NE(std::string(error->message).find("backend=auto"), std::string::npos) << error->message;
  g_error_free(error);
  EXPECT_EQ(activeBackend(element), "");
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_bus(element, nullptr);
  gst_object_unref(element);
}

}  // namespace
}  // namespace rg::testing
