// SPDX-License-Identifier: LGPL-2.1-or-later
// What a frame with results holds while it waits in a queue, and what is left of large frames.
#include "gst/meta/result_meta.hpp"
#include "tests/support/busy_scene.hpp"
#include "tests/support/harness.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::busyFrame;
using testing::Caps;
using testing::Chain;
using testing::heapBytes;

/// On the heap for each of `count` frames that wait behind the chain, their own pixels left out.
double bytesPerWaiting(Chain& chain, int index, int count) {
  std::vector<BufferPtr> waiting;
  size_t pixels = 0;
  const size_t before = heapBytes();
  for (int i = 0; i < count; ++i) {
    waiting.push_back(chain.pass(busyFrame(chain.caps(), index + i)));
    pixels += gst_buffer_get_size(waiting.back().get());
  }
  return (static_cast<double>(heapBytes() - before) - static_cast<double>(pixels)) / count;
}

TEST(HeldMemory, OfAWaitingFrameIsBelowABytePerPixel) {
  if (heapBytes() == 0) GTEST_SKIP() << "this allocator does not tell what is in use";
  for (const char* stages : {testing::kQuickStages, testing::kFrameScopeStages}) {
    Chain chain(stages, {"I420", 640, 360});
    int index = 0;
    ASSERT_TRUE(testing::showObjects(chain, index));
    EXPECT_LT(bytesPerWaiting(chain, index, 24), 1.0 * 640 * 360) << stages;
  }
}

TEST(HeldMemory, IsGivenBackWhenFramesGetSmall) {
  if (heapBytes() == 0) GTEST_SKIP() << "this allocator does not tell what is in use";
  const auto bytesAfter = [](const std::vector<Caps>& sizes) {
    Chain chain(testing::kQuickStages, sizes.front());
    int index = 0;
    for (const Caps& caps : sizes) {
      chain.setCaps(caps);
      for (int i = 0; i < 4; ++i) (void)chain.pass(busyFrame(caps, index++));
      EXPECT_TRUE(testing::showObjects(chain, index));
    }
    return heapBytes();
  };
  const Caps small{"I420", 320, 240}, large{"I420", 3840, 2160};
  const size_t before = bytesAfter({small});
  EXPECT_LT(bytesAfter({large, small}), before + (size_t{6} << 20));
}

TEST(HeldMemory, IsOnlyForReadersBehindTheLastStage) {
  Chain chain(std::string(testing::kQuickStages) + " ! srg");
  EXPECT_EQ(chain.push(busyFrame(chain.caps(), 0)), GST_FLOW_ERROR);
  EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find("hsvsegment"), std::string::npos);
}

}  // namespace
}  // namespace rg
