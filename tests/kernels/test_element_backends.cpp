// SPDX-License-Identifier: LGPL-2.1-or-later
// Elements with a GPU that is the host (kernels/shim): what an application sees of it.
#include "kernels/backend/staging.hpp"
#include "kernels/shim/block.hpp"
#include "kernels/shim/faults.hpp"
#include "tests/kernels/marked_memory.hpp"
#include "tests/support/busy_scene.hpp"

#include <gst/gst.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rg::testing {
namespace {

using gpu::shim::Fault;

const Caps kCaps{"I420", 96, 72};
constexpr int kFrames = 16, kFaulty = 10;

constexpr const char* kOnDevice[] = {"bgremove", "hsvsegment", "srg", "prmmotion", "mrfmerge"};

std::string activeBackend(const Chain& chain, const char* name) {
  GstElement* element = chain.element(name);
  gchar* text = nullptr;
  g_object_get(element, "active-backend", &text, nullptr);
  std::string backend(text);
  g_free(text);
  gst_object_unref(element);
  return backend;
}

/// What all elements that can use a device run on, where it is the same.
std::string activeBackend(const Chain& chain) {
  const std::string first = activeBackend(chain, kOnDevice[0]);
  for (const char* name : kOnDevice)
    if (activeBackend(chain, name) != first) return "several";
  return first;
}

std::string stagesWith(const std::string& backend) {
  const std::string on = " backend=" + backend;
  return "bgremove training-frames=2" + on + " ! hsvsegment" + on + " ! srg" + on +
         " ! prmmotion max-shift=6" + on + " ! mrfmerge" + on;
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

class ElementBackend : public ::testing::Test {
 protected:
  ElementBackend() {
    gpu::shim::begin({});
    gpu::shim::plan(std::nullopt);
  }
};

TEST_F(ElementBackend, TheStagesSayTheSame) {
  Chain cpu(stagesWith("cpu"), kCaps), gpu(stagesWith("cuda"), kCaps);
  const auto expected = tellAll(cpu, std::nullopt);
  EXPECT_EQ(tellAll(gpu, std::nullopt), expected);
  EXPECT_EQ(activeBackend(cpu), "cpu");
  EXPECT_EQ(activeBackend(gpu), "cuda: host");
  EXPECT_NE(expected.back(), expected.front());
  EXPECT_EQ(gpu.message(GST_MESSAGE_WARNING), nullptr);
}

/// Also in the ways that are not the default ones.
TEST_F(ElementBackend, TheOtherMethodsSayTheSame) {
  const auto stages = [](const std::string& background, const std::string& backend) {
    const std::string on = " backend=" + backend;
    return "bgremove method=" + background + on + " ! hsvsegment colour-space=hsv" + on + " ! srg" +
           on + " ! prmmotion method=literal max-shift=3" + on + " ! mrfmerge method=literal" + on;
  };
  for (const char* background : {"paper training-frames=2", "frame-difference"}) {
    SCOPED_TRACE(background);
    Chain cpu(stages(background, "cpu"), kCaps), gpu(stages(background, "cuda"), kCaps);
    const auto expected = tellAll(cpu, std::nullopt);
    EXPECT_EQ(tellAll(gpu, std::nullopt), expected);
    EXPECT_EQ(activeBackend(gpu), "cuda: host");
    EXPECT_NE(expected.back(), expected.front());
    EXPECT_EQ(gpu.message(GST_MESSAGE_WARNING), nullptr);
  }
}

/// What one element has written on the host the next one reads on the device, and the other way
/// round.
TEST_F(ElementBackend, EachElementMayRunOnItsOwn) {
  const auto stages = [](const char* odd, const char* even) {
    const auto on = [](const std::string& element, const std::string& backend) {
      return element + " backend=" + backend + " ! ";
    };
    return on("bgremove training-frames=2", odd) + on("hsvsegment", even) + on("srg", odd) +
           on("prmmotion max-shift=6", even) + "mrfmerge backend=" + odd;
  };
  Chain cpu(stages("cpu", "cpu"), kCaps);
  const auto expected = tellAll(cpu, std::nullopt);
  for (const auto& [odd, even] : {std::pair("cpu", "cuda"), std::pair("cuda", "cpu")}) {
    SCOPED_TRACE(odd);
    Chain mixed(stages(odd, even), kCaps);
    EXPECT_EQ(tellAll(mixed, std::nullopt), expected);
    EXPECT_EQ(mixed.message(GST_MESSAGE_WARNING), nullptr);
  }
}

/// How many calls the last frame takes.
uint64_t callsOfFrame() {
  Chain gpu(stagesWith("cuda"), kCaps);
  for (int i = 0; i < kFaulty; ++i) {
    gpu::shim::plan(std::nullopt);
    EXPECT_TRUE(gpu.pass(busyFrame(kCaps, i)));
  }
  return gpu::shim::countCalls();
}

/// Calls of one frame, in steps that hit other ones in each run, and each element: the last one has
/// the fewest.
std::vector<uint64_t> chooseCalls() {
  std::mt19937 random(std::random_device{}());
  const uint64_t calls = callsOfFrame();
  std::vector<uint64_t> chosen;
  for (uint64_t call = random() % 9; call + 3 < calls; call += 6 + random() % 9)
    chosen.push_back(call);
  chosen.push_back(calls - 3);
  return chosen;
}

/// Each element tells of its own failure.
TEST_F(ElementBackend, AFailureIsToldOnceAndCostsNothing) {
  Chain cpu(stagesWith("cpu"), kCaps);
  const auto expected = tellAll(cpu, std::nullopt);
  std::set<std::string> fallen;
  for (const uint64_t call : chooseCalls()) {
    SCOPED_TRACE("call " + std::to_string(call));
    Chain gpu(stagesWith("auto"), kCaps);
    ASSERT_EQ(activeBackend(gpu), "cuda: host");
    EXPECT_EQ(tellAll(gpu, Fault{call, DeviceError::Kind::Failed}), expected);
    int stages = 0;
    for (const char* name : kOnDevice)
      if (activeBackend(gpu, name) == "cpu") stages += fallen.insert(name).second || true;
    EXPECT_EQ(stages, 1);
    EXPECT_NE(gpu.complaint(GST_MESSAGE_WARNING).find("CUDA device failed"), std::string::npos);
    EXPECT_EQ(gpu.message(GST_MESSAGE_WARNING), nullptr);
  }
  EXPECT_EQ(fallen.size(), std::size(kOnDevice));
}

/// Each element tells of it, and bgremove of the model, which was on the device only.
void expectLoss(const Fault& fault) {
  Chain gpu(stagesWith("cuda"), kCaps);
  (void)tellAll(gpu, fault);
  EXPECT_EQ(activeBackend(gpu), "cpu");
  constexpr auto kWanted = static_cast<GstMessageType>(GST_MESSAGE_WARNING | GST_MESSAGE_ELEMENT);
  int warnings = 0, losses = 0;
  while (const MessagePtr message = gpu.message(kWanted)) {
    warnings += GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_WARNING;
    losses += gst_message_has_name(message.get(), "regiongraph-model-lost") != FALSE;
  }
  EXPECT_EQ(warnings, static_cast<int>(std::size(kOnDevice)));
  EXPECT_EQ(losses, 1);
}

TEST_F(ElementBackend, ALostDeviceIsASceneEventAndNoLostFrame) {
  expectLoss({12, DeviceError::Kind::Lost});
}

TEST_F(ElementBackend, ADeviceThatHangsIsALostOne) {
  const int64_t begin = gpu::runtime::clockNs();
  expectLoss({12, {}, true});
  // One of the elements has waited, the others know.
  EXPECT_LT(gpu::runtime::clockNs() - begin, 2 * gpu::kHangNs);
}

/// Whatever is in view: the device's memory is of the size before.
TEST_F(ElementBackend, TheSizeMayChangeWithObjectsInView) {
  Chain cpu(stagesWith("cpu"), kCaps), gpu(stagesWith("cuda"), kCaps);
  for (const Caps& caps : {kCaps, Caps{"I420", 130, 50}, Caps{"GRAY8", 65, 91}, kCaps}) {
    cpu.setCaps(caps);
    gpu.setCaps(caps);
    EXPECT_EQ(tellAll(gpu, std::nullopt), tellAll(cpu, std::nullopt)) << caps.text();
  }
  EXPECT_EQ(activeBackend(gpu), "cuda: host");
}

/// One property sets all children, and these share what lies on the device.
TEST_F(ElementBackend, ABinsStagesShareADevice) {
  Chain cpu("regiontrack training-frames=2", kCaps);
  Chain gpu("regiontrack training-frames=2 backend=cuda", kCaps);
  EXPECT_EQ(tellAll(gpu, std::nullopt), tellAll(cpu, std::nullopt));
  GstElement* bin = gpu.element("regiontrack");
  std::set<const void*> shared;
  for (const char* name : kOnDevice) {
    GstElement* child = gst_bin_get_by_name(GST_BIN(bin), name);
    GstContext* context = gst_element_get_context(child, "gst.regiongraph.Device.0");
    ASSERT_NE(context, nullptr) << name;
    const GValue* device = gst_structure_get_value(gst_context_get_structure(context), "device");
    shared.insert(static_cast<const std::shared_ptr<Device>*>(g_value_get_boxed(device))->get());
    gst_context_unref(context);
    gst_object_unref(child);
  }
  gst_object_unref(bin);
  EXPECT_EQ(shared.size(), 1u);
}

constexpr const char* kDeviceFeature = "(memory:CUDAMemory)";

/// What all stages say of frames that lie on the device.
std::vector<std::string> tellOfDevice(Chain& chain, std::optional<Fault> fault) {
  EXPECT_TRUE(sendCaps(chain, "video/x-raw" + std::string(kDeviceFeature) +
                                  chain.caps().text().substr(strlen("video/x-raw"))));
  Story story;
  std::vector<std::string> told;
  for (int i = 0; i < kFrames; ++i) {
    BufferPtr frame = busyFrame(chain.caps(), i);
    markAsDeviceMemory(frame.get());
    if (i == kFaulty) gpu::shim::plan(fault);
    const BufferPtr out = chain.pass(std::move(frame));
    EXPECT_TRUE(out) << "frame " << i << " is lost";
    told.push_back(out ? story.tell(out.get()) : "");
  }
  return told;
}

int64_t countLaunches(std::string_view kernel) {
  const auto& launches = gpu::shim::launches();
  return std::count_if(launches.begin(), launches.end(),
                       [&](const gpu::Launch& launch) { return kernel == launch.name; });
}

TEST_F(ElementBackend, FramesOnTheDeviceAreReadThere) {
  for (const auto& [format, kernel] :
       {std::pair("NV12", "loadYuv"), {"P010_10LE", "loadYuv"}, {"BGRx", "loadColours"}}) {
    SCOPED_TRACE(format);
    const Caps caps{format, 97, 71};
    Chain cpu(stagesWith("cpu"), caps), gpu(stagesWith("cuda"), caps);
    const auto expected = tellAll(cpu, std::nullopt);
    gpu::shim::begin({});
    EXPECT_EQ(tellOfDevice(gpu, std::nullopt), expected);
    EXPECT_EQ(countLaunches(kernel), kFrames);
    EXPECT_EQ(activeBackend(gpu), "cuda: host");
    EXPECT_EQ(gpu.message(GST_MESSAGE_WARNING), nullptr);
  }
}

/// By way of the host: those that are looked at smaller, and those of a stage on the CPU.
TEST_F(ElementBackend, OtherFramesOfADeviceAreReadHere) {
  for (const char* stages : {"bgremove training-frames=2 backend=cpu",
                             "bgremove training-frames=2 backend=cuda analysis-height=40"}) {
    SCOPED_TRACE(stages);
    Chain here(stages, kCaps), there(stages, kCaps);
    const auto expected = tellAll(here, std::nullopt);
    gpu::shim::begin({});
    EXPECT_EQ(tellOfDevice(there, std::nullopt), expected);
    EXPECT_EQ(countLaunches("loadYuv"), 0);
  }
}

/// The first calls of a frame are those that read it.
TEST_F(ElementBackend, AFrameThatCantBeReadThereIsReadHere) {
  Chain cpu(stagesWith("cpu"), kCaps);
  const auto expected = tellAll(cpu, std::nullopt);
  for (uint64_t call = 0; call < 12; ++call) {
    SCOPED_TRACE("call " + std::to_string(call));
    Chain gpu(stagesWith("cuda"), kCaps);
    EXPECT_EQ(tellOfDevice(gpu, Fault{call}), expected);
    EXPECT_EQ(activeBackend(gpu, "bgremove"), "cpu");
    EXPECT_NE(gpu.complaint(GST_MESSAGE_WARNING).find("CUDA device failed"), std::string::npos);
  }
}

/// The next start may be on another device.
TEST_F(ElementBackend, NothingIsLeftOnTheDeviceWhenItStops) {
  const int64_t before = gpu::shim::countAllocations();
  Chain chain("bgremove backend=cuda", kCaps);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(chain.pass(busyFrame(kCaps, i)));
  EXPECT_GT(gpu::shim::countAllocations(), before);
  GstElement* element = chain.element("bgremove");
  gst_element_set_state(element, GST_STATE_NULL);
  EXPECT_EQ(gpu::shim::countAllocations(), before);
  EXPECT_EQ(activeBackend(chain, "bgremove"), "");
  gst_object_unref(element);
}

TEST_F(ElementBackend, ANumberThatNoDeviceHasIsAnError) {
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
