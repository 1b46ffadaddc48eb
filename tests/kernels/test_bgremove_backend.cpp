// SPDX-License-Identifier: LGPL-2.1-or-later
// bgremove with a GPU that is the host (kernels/shim): what an application sees of it.
#include "kernels/shim/block.hpp"
#include "kernels/shim/faults.hpp"
#include "tests/support/busy_scene.hpp"

#include <gst/gst.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace rg::testing {
namespace {

using gpu::shim::Fault;

constexpr Caps kCaps{"I420", 96, 72};
constexpr int kFrames = 16, kFaulty = 10;

std::string activeBackend(const Chain& chain) {
  GstElement* element = chain.element("bgremove");
  gchar* text = nullptr;
  g_object_get(element, "active-backend", &text, nullptr);
  std::string name(text);
  g_free(text);
  gst_object_unref(element);
  return name;
}

std::string stagesWith(const char* backend) {
  return std::string("bgremove training-frames=2 backend=") + backend +
         " ! hsvsegment ! srg ! prmmotion ! mrfmerge";
}

/// What all stages say of each frame.
std::vector<std::string> tellAll(Chain& chain, std::optional<Fault> fault) {
  Story story;
  std::vector<std::string> told;
  for (int i = 0; i < kFrames; ++i) {
    if (i == kFaulty) gpu::shim::plan(fault);
    const BufferPtr out = chain.pass(busyFrame(chain.caps(), i));
    EXPECT_TRUE(out) << "frame " << i << " is lost";
    told.push_back(out ? story.tell(out.get()) : "");
  }
  return told;
}

class BgRemoveBackend : public ::testing::Test {
 protected:
  BgRemoveBackend() {
    gpu::shim::begin({});
    gpu::shim::plan(std::nullopt);
  }
};

TEST_F(BgRemoveBackend, TheStagesSayTheSame) {
  Chain cpu(stagesWith("cpu"), kCaps), gpu(stagesWith("cuda"), kCaps);
  const auto expected = tellAll(cpu, std::nullopt);
  EXPECT_EQ(tellAll(gpu, std::nullopt), expected);
  EXPECT_EQ(activeBackend(cpu), "cpu");
  EXPECT_EQ(activeBackend(gpu), "cuda: host");
  EXPECT_NE(expected.back(), expected.front());
  EXPECT_EQ(gpu.message(GST_MESSAGE_WARNING), nullptr);
}

TEST_F(BgRemoveBackend, AFailureIsToldOnceAndCostsNothing) {
  Chain cpu(stagesWith("cpu"), kCaps), gpu(stagesWith("auto"), kCaps);
  const auto expected = tellAll(cpu, std::nullopt);
  EXPECT_EQ(tellAll(gpu, Fault{12, DeviceError::Kind::Failed}), expected);
  EXPECT_EQ(activeBackend(gpu), "cpu");
  EXPECT_NE(gpu.complaint(GST_MESSAGE_WARNING).find("CUDA device failed"), std::string::npos);
  EXPECT_EQ(gpu.message(GST_MESSAGE_WARNING), nullptr);
}

TEST_F(BgRemoveBackend, ALostDeviceIsASceneEventAndNoLostFrame) {
  Chain gpu(stagesWith("cuda"), kCaps);
  (void)tellAll(gpu, Fault{12, DeviceError::Kind::Lost});
  EXPECT_EQ(activeBackend(gpu), "cpu");
  bool isTold = false;
  while (const MessagePtr message = gpu.message(GST_MESSAGE_ELEMENT))
    isTold |= gst_message_has_name(message.get(), "regiongraph-model-lost") != FALSE;
  EXPECT_TRUE(isTold);
}

/// Whatever is in view: the device's memory is of the size before.
TEST_F(BgRemoveBackend, TheSizeMayChangeWithObjectsInView) {
  Chain cpu(stagesWith("cpu"), kCaps), gpu(stagesWith("cuda"), kCaps);
  for (const Caps& caps : {kCaps, Caps{"I420", 130, 50}, Caps{"GRAY8", 65, 91}, kCaps}) {
    cpu.setCaps(caps);
    gpu.setCaps(caps);
    EXPECT_EQ(tellAll(gpu, std::nullopt), tellAll(cpu, std::nullopt)) << caps.text();
  }
  EXPECT_EQ(activeBackend(gpu), "cuda: host");
}

/// The next start may be on another device.
TEST_F(BgRemoveBackend, NothingIsLeftOnTheDeviceWhenItStops) {
  const int64_t before = gpu::shim::countAllocations();
  Chain chain("bgremove backend=cuda", kCaps);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(chain.pass(busyFrame(kCaps, i)));
  EXPECT_GT(gpu::shim::countAllocations(), before);
  GstElement* element = chain.element("bgremove");
  gst_element_set_state(element, GST_STATE_NULL);
  EXPECT_EQ(gpu::shim::countAllocations(), before);
  EXPECT_EQ(activeBackend(chain), "");
  gst_object_unref(element);
}

TEST_F(BgRemoveBackend, ANumberThatNoDeviceHasIsAnError) {
  GstElement* element = gst_element_factory_make("bgremove", nullptr);
  gst_object_ref_sink(element);
  GstBus* bus = gst_bus_new();
  gst_element_set_bus(element, bus);
  g_object_set(element, "backend", 2, "device-id", 7, nullptr);
  EXPECT_EQ(gst_element_set_state(element, GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const MessagePtr message(gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR));
  ASSERT_TRUE(message);
  GError* error = nullptr;
  gst_message_parse_error(message.get(), &error, nullptr);
  EXPECT_NE(std::string(error->message).find("device-id must be 0"), std::string::npos)
      << error->message;
  g_error_free(error);
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_bus(element, nullptr);
  gst_object_unref(bus);
  gst_object_unref(element);
}

}  // namespace
}  // namespace rg::testing
