// SPDX-License-Identifier: LGPL-2.1-or-later
// All five stages in a row on every SIMD target of this machine, with one to four threads: the same
// regions, motions, energies and objects, frame by frame, as text.
#include "core/background/background.hpp"
#include "core/graph/graph.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/objects.hpp"
#include "core/segmentation/segmentation.hpp"
#include "core/text/graph.hpp"
#include "core/text/json.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <string>
#include <vector>

namespace rg {
namespace {

constexpr int64_t kFrameNs = 40'000'000;
constexpr int kFrames = 30;
constexpr Size kSize{161, 123};  // No multiple of anything that vectors or words hold.

/// Two things in different colours cross a room with a coarse pattern and noise.
std::shared_ptr<const Picture> shoot(int frame) {
  return scenes::paint(kSize, [&](int x, int y) {
    const auto dice =
        mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(frame));
    const int level = 80 + 30 * ((x / 40 + y / 30) % 3);
    std::array<int, 3> colour{level, level, level - 20};
    if (Box{4 * frame, 40, 24, 44}.contains({x, y})) colour = {200, 60 + y, 50};
    if (Box{130 - 4 * frame, 60, 28, 36}.contains({x, y})) colour = {40, 70, 180 - x / 8};
    const auto noisy = [&](size_t c) {
      const int off = static_cast<int>(dice >> 8 * c & 7) - 3;
      return static_cast<uint8_t>(std::clamp(colour[c] + off, 0, 255));
    };
    return scenes::Rgb{noisy(0), noisy(1), noisy(2)};
  });
}

const std::vector<std::shared_ptr<const Picture>>& clip() {
  static const auto frames = [] {
    std::vector<std::shared_ptr<const Picture>> all;
    for (int frame = 0; frame < kFrames; ++frame) all.push_back(shoot(frame));
    return all;
  }();
  return frames;
}

std::vector<std::string> describe(const std::shared_ptr<const Executor>& executor,
                                  segmentation::Scope scope) {
  const Context context{executor, nullptr};
  const auto background = background::makeStage(context);
  const auto segmentation = segmentation::makeStage(context);
  const auto graph = graph::makeStage(context);
  const auto motion = motion::makeStage(context);
  const auto objects = objects::makeStage(context);
  segmentation::Params params;
  params.scope = scope;
  std::vector<std::string> lines;
  for (int frame = 0; frame < kFrames; ++frame) {
    const FrameTime time{frame * kFrameNs, true};
    const auto& picture = clip()[static_cast<size_t>(frame)];
    const auto foreground = *background->process(picture, {}, time);
    const auto labels = *segmentation->process(picture, foreground, params);
    const auto motions = *motion->process(*graph->process(labels, {}), {}, {});
    const auto found = *objects->process(motions, {}, time);
    std::string& line = lines.emplace_back();
    const text::FrameStamp stamp{static_cast<uint64_t>(frame + 1), kSize, {}, {}};
    text::appendGraph(line, *found, stamp);
    text::appendJson(line, *found, stamp, text::Contours::Write);
  }
  return lines;
}

class ChainTargets : public testing::TestWithParam<segmentation::Scope> {};

TEST_P(ChainTargets, EveryTargetAndThreadCountSaysTheSame) {
  const auto expected = describe(std::make_shared<const Executor>(1), GetParam());
  size_t objects = 0;
  for (const std::string& line : expected) objects += line.find("\"id\":") != std::string::npos;
  EXPECT_GE(objects, kFrames / 3) << "too little is seen for a comparison";
  test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
    const auto lines = describe(executor, GetParam());
    for (size_t i = 0; i < lines.size(); ++i) ASSERT_EQ(lines[i], expected[i]) << "frame " << i;
  });
}

INSTANTIATE_TEST_SUITE_P(Scopes, ChainTargets,
                         testing::Values(segmentation::Scope::Frame,
                                         segmentation::Scope::Foreground,
                                         segmentation::Scope::Areas));

}  // namespace
}  // namespace rg
