// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/detection.hpp"
#include "core/detection/integral.hpp"
#include "core/detection/judge_windows.hpp"
#include "core/detection/search_area.hpp"
#include "core/detection/window_search.hpp"
#include "core/simd/detection/cascade_rows.hpp"
#include "tests/core/detection/cascades.hpp"
#include "tests/core/simd_targets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace rg::detection {
namespace {

using test::halvesCascade;
using test::randomCascade;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Image<uint8_t> noise(Size size) {
  Image<uint8_t> luma(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      luma.at(x, y) = static_cast<uint8_t>((test::hashOf(x / 4, y / 3, 1) & 127) +
                                           (test::hashOf(x, y, 2) & 127));
  return luma;
}

std::vector<Scale> scalesFor(const Cascade& cascade, Size frame, double factor) {
  auto scales = scalesOf({frame, cascade.window, factor});
  EXPECT_TRUE(scales);
  return scales ? *std::move(scales) : std::vector<Scale>();
}

/// By the plain version, with the windows in the order of their numbers.
struct Plain {
  std::vector<uint16_t> stages;
  std::vector<Box> found;
};
Plain judgePlainly(const Cascade& cascade, const std::vector<Scale>& scales,
                   ImageView<const uint8_t> luma, std::span<const Box> areas) {
  Image<uint32_t> sums({luma.size.width + 1, luma.size.height + 1});
  Image<double> squares(sums.size());
  sumIntegrals(luma, {sums, squares});
  const SumLayout layout{1, 0, sums.view().strideBytes / 4, squares.view().strideBytes / 8};
  std::vector<ScaledCascade> scaled;
  std::vector<CascadeView> views;
  for (const Scale& scale : scales) scaled.emplace_back(cascade, scale, layout);
  for (const ScaledCascade& one : scaled) views.push_back(one.view());
  SearchWindows windows;
  EXPECT_TRUE(windows.lay(scales, areas));
  const WindowTable table = windows.table();
  Plain plain;
  plain.stages.resize(table.count);
  judgeWindows({views.data(), sums, squares}, table, plain.stages.data());
  for (uint32_t id = 0; id < table.count; ++id) {
    if (plain.stages[id] != cascade.stages.size()) continue;
    const WindowPlace place = placeOf(table, id);
    const Size size = scales[static_cast<size_t>(table.ranges[place.range].scale)].window;
    plain.found.push_back({place.at.x, place.at.y, size.width, size.height});
  }
  return plain;
}

TEST(Detection, RowsGiveTheBitsOfThePlainVersion) {
  const Size frame{133, 71};
  const Image<uint8_t> luma = noise(frame);
  for (uint32_t seed = 1; seed <= 4; ++seed) {
    const Cascade cascade = randomCascade(seed);
    ASSERT_TRUE(check(cascade)) << check(cascade).error().message;
    Image<uint32_t> sums({frame.width + 1 + simd::kMostLanes, frame.height + 1});
    Image<double> squares({frame.width + 1, frame.height + 1});
    sums.fill(0);
    sumIntegrals(luma, {sums, squares});
    const SumLayout layout{1, 0, sums.view().strideBytes / 4, squares.view().strideBytes / 8};
    for (const double factor : {1.0, 1.7, 3.0}) {
      const Size window{static_cast<int>(12 * factor + .5), static_cast<int>(15 * factor + .5)};
      const ScaledCascade scaled(cascade, {factor, window, 1}, layout);
      std::set<int> depths;
      test::forEachTarget([&] {
        for (int y = 0; y + window.height <= frame.height; y += 7)
          for (const int count : {1, 7, 33, frame.width - window.width + 1}) {
            std::vector<uint16_t> stages(static_cast<size_t>(count));
            simd::judgeRow(scaled.view(), {sums.row(y), squares.row(y), 1, count}, stages.data());
            for (int x = 0; x < count; ++x) {
              const uint16_t expected =
                  judgeWindow(scaled.view(), sums.row(y) + x, squares.row(y) + x);
              ASSERT_EQ(stages[static_cast<size_t>(x)], expected) << x << ", " << y;
              depths.insert(expected);
            }
          }
      });
      EXPECT_GE(depths.size(), 4u) << "seed " << seed;
    }
  }
}

TEST(Detection, ASearchFindsWhatThePlainVersionFinds) {
  const Size frame{241, 223};
  const Image<uint8_t> luma = noise(frame);
  size_t found = 0;
  for (const uint32_t seed : {1U, 3U}) {
    const auto cascade = std::make_shared<Cascade>(randomCascade(seed));
    const auto scales = scalesFor(*cascade, frame, 1.3);
    ASSERT_GT(scales.back().stepPx, 12);  // Judged one by one.
    for (const std::vector<Box>& areas :
         {std::vector{boundsOf(frame)},
          std::vector<Box>{{3, 5, 80, 90}, {101, 0, 120, 60}, {7, 120, 210, 63}}}) {
      const Plain plain = judgePlainly(*cascade, scales, luma, areas);
      found += plain.found.size();
      test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
        WindowSearch search(cascade, scales, frame);
        for (int again = 0; again < 2; ++again) {
          const auto boxes = search.find(luma, areas, *executor);
          ASSERT_TRUE(boxes);
          std::vector<Box> own((*boxes).begin(), (*boxes).end()), expected = plain.found;
          const auto order = [](const Box& a, const Box& b) {
            return std::tie(a.width, a.y, a.x) < std::tie(b.width, b.y, b.x);
          };
          std::stable_sort(expected.begin(), expected.end(), order);
          ASSERT_EQ(own, expected);
        }
      });
    }
  }
  EXPECT_GT(found, 100u);
}

