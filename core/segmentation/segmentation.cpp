// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/segmentation.hpp"

#include "core/base/memory/operations_source.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/renewed_stage.hpp"
#include "core/segmentation/operations.hpp"

#include <algorithm>
#include <utility>

namespace rg::segmentation {
namespace {

constexpr int64_t kDefaultAreaShare = 1200;  // Least area of a region, as a share of the frame.
constexpr int64_t kDefaultLeastArea = 32;

constexpr uint32_t leastArea(const Params& params, Size size) {
  if (params.minAreaPx > 0) return static_cast<uint32_t>(params.minAreaPx);
  return static_cast<uint32_t>(std::max(kDefaultLeastArea, size.area() / kDefaultAreaShare));
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

class SegmentationStage final : public Stage {
 public:
  explicit SegmentationStage(const Context& context)
      : operations_(makeOperations<Operations>(context)) {}

  Result<std::shared_ptr<const Labels>> process(
      std::shared_ptr<const Picture> picture,
      std::shared_ptr<const background::Foreground> foreground, const Params& params) override;
  void reset(Reset) override {}

 private:
  Scoped chooseScope(const Picture& picture, const background::Foreground* foreground, Scope scope);
  Scoped closeGaps(const Picture& picture, const background::Foreground& foreground);
  Scoped coverAreas(const background::Foreground& foreground, uint8_t around);
  Scoped keepInside(const background::Foreground& foreground);
  Scoped decideByHue(const Picture& picture, const background::Foreground* foreground,
                     const HueRules& rules, Scoped scope, Labels& labels);

  std::unique_ptr<Operations> operations_;
  Image<uint8_t> scope_, decided_;
  Pool<Labels> pool_;
};

Result<std::shared_ptr<const Labels>> SegmentationStage::process(
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
  labels->ids.writeOnHost();  // Readers may have had copies of what they were.
  const auto maxRegions = static_cast<uint32_t>(std::clamp(params.maxRegions, 1, kMostRegions));

  const Scoped scope = decideByHue(*picture, foreground.get(), params.hue,
                                   chooseScope(*picture, foreground.get(), params.scope), *labels);
  labels->count = operations_->divide(
      *picture, scope,
      {params.similarity, leastArea(params, labels->size), maxRegions, params.space}, labels->ids);
  operations_->publish(labels->ids, labels->hue);
  labels->picture = std::move(picture);
  labels->foreground = std::move(foreground);
  return std::shared_ptr<const Labels>(labels);
}

Scoped SegmentationStage::chooseScope(const Picture& picture,
                                      const background::Foreground* foreground, Scope scope) {
  if (scope == Scope::Foreground) return closeGaps(picture, *foreground);
  if (scope == Scope::Areas) return coverAreas(*foreground, background::kBackgroundPixel);
  if (foreground && !foreground->areas.empty()) return coverAreas(*foreground, kInScopeApart);
  if (foreground && foreground->interest) return foreground->interest.get();
  return nullptr;
}

Scoped SegmentationStage::closeGaps(const Picture& picture,
                                    const background::Foreground& foreground) {
  const Scoped closed = &operations_->closeGaps(picture, foreground.mask, scope_);
  return closed == &scope_ ? keepInside(foreground) : closed;
}

Scoped SegmentationStage::coverAreas(const background::Foreground& foreground, uint8_t around) {
  scope_.resize(foreground.mask.size());
  operations_->coverAreas(foreground.areas, around, scope_);
  return keepInside(foreground);
}

Scoped SegmentationStage::keepInside(const background::Foreground& foreground) {
  if (foreground.interest) operations_->keepInside(*foreground.interest, scope_);
  return &scope_;
}

Scoped SegmentationStage::decideByHue(const Picture& picture,
                                      const background::Foreground* foreground,
                                      const HueRules& rules, Scoped scope, Labels& labels) {
  if (!rules.decide()) {
    labels.hue.resize({});
    return scope;
  }
  // Label 0 means background from here on.
  if (labels.scope == Scope::Frame) labels.scope = Scope::Foreground;
  labels.hue.resize(labels.size);
  operations_->classifyHues(picture, rules, scope, labels.hue);
  decided_.resize(labels.size);
  const bool hasEvidence =
      rules.objectBand.count == 0 && foreground && foreground->mask.size() == labels.size;
  operations_->scopeByHue(labels.hue, hasEvidence ? &foreground->mask : nullptr, scope, decided_);
  return &decided_;
}

}  // namespace

std::unique_ptr<Stage> makeStage(Context context) {
  return std::make_unique<RenewedStage<Stage, SegmentationStage>>(std::move(context));
}

}  // namespace rg::segmentation
