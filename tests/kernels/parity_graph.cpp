// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/graph/graph.hpp"
#include "kernels/region_graph.hpp"
#include "tests/kernels/divided.hpp"
#include "tests/kernels/regions.hpp"
#include "tests/kernels/tested_device.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace rg::test {
namespace {

struct DeviceSort {
  Numbers keys, values, otherKeys, otherValues, offsets, scratch;
  explicit DeviceSort(size_t capacity) {
    for (Numbers* list : {&keys, &values, &otherKeys, &otherValues})
      list->assign(capacity, 0xA5A5A5A5);
    const int sums = gpu::sortOffsetsOf(static_cast<int>(capacity));
    offsets.assign(static_cast<size_t>(sums) + 1, 0xA5A5A5A5);
    scratch.assign(static_cast<size_t>(gpu::scanScratchOf(sums)), 0xA5A5A5A5);
  }
  gpu::SortView view() {
    return {keys.data(),        values.data(),  otherKeys.data(),
            otherValues.data(), offsets.data(), scratch.data()};
  }
};

void checkGraph(Picture picture, const Image<uint16_t>& ids, uint32_t count,
                Connectivity connectivity) {
  const Size size = ids.size();
  const auto labels = std::make_shared<segmentation::Labels>();
  labels->size = size;
  labels->status = Status::Ok;
  labels->ids.resize(size);
  for (int y = 0; y < size.height; ++y) std::copy_n(ids.row(y), size.width, labels->ids.row(y));
  labels->count = count;
  const gpu::Planes planes = inOrder(picture);
  labels->picture = std::make_shared<Picture>(std::move(picture));
  const auto stage = graph::makeStage({std::make_shared<Executor>(1), {}});
  const auto expected = *stage->process(labels, {connectivity});

  const uint64_t most = gpu::graph::mostArcs(size.area(), count);
  DevicePairs pairs(most);
  DeviceSort order(std::max<size_t>(most, 1));
  std::vector<graph::RegionSums> sums(count);
  std::vector<graph::Region> regions(count);
  std::vector<graph::Arc> arcs(most);
  Numbers contrasts(pairs.keys.size());
  uint32_t arcCount = 0xA5A5A5A5;
  gpu::graph::buildGraph({ids, &count, planes}, connectivity,
                         {sums.data(), regions.data(), pairs.view(), contrasts.data(), order.view(),
                          arcs.data(), &arcCount, count},
                         nullptr);
  for (size_t i = 0; i < count; ++i) {
    const graph::Region &a = regions[i], &b = expected->regions[i];
    ASSERT_EQ(a.areaPx, b.areaPx) << i;
    ASSERT_EQ(a.box, b.box) << i;
    ASSERT_EQ(std::pair(a.centroidX, a.centroidY), std::pair(b.centroidX, b.centroidY)) << i;
    ASSERT_EQ(a.colour, b.colour) << i;
  }
  ASSERT_EQ(arcCount, expected->arcs.size());
  for (size_t i = 0; i < arcCount; ++i) {
    const graph::Arc &a = arcs[i], &b = expected->arcs[i];
    ASSERT_EQ(std::pair(a.a, a.b), std::pair(b.a, b.b)) << i;
    ASSERT_EQ(std::pair(a.borderPx, a.contrast), std::pair(b.borderPx, b.contrast)) << i;
  }
}

}  // namespace

void parity_buildGraph() {
  forSizesAndFills([](Size size, int fill) {
    for (const bool isGrey : {false, true})
      for (const auto& [kinds, block] : {std::pair{1u, 1}, {5u, 3}, {60u, 2}, {3u, 40}}) {
        Picture picture;
        loadScene(size, fill, 1, isGrey, picture);
        Image<uint16_t> ids(size);
        const uint32_t count = numberPatches(kinds, block, ids);
        checkGraph(std::move(picture), ids, count,
                   block == 3 ? Connectivity::Eight : Connectivity::Four);
      }
  });
}

}  // namespace rg::test

namespace rg {

TEST(Primitives, ASortKeepsTheOrderOfEqualKeys) {
  for (const uint32_t count : {0u, 1u, 33u, 2048u, 5000u})
    for (const uint32_t kinds : {1u, 3u, 0xFFFFFFFFu}) {
      test::shuffleThreads(5);
      test::DeviceSort pairs(6000);
      std::vector<std::pair<uint32_t, uint32_t>> expected;
      for (uint32_t i = 0; i < count; ++i) {
        pairs.keys[i] = test::hashOf(static_cast<int>(i), 1, 2) % kinds * (kinds < 9 ? 77777 : 1);
        pairs.values[i] = i;
        expected.emplace_back(pairs.keys[i], i);
      }
      std::sort(expected.begin(), expected.end());
      gpu::sortPairs(pairs.view(), 6000, &count, nullptr);
      for (uint32_t i = 0; i < count; ++i)
        ASSERT_EQ(std::pair(pairs.keys[i], pairs.values[i]), expected[i]) << i << " of " << count;
      test::expectNoFindings();
    }
}

}  // namespace rg