TEST(Detection, AnAreasWindowsAreJudgedAsInTheWholeFrame) {
  const Size frame{240, 160};
  const Image<uint8_t> luma = noise(frame);
  const auto cascade = std::make_shared<Cascade>(randomCascade(2));
  const auto scales = scalesFor(*cascade, frame, 1.15);
  const Executor executor(2);
  WindowSearch search(cascade, scales, frame);
  const auto whole = search.find(luma, std::array{boundsOf(frame)}, executor);
  ASSERT_TRUE(whole);
  const std::vector<Box> all((*whole).begin(), (*whole).end());
  const Box area{33, 21, 111, 95};
  std::vector<Box> expected;
  for (const Box& box : all)
    if (intersect(box, area) == box) expected.push_back(box);
  ASSERT_GT(expected.size(), 10u);
  const auto inside = search.find(luma, std::array{area}, executor);
  ASSERT_TRUE(inside);
  EXPECT_EQ(std::vector<Box>((*inside).begin(), (*inside).end()), expected);
}

TEST(Detection, AreasThatTouchAreOne) {
  std::vector<Box> areas;
  const Size frame{100, 100};
  uniteAreas(std::array{Box{50, 50, 10, 10}, Box{0, 0, 10, 10}, Box{10, 3, 5, 5}}, frame, areas);
  EXPECT_THAT(areas, ElementsAre(Box{0, 0, 15, 10}, Box{50, 50, 10, 10}));
  // The box round two touches a third that neither touches.
  uniteAreas(
      std::array{Box{0, 0, 10, 10}, Box{30, 0, 5, 5}, Box{8, 8, 30, 30}, Box{90, 90, 90, 90}},
      frame, areas);
  EXPECT_THAT(areas, ElementsAre(Box{0, 0, 38, 38}, Box{90, 90, 10, 10}));
  uniteAreas(std::array{Box{-20, -20, 10, 10}, Box{5, 5, 0, 3}}, frame, areas);
  EXPECT_THAT(areas, IsEmpty());
}

TEST(Detection, TooManyAreasAreSearchedAsOne) {
  std::vector<Box> boxes, areas;
  for (int i = 0; i < 400; ++i) boxes.push_back({i % 20 * 10 + 1, i / 20 * 10 + 1, 2, 2});
  uniteAreas(boxes, {1000, 1000}, areas);
  EXPECT_THAT(areas, ElementsAre(Box{1, 1, 192, 192}));
  boxes.resize(200);
  uniteAreas(boxes, {1000, 1000}, areas);
  EXPECT_EQ(areas.size(), 200u);
}

TEST(Detection, WindowsNearEachOtherAreOneDetection) {
  std::vector<Detection> groups;
  const std::vector<Box> windows{
      {10, 10, 40, 40}, {12, 10, 40, 40}, {14, 11, 42, 42}, {200, 100, 40, 40}};
  groupWindows(windows, 2, groups);
  EXPECT_THAT(groups, ElementsAre(Detection{{12, 10, 41, 41}, 3}));
  groupWindows(windows, 1, groups);
  EXPECT_THAT(groups,
              ElementsAre(Detection{{12, 10, 41, 41}, 3}, Detection{{200, 100, 40, 40}, 1}));
  groupWindows(windows, 0, groups);
  EXPECT_EQ(groups.size(), 4u);
  groupWindows(windows, 4, groups);
  EXPECT_THAT(groups, IsEmpty());
}

TEST(Detection, AFewWindowsInsideOfManyAreLeftOut) {
  std::vector<Box> windows(5, Box{100, 100, 100, 100});
  windows.insert(windows.end(), 2, Box{130, 130, 30, 30});
  std::vector<Detection> groups;
  groupWindows(windows, 2, groups);
  EXPECT_THAT(groups, ElementsAre(Detection{{100, 100, 100, 100}, 5}));
}

