// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/segmentation.hpp"

#include "core/base/mask_gaps.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/pixel.hpp"
#include "core/base/renewed_stage.hpp"
#include "core/segmentation/border_pixels.hpp"
#include "core/segmentation/colour_cells.hpp"
#include "core/segmentation/colour_links.hpp"
#include "core/segmentation/pixel_runs.hpp"
#include "core/segmentation/region_division.hpp"
#include "core/segmentation/scopes.hpp"

#include <algorithm>
#include <utility>

namespace rg::segmentation {
namespace {

constexpr int kMostRegions = 65535;
constexpr int64_t kDefaultAreaShare = 1200;  // Least area of a region, as a share of the frame.
constexpr int64_t kDefaultLeastArea = 32;
constexpr uint32_t kSpareShare = 8;

constexpr uint32_t leastArea(const Params& params, Size size) {
  if (params.minAreaPx > 0) return static_cast<uint32_t>(params.minAreaPx);
  return static_cast<uint32_t>(std::max(kDefaultLeastArea, size.area() / kDefaultAreaShare));
}

/// The largest cells that at least kCellsInRegion of make the smallest region.
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

struct GrowthLimits {
  int similarity = 0;
  uint32_t minAreaPx = 1;
  uint32_t maxRegions = 1;
  HueBand band{};
};

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

Result<std::shared_ptr<const Labels>> skipped(Pool<Labels>& pool, Scope scope, Size size) {
  const auto labels = pool.take();
  labels->size = size;
  labels->status = Status::Skipped;
  labels->scope = scope;
  labels->ids.resize({});
  labels->hue.resize({});
  labels->count = 0;
  return std::shared_ptr<const Labels>(labels);
}

class CpuSegmentation : public Stage {
 public:
  explicit CpuSegmentation(Context context) : context_(std::move(context)) {}

  Result<std::shared_ptr<const Labels>> process(
      std::shared_ptr<const Picture> picture,
      std::shared_ptr<const background::Foreground> foreground, const Params& params) override;
  void reset(Reset) override {}

 private:
  ImageView<const uint8_t> chooseScope(const Picture& picture,
                                       const background::Foreground* foreground, Scope scope);
  ImageView<const uint8_t> closeGaps(const Picture& picture,
                                     const background::Foreground& foreground);
  ImageView<const uint8_t> coverAreas(const background::Foreground& foreground, uint8_t around);
  ImageView<const uint8_t> decideByHue(const Picture& picture,
                                       const background::Foreground* foreground,
                                       const HueRules& rules, const HueBand& band,
                                       ImageView<const uint8_t> scope, Labels& labels);
  void divide(const Picture& picture, ImageView<const uint8_t> scope, const GrowthLimits& limits,
              Labels& labels);

