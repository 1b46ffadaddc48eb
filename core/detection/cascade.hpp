// SPDX-License-Identifier: LGPL-2.1-or-later
// A boosted cascade of Haar features (Viola and Jones), as OpenCV's files describe it.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/result.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace rg::detection {

inline constexpr int kMostRects = 3;

/// Sums of pixels in up to three rectangles of the window, each times its weight. A tilted
/// rectangle begins above (x, y), from where its width goes down to the right and its height down
/// to the left, in diagonal steps (tiltedRow()).
struct Feature {
  struct Rect {
    Box box;
    float weight = 0;
  };
  std::array<Rect, kMostRects> rects;  ///< Those behind the last have weight 0.
  bool isTilted = false;
};

/// Where a tree goes on: at a node of its own (0 or above) or at its leaf number −1 − next.
struct Branch {
  float threshold = 0;  ///< Of the feature's value by the deviation of the window's pixels.
  int32_t less = -1;    ///< Below the threshold.
  int32_t other = -2;   ///< Else.
};

/// Nodes and leaves stand in the cascade's lists, in the order of the trees. One leaf more than
/// nodes. The root is node 0, and a node comes before those that it leads to.
struct Tree {
  int32_t firstNode = 0;
  int32_t nodes = 1;
  int32_t firstLeaf = 0;
};

/// Passed where the sum of the trees' leaves is not below the threshold.
struct CascadeStage {
  int32_t firstTree = 0;
  int32_t trees = 0;
  float threshold = 0;
};

/// A window of this size is an object where it passes all stages.
struct Cascade {
  Size window;
  std::vector<Feature> features;
  std::vector<int32_t> nodeFeatures;  ///< For each node of each tree.
  std::vector<Branch> branches;       ///< Parallel to them.
  std::vector<float> leaves;
  std::vector<Tree> trees;
  std::vector<CascadeStage> stages;
};

/// OpenCV takes this from a stage's threshold, as its training did not know the last digits.
inline constexpr float kThresholdSlack = 1e-5F;

/// Bounds of what is accepted, far above what any known cascade has.
inline constexpr int64_t kMostTrainedPx = 8192;  ///< So that a window's sum is below 2^21.
inline constexpr int kMostTreeNodes = 64;
inline constexpr size_t kMostNodes = 20'000;
inline constexpr size_t kMostStages = 1000;
inline constexpr size_t kMostRows = 200'000;  ///< Of rectangles, an upright one has one.
inline constexpr float kMostWeight = 1024;

/// Whether everything points to something that is there, rectangles lie inside of the window, and
/// numbers are finite. Whoever reads a file asks this; the detector relies on it.
[[nodiscard]] Result<bool> check(const Cascade& cascade);

/// The pixels of a tilted rectangle in one of its width + height rows, counted from box.y: what
/// lies above the two diagonals that meet at the lowest corner, less what lies above those of the
/// corners at the sides.
[[nodiscard]] Box tiltedRow(const Box& box, int row);

}  // namespace rg::detection