TEST(Detection, GroupsDoNotDependOnTheOrderOfWindows) {
  std::vector<Box> windows;
  for (int i = 0; i < 500; ++i) {
    const int side = 20 + static_cast<int>(test::hashOf(i, 2, 1) % 20);
    windows.push_back({static_cast<int>(test::hashOf(i, 0, 1) % 300),
                       static_cast<int>(test::hashOf(i, 1, 1) % 300), side, side});
  }
  std::vector<Detection> groups, reversed;
  groupWindows(windows, 2, groups);
  std::reverse(windows.begin(), windows.end());
  groupWindows(windows, 2, reversed);
  EXPECT_EQ(groups, reversed);
  EXPECT_GT(groups.size(), 3u);
}

/// A bright left half beside a dark right one, of several sizes.
Image<uint8_t> halvesAt(Size frame, std::span<const Box> things) {
  Image<uint8_t> luma(frame);
  luma.fill(120);
  for (const Box& box : things)
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x)
        luma.at(x, y) = 2 * (x - box.x) < box.width ? 210 : 30;
  return luma;
}

std::unique_ptr<Stage> stageOf(int threads) {
  return makeStage({std::make_shared<const Executor>(threads), nullptr});
}

TEST(Detection, TheStageFindsThingsOfSeveralSizes) {
  const std::array things{Box{20, 30, 16, 20}, Box{100, 60, 40, 50}, Box{220, 20, 80, 100}};
  const Image<uint8_t> luma = halvesAt({320, 180}, things);
  const auto stage = stageOf(2);
  const auto cascade = std::make_shared<const Cascade>(halvesCascade());
  const auto all = stage->process(luma, std::array{Box{0, 0, 320, 180}}, cascade, {});
  ASSERT_TRUE(all) << all.error().message;
  for (const Box& thing : things)
    EXPECT_TRUE(std::any_of(all->found.begin(), all->found.end(), [&](const Detection& found) {
      const Box& box = found.box;
      return thing.contains({box.x + box.width / 2, box.y + box.height / 2});
    })) << thing.x;
  const auto some = stage->process(luma, std::array{Box{90, 50, 70, 80}}, cascade, {});
  ASSERT_TRUE(some);
  ASSERT_FALSE(some->found.empty());
  for (const Detection& found : some->found)
    EXPECT_EQ(intersect(found.box, Box{90, 50, 70, 80}), found.box);
  const auto none = stage->process(luma, {}, cascade, {});
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->found.empty());
}

TEST(Detection, HeightsBoundWhatIsFound) {
  const std::array things{Box{20, 30, 16, 20}, Box{100, 60, 40, 50}};
  const Image<uint8_t> luma = halvesAt({320, 180}, things);
  const auto stage = stageOf(1);
  const auto cascade = std::make_shared<const Cascade>(halvesCascade());
  for (const auto& [least, most] : {std::pair{35, 0}, {0, 30}, {60, 40}}) {
    Params params;
    params.minHeightPx = least;
    params.maxHeightPx = most;
    const auto found = stage->process(luma, std::array{Box{0, 0, 320, 180}}, cascade, params);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->found.empty(), least == 60);
    for (const Detection& one : found->found) {
      EXPECT_GE(one.box.height, least);
      EXPECT_LE(one.box.height, most == 0 ? 180 : most);
    }
  }
}

TEST(Detection, TheStageFollowsSizesAndCascades) {
  const auto stage = stageOf(2);
  const auto cascade = std::make_shared<const Cascade>(halvesCascade());
  for (const Size frame : {Size{64, 48}, Size{7, 9}, Size{320, 180}, Size{8, 10}, Size{64, 48}}) {
    const Image<uint8_t> luma = noise(frame);
    EXPECT_TRUE(stage->process(luma, std::array{boundsOf(frame)}, cascade, {}));
    const auto other = std::make_shared<const Cascade>(randomCascade(1));
    EXPECT_TRUE(stage->process(luma, std::array{boundsOf(frame)}, other, {}));
    stage->reset(Reset::Stream);
  }
}

TEST(Detection, WhatCanNotBeIsAnError) {
  const auto stage = stageOf(1);
  const Image<uint8_t> luma = noise({64, 48});
  const std::array areas{Box{0, 0, 64, 48}};
  EXPECT_FALSE(stage->process(luma, areas, nullptr, {}));
  const auto cascade = std::make_shared<const Cascade>(halvesCascade());
  EXPECT_FALSE(stage->process(luma, areas, cascade, {1.0}));
  EXPECT_FALSE(stage->process({}, areas, cascade, {}));
  EXPECT_TRUE(stage->process(luma, areas, cascade, {}));
}

}  // namespace
}  // namespace rg::detection
