// SPDX-License-Identifier: LGPL-2.1-or-later
// Cascades made by hand for tests.
#pragma once

#include "core/detection/cascade.hpp"
#include "tests/core/fills.hpp"

#include <cstdlib>

namespace rg::test {

/// Two stages of one stump each, in windows of 8x10: the left half must be brighter than the right
/// one, by much for the second stage.
inline detection::Cascade halvesCascade() {
  detection::Cascade cascade;
  cascade.window = {8, 10};
  detection::Feature halves;
  halves.rects[0] = {{0, 0, 8, 10}, -1};
  halves.rects[1] = {{0, 0, 4, 10}, 2};
  cascade.features = {halves};
  cascade.nodeFeatures = {0, 0};
  cascade.branches = {{.1F, -1, -2}, {.5F, -1, -2}};
  cascade.leaves = {-1, 1, -1, 1};
  cascade.trees = {{0, 1, 0}, {1, 1, 2}};
  cascade.stages = {{0, 1, 0}, {1, 1, 0}};
  return cascade;
}

/// Numbers that depend on nothing but a seed.
class Lots {
 public:
  explicit Lots(uint32_t seed) : seed_(seed) {}
  /// least … most.
  int from(int least, int most) {
    const auto count = static_cast<uint32_t>(most - least + 1);
    return least + static_cast<int>(hashOf(++drawn_, 0, seed_) % count);
  }

 private:
  uint32_t seed_;
  int drawn_ = 0;
};

inline detection::Feature randomFeature(Lots& lots, Size window) {
  detection::Feature feature;
  feature.isTilted = lots.from(0, 2) == 0;
  Box box;
  do {
    box = {lots.from(0, window.width - 2), lots.from(0, window.height - 2), lots.from(1, 6),
           lots.from(1, 6)};
  } while (feature.isTilted ? box.x < box.height || box.right() > window.width ||
                                  box.y + box.width + box.height > window.height
                            : box.right() > window.width || box.bottom() > window.height);
  feature.rects[0] = {box, -1};
  const Box half{box.x, box.y, (box.width + 1) / 2, box.height};
  feature.rects[1] = {half, static_cast<float>(box.width) / static_cast<float>(half.width)};
  if (lots.from(0, 3) == 0) feature.rects[2] = {{half.x, half.y, 1, 1}, 2};
  return feature;
}

/// Six stages of up to five trees of up to three nodes, each of which some half of the windows of
/// noise pass.
inline detection::Cascade randomCascade(uint32_t seed) {
  detection::Cascade cascade;
  cascade.window = {12, 15};
  Lots lots(seed);
  for (int i = 0; i < 40; ++i) cascade.features.push_back(randomFeature(lots, cascade.window));
  for (int s = 0; s < 6; ++s) {
    const auto first = static_cast<int32_t>(cascade.trees.size());
    const int32_t trees = lots.from(1, 5);
    cascade.stages.push_back({first, trees, static_cast<float>(lots.from(-40, 0)) / 100});
    for (int32_t t = 0; t < trees; ++t) {
      const int32_t nodes = lots.from(1, 3);
      cascade.trees.push_back({static_cast<int32_t>(cascade.branches.size()), nodes,
                               static_cast<int32_t>(cascade.leaves.size())});
      for (int32_t n = 0; n < nodes; ++n) {
        const bool goesOn = n + 1 < nodes;
        cascade.branches.push_back({static_cast<float>(lots.from(-9, 9)) / 1000,
                                    goesOn ? n + 1 : -1 - lots.from(0, nodes),
                                    -1 - lots.from(0, nodes)});
        cascade.nodeFeatures.push_back(lots.from(0, 39));
      }
      for (int32_t k = 0; k <= nodes; ++k)
        cascade.leaves.push_back(static_cast<float>(lots.from(-100, 100)) / 99);
    }
  }
  return cascade;
}

}  // namespace rg::test
