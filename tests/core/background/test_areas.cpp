// SPDX-License-Identifier: LGPL-2.1-or-later
// From areas of interest to regions: bgremove method=frame-difference, then hsvsegment scope=areas.
#include "core/background/background.hpp"
#include "core/segmentation/segmentation.hpp"
#include "tests/core/scenes.hpp"
#include "tests/support/same_regions.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace rg {
namespace {

using scenes::Rgb;

constexpr Size kSize{320, 240};

int bounce(int start, int step, int frame, int most) {
  const int p = (start + step * frame) % (2 * most);
  return p < most ? p : 2 * most - p;
}

/// Things with a light and a dark half that cross a tiled wall.
std::shared_ptr<const Picture> shoot(int things, int frame) {
  std::vector<Box> boxes;
  for (int i = 0; i < things; ++i)
    boxes.push_back({bounce(43 * i, 2 + i % 3, frame, kSize.width - 24),
                     bounce(29 * i, 1 + i % 2, frame, kSize.height - 24), 24, 24});
  return scenes::paint(kSize, [&](int x, int y) {
    const auto noise = static_cast<int>(
        mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(frame)) %
        3);
    Rgb colour{static_cast<uint8_t>(90 + x / 40 % 3 * 20),
               static_cast<uint8_t>(110 + y / 30 % 2 * 25), 90};
    for (const Box& box : boxes)
      if (box.contains({x, y})) colour = y < box.y + 12 ? Rgb{220, 60, 40} : Rgb{40, 40, 200};
    return Rgb{static_cast<uint8_t>(colour.red + noise), static_cast<uint8_t>(colour.green + noise),
               static_cast<uint8_t>(colour.blue + noise)};
  });
}

std::shared_ptr<const background::Foreground> findThings(int things, int threads) {
  const auto stage = background::makeStage(scenes::contextWith(threads));
  background::Params params;
  params.method = background::Method::FrameDifference;
  std::shared_ptr<const background::Foreground> found;
  for (int frame = 0; frame < 50; ++frame)
    found = *stage->process(shoot(things, frame), params, {frame * int64_t{40'000'000}, true});
  return found;
}

std::shared_ptr<const segmentation::Labels> divide(
    const std::shared_ptr<const background::Foreground>& foreground, segmentation::Scope scope,
    int threads) {
  segmentation::Params params;
  params.scope = scope;
  return *segmentation::makeStage(scenes::contextWith(threads))
              ->process(foreground->picture, foreground, params);
}

/// The labels that meet in a pixel of `part`.
std::set<std::pair<int, int>> pairsOf(const segmentation::Labels& part,
                                      const segmentation::Labels& all) {
  std::set<std::pair<int, int>> pairs;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      if (part.ids.at(x, y) != segmentation::kNoRegion)
        pairs.emplace(part.ids.at(x, y), all.ids.at(x, y));
  return pairs;
}

TEST(ScopeAreas, FindsTheRegionsOfTheWholeFrameInsideTheAreas) {
  for (const int things : {1, 3, 5, 7, 10, 13}) {
    SCOPED_TRACE(std::to_string(things) + " things");
    const auto foreground = findThings(things, 1);
    const auto all = divide(foreground, segmentation::Scope::Frame, 1);
    const auto part = divide(foreground, segmentation::Scope::Areas, 1);
    const test::RegionMatch match = test::matchRegions(*part, *all);
    // Both halves of a thing; things may overlap.
    EXPECT_GE(match.whole, static_cast<uint32_t>(things));
    EXPECT_EQ(match.same, match.whole);
    // Regions at the cover's edge end there in both scopes.
    EXPECT_EQ(pairsOf(*part, *all).size(), part->count);
    for (const int threads : {2, 4})
      EXPECT_TRUE(scenes::areEqual(part->ids,
                                   divide(foreground, segmentation::Scope::Areas, threads)->ids));
  }
}

TEST(ScopeAreas, LabelsEveryPixelInAndAroundTheAreasAndNoOther) {
  const auto foreground = findThings(3, 2);
  const auto labels = divide(foreground, segmentation::Scope::Areas, 2);
  EXPECT_EQ(labels->scope, segmentation::Scope::Areas);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      bool isNear = false;
      for (const Box& area : foreground->areas)
        isNear = isNear || segmentation::coverOf(area, kSize).contains({x, y});
      ASSERT_EQ(labels->ids.at(x, y) != segmentation::kNoRegion, isNear) << x << ' ' << y;
    }
}

TEST(ScopeAreas, HasNoRegionsWithoutAreas) {
  EXPECT_EQ(divide(findThings(0, 1), segmentation::Scope::Areas, 1)->count, 0u);
}

TEST(ScopeAreas, NeedsAForeground) {
  segmentation::Params params;
  params.scope = segmentation::Scope::Areas;
  const auto result =
      segmentation::makeStage(scenes::contextWith(1))->process(shoot(0, 0), nullptr, params);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("bgremove"), std::string::npos);
}

}  // namespace
}  // namespace rg
