// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/cascade.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace rg::detection {
namespace {

Error wrong(const char* what, size_t index, const char* why) {
  return {std::string(what) + " " + std::to_string(index) + " " + why};
}

bool fits(const Box& box, bool isTilted, Size window) {
  if (box.x < 0 || box.y < 0 || box.isEmpty()) return false;
  if (box.x > window.width || box.width > window.width || box.y > window.height ||
      box.height > window.height)
    return false;
  if (!isTilted) return box.right() <= window.width && box.bottom() <= window.height;
  return box.x >= box.height && box.right() <= window.width &&
         box.y + box.width + box.height <= window.height;
}

Result<bool> checkFeature(const Feature& feature, size_t index, Size window) {
  if (feature.rects[0].weight == 0) return wrong("feature", index, "has no rectangle");
  for (const Feature::Rect& rect : feature.rects) {
    if (!std::isfinite(rect.weight) || std::abs(rect.weight) > kMostWeight)
      return wrong("feature", index, "has a weight that can't be");
    if (rect.weight != 0 && !fits(rect.box, feature.isTilted, window))
      return wrong("feature", index, "leaves the window");
  }
  return true;
}

/// To a node behind this one, so that every way ends, or to a leaf.
bool leadsOn(int32_t next, int32_t node, int32_t nodes) {
  return next >= 0 ? next > node && next < nodes : next >= -1 - nodes;
}

Result<bool> checkTree(const Cascade& cascade, size_t index) {
  const Tree& tree = cascade.trees[index];
  const Tree* before = index > 0 ? &cascade.trees[index - 1] : nullptr;
  if (tree.firstNode != (before ? before->firstNode + before->nodes : 0) ||
      tree.firstLeaf != (before ? before->firstLeaf + before->nodes + 1 : 0))
    return wrong("tree", index, "does not begin where the one before ends");
  if (tree.nodes < 1 || tree.nodes > kMostTreeNodes)
    return wrong("tree", index, "has no nodes or more than 64");
  if (static_cast<size_t>(tree.firstNode + tree.nodes) > cascade.branches.size() ||
      static_cast<size_t>(tree.firstLeaf + tree.nodes) >= cascade.leaves.size())
    return wrong("tree", index, "has too few nodes or leaves");
  for (int32_t n = 0; n < tree.nodes; ++n) {
    const auto at = static_cast<size_t>(tree.firstNode + n);
    const Branch& branch = cascade.branches[at];
    const int32_t feature = cascade.nodeFeatures[at];
    if (!std::isfinite(branch.threshold)) return wrong("tree", index, "has no finite threshold");
    if (feature < 0 || static_cast<size_t>(feature) >= cascade.features.size())
      return wrong("tree", index, "asks for a feature that is not there");
    if (!leadsOn(branch.less, n, tree.nodes) || !leadsOn(branch.other, n, tree.nodes))
      return wrong("tree", index, "leads to a node or leaf that is not there, or back");
  }
  return true;
}

/// Tilted rectangles have a row for each pixel of their sides.
size_t rowsOf(const Cascade& cascade) {
  size_t rows = 0;
  for (const int32_t index : cascade.nodeFeatures) {
    const Feature& feature = cascade.features[static_cast<size_t>(index)];
    for (const Feature::Rect& rect : feature.rects)
      rows += feature.isTilted ? static_cast<size_t>(rect.box.width + rect.box.height) : 1;
  }
  return rows;
}

Result<bool> checkStages(const Cascade& cascade) {
  size_t trees = 0;
  for (size_t i = 0; i < cascade.stages.size(); ++i) {
    const CascadeStage& stage = cascade.stages[i];
    if (stage.trees < 1 || static_cast<size_t>(stage.firstTree) != trees)
      return wrong("stage", i, "has no trees");
    if (!std::isfinite(stage.threshold)) return wrong("stage", i, "has no finite threshold");
    trees += static_cast<size_t>(stage.trees);
    if (trees > cascade.trees.size()) return wrong("stage", i, "has too few trees");
  }
  if (trees == 0 || trees != cascade.trees.size()) return Error{"there are no stages"};
  return true;
}

}  // namespace

Result<bool> check(const Cascade& cascade) {
  const Size window = cascade.window;
  if (window.width < 3 || window.height < 3) return Error{"the window is smaller than 3x3"};
  if (window.width > kMostTrainedPx || window.height > kMostTrainedPx ||
      window.area() > kMostTrainedPx)
    return Error{"the window has more than 8192 pixels"};
  if (cascade.branches.size() > kMostNodes || cascade.features.size() > kMostNodes)
    return Error{"there are more than 20000 nodes or features"};
  if (cascade.stages.size() > kMostStages) return Error{"there are more than 1000 stages"};
  if (cascade.branches.size() != cascade.nodeFeatures.size())
    return Error{"nodes and features differ in number"};
  if (!std::all_of(cascade.leaves.begin(), cascade.leaves.end(),
                   [](float leaf) { return std::isfinite(leaf); }))
    return Error{"a leaf is not finite"};
  for (size_t i = 0; i < cascade.features.size(); ++i)
    if (auto checked = checkFeature(cascade.features[i], i, window); !checked) return checked;
  for (size_t i = 0; i < cascade.trees.size(); ++i)
    if (auto checked = checkTree(cascade, i); !checked) return checked;
  if (rowsOf(cascade) > kMostRows) return Error{"tilted features have more than 200000 rows"};
  return checkStages(cascade);
}

Box tiltedRow(const Box& box, int row) {
  // Left edge: down along the height, then back along the width; right edge likewise.
  const int left = row < box.height ? box.x - 1 - row : box.x - 2 * box.height + row;
  const int right = row < box.width ? box.x + row : box.x + 2 * box.width - 1 - row;
  return {left, box.y + row, right - left, 1};
}

}  // namespace rg::detection