  Context context_;
  Image<uint8_t> scope_, rawHues_, decided_;
  BitMask whole_;  ///< The foreground without gaps.
  GapScratch gaps_;
  ColourCells cells_;
  ColourLinks links_;
  PixelRuns cellRuns_, runs_;
  RegionDivision cellDivision_, division_;
  Image<uint16_t> cellIds_;
  BorderPixels borderPixels_;
  Pool<Labels> pool_;
};

Result<std::shared_ptr<const Labels>> CpuSegmentation::process(
    std::shared_ptr<const Picture> picture,
    std::shared_ptr<const background::Foreground> foreground, const Params& params) {
  const bool wantsForeground = params.scope != Scope::Frame;
  if (wantsForeground && !foreground)
    return Error{"scopes foreground and areas need a foreground: add bgremove upstream"};
  if (!picture || (foreground && foreground->status == Status::Skipped))
    return skipped(pool_, params.scope, foreground ? foreground->size : Size{});
  if (foreground && (wantsForeground || foreground->interest || !foreground->areas.empty()) &&
      foreground->mask.size() != picture->size())
    return Error{"the foreground was made for another frame size"};

  const auto labels = pool_.take();
  labels->size = picture->size();
  labels->status = foreground ? foreground->status : Status::Ok;
  labels->scope = params.scope;
  labels->ids.resize(labels->size);
  const uint32_t minArea = leastArea(params, labels->size);
  const auto maxRegions = static_cast<uint32_t>(std::clamp(params.maxRegions, 1, kMostRegions));

  const HueBand band = findFrameBand(*picture, *context_.cpu);
  const ImageView<const uint8_t> mask =
      decideByHue(*picture, foreground.get(), params.hue, band,
                  chooseScope(*picture, foreground.get(), params.scope), *labels);
  divide(*picture, mask, {params.similarity, minArea, maxRegions, band}, *labels);
  labels->picture = std::move(picture);
  labels->foreground = std::move(foreground);
  return std::shared_ptr<const Labels>(labels);
}

// Regions are grown from cells where they are much larger than those, and then from pixels at the
// borders only. A few more regions than wanted are left for what that changes.
void CpuSegmentation::divide(const Picture& picture, ImageView<const uint8_t> scope,
                             const GrowthLimits& limits, Labels& labels) {
  const Executor& executor = *context_.cpu;
  const int side = cellSide(limits.minAreaPx);
  cells_.build(picture, scope, side, executor);
  const int similarity = side > 1 ? cellSimilarity(limits.similarity) : limits.similarity;
  links_.build(cells_.cells(), {similarity, limits.minAreaPx > 1, limits.band}, executor);
  cellRuns_.build(links_, runLimits(labels.size, side), executor);
  if (side == 1) {
    labels.count = division_.run(cells_.cells(), cellRuns_, {limits.minAreaPx, limits.maxRegions},
                                 executor, labels.ids);
    return;
  }
  const uint32_t spare = limits.maxRegions / kSpareShare;
  cellIds_.resize(cells_.cells().size);
  cellDivision_.run(cells_.cells(), cellRuns_,
                    {limits.minAreaPx, std::min<uint32_t>(limits.maxRegions + spare, kMostRegions)},
                    executor, cellIds_);
  borderPixels_.refine(cells_, cellIds_, executor, labels.ids);
  runs_.build(labels.ids, scope, executor);
  labels.count = division_.runAgain(cellDivision_, cells_.pixels(), runs_,
                                    {limits.minAreaPx, limits.maxRegions}, executor, labels.ids);
}

/// A scope plane; without data: all pixels.
ImageView<const uint8_t> CpuSegmentation::chooseScope(const Picture& picture,
                                                      const background::Foreground* foreground,
                                                      Scope scope) {
  if (scope == Scope::Foreground) return closeGaps(picture, *foreground);
  if (scope == Scope::Areas) return coverAreas(*foreground, background::kBackgroundPixel);
  if (foreground && !foreground->areas.empty()) return coverAreas(*foreground, kInScopeApart);
  if (foreground && foreground->interest) return *foreground->interest;
  return {};
}

/// Where the foreground ends but no colour does, the region goes on: a thing as dark as the wall
/// behind it has holes in the foreground.
ImageView<const uint8_t> CpuSegmentation::closeGaps(const Picture& picture,
                                                    const background::Foreground& foreground) {
  packEqual(foreground.mask, background::kForegroundPixel, whole_);
  if (!fillUnedged(picture.green(), kMostGapStep, mostGapPx(picture.size()), *context_.cpu, gaps_,
                   whole_))
    return foreground.mask;
  scope_.resize(picture.size());
  scope_.fill(background::kBackgroundPixel);
  paint(whole_, background::kForegroundPixel, scope_);
  if (foreground.interest) keepInside(*foreground.interest, scope_);
  return scope_;
}

ImageView<const uint8_t> CpuSegmentation::coverAreas(const background::Foreground& foreground,
                                                     uint8_t around) {
  scope_.resize(foreground.mask.size());
  segmentation::coverAreas(foreground.areas, around, scope_);
  if (foreground.interest) keepInside(*foreground.interest, scope_);
  return scope_;
}

ImageView<const uint8_t> CpuSegmentation::decideByHue(const Picture& picture,
                                                      const background::Foreground* foreground,
                                                      const HueRules& rules, const HueBand& band,
                                                      ImageView<const uint8_t> scope,
                                                      Labels& labels) {
  if (!rules.decide()) {
    labels.hue.resize({});
    return scope;
  }
  // Label 0 means background from here on.
  if (labels.scope == Scope::Frame) labels.scope = Scope::Foreground;
  labels.hue.resize(labels.size);
  classifyHues(picture, rules, band, scope, *context_.cpu, rawHues_, labels.hue);
  decided_.resize(labels.size);
  const bool hasEvidence =
      rules.objectBand.count == 0 && foreground && foreground->mask.size() == labels.size;
  scopeByHue(labels.hue, hasEvidence ? foreground->mask.view() : ImageView<const uint8_t>{}, scope,
             decided_);
  return decided_;
}

}  // namespace

std::unique_ptr<Stage> makeStage(Context context) {
  return std::make_unique<RenewedStage<Stage, CpuSegmentation>>(std::move(context));
}

}  // namespace rg::segmentation
