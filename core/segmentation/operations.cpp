// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/operations.hpp"

#include "core/background/background.hpp"
#include "core/base/pixel.hpp"
#include "core/base/row_spans.hpp"
#include "core/segmentation/scopes.hpp"
#include "core/segmentation/segmentation.hpp"

#include <algorithm>
#include <utility>

namespace rg::segmentation {
namespace {

constexpr uint32_t kSpareShare = 8;

int cellSide(uint32_t minAreaPx) {
  constexpr uint32_t kCellsInRegion = 16;
  int side = 1;
  while (side < ColourCells::kLargestSide &&
         static_cast<uint32_t>(4 * side * side) * kCellsInRegion <= minAreaPx)
    side *= 2;
  return side;
}

/// Cells lie farther apart than pixels: a shading steps by more between them.
constexpr int cellSimilarity(int similarity) {
  return similarity + similarity / 2;
}

/// Components above a 32nd of the frame are cut into tiles of about a 64th, of whole 8x8 cells. In
/// cells of a side.
RunLimits runLimits(Size size, int sidePx) {
  constexpr int kTilesInFrame = 64, kTilesInRegion = 2, kCell = 8, kLeastTile = 32;
  const auto side = static_cast<int>(integerSqrt(static_cast<uint64_t>(size.area()))) /
                    static_cast<int>(integerSqrt(kTilesInFrame));
  const int tile = std::max(side / kCell * kCell, kLeastTile);
  const int64_t largest =
      kTilesInRegion * std::max<int64_t>(size.area() / kTilesInFrame, int64_t{tile} * tile);
  return {static_cast<uint32_t>(largest / (sidePx * sidePx)), tile / sidePx};
}

}  // namespace

DivisionPlan planOf(Size frame, const GrowthLimits& limits) {
  const int side = cellSide(limits.minAreaPx);
  const uint32_t spare = limits.maxRegions / kSpareShare;
  return {side,
          side > 1 ? cellSimilarity(limits.similarity) : limits.similarity,
          runLimits(frame, side),
          {limits.minAreaPx, std::min<uint32_t>(limits.maxRegions + spare, kMostRegions)},
          {limits.minAreaPx, limits.maxRegions}};
}

/// Where the foreground ends but no colour does, the region goes on: a thing as dark as the wall
/// behind it has holes in the foreground.
const Image<uint8_t>& Operations::closeGaps(const Picture& picture, const Image<uint8_t>& mask,
                                            Image<uint8_t>& scope) {
  packEqual(mask, background::kForegroundPixel, whole_);
  if (!fillUnedged(picture.green(), kMostGapStep, mostGapPx(picture.size()), executor_, gaps_,
                   whole_))
    return mask;
  scope.resize(picture.size());
  scope.fill(background::kBackgroundPixel);
  paint(whole_, background::kForegroundPixel, scope);
  return scope;
}

void Operations::coverAreas(std::span<const Box> areas, uint8_t around, Image<uint8_t>& scope) {
  segmentation::coverAreas(areas, around, scope);
}

void Operations::keepInside(const Image<uint8_t>& interest, Image<uint8_t>& scope) {
  rg::keepInside(interest, scope);
}

void Operations::classifyHues(const Picture& picture, const HueRules& rules, Scoped scope,
                              Image<uint8_t>& classes) {
  segmentation::classifyHues(picture, rules, findFrameBand(picture, executor_), viewOf(scope),
                             executor_, rawHues_, classes);
}

void Operations::scopeByHue(const Image<uint8_t>& hue, Scoped evidence, Scoped scope,
                            Image<uint8_t>& out) {
  segmentation::scopeByHue(hue, viewOf(evidence), viewOf(scope), out);
}

// Regions are grown from cells where they are much larger than those, and then from pixels at the
// borders only.
uint32_t Operations::divide(const Picture& picture, Scoped scope, const GrowthLimits& limits,
                            Image<uint16_t>& ids) {
  const DivisionPlan plan = planOf(picture.size(), limits);
  cells_.build(picture, viewOf(scope), plan.sidePx, executor_);
  links_.build(
      cells_.cells(),
      {plan.similarity, limits.minAreaPx > 1, findFrameBand(picture, executor_), limits.space},
      executor_);
  cellRuns_.build(links_, plan.runs, executor_);
  if (plan.sidePx == 1)
    return division_.run(cells_.cells(), cellRuns_, plan.pixels, executor_, ids);
  cellIds_.resize(cells_.cells().size);
  cellDivision_.run(cells_.cells(), cellRuns_, plan.cells, executor_, cellIds_);
  borderPixels_.refine(cells_, cellIds_, executor_, ids);
  runs_.build(std::as_const(ids).view(), viewOf(scope), executor_);
  return division_.runAgain(cellDivision_, cells_.pixels(), runs_, plan.pixels, executor_, ids);
}

}  // namespace rg::segmentation
