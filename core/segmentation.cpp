// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation.hpp"

#include "core/absorption.hpp"
#include "core/colour_links.hpp"
#include "core/pixel.hpp"
#include "core/pixel_runs.hpp"
#include "core/pool.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace rg {
namespace {

constexpr int kMostRegions = 65535;
constexpr int64_t kDefaultAreaShare = 1200;  // Least area of a region, as a share of the frame.
constexpr int64_t kDefaultLeastArea = 32;

constexpr uint32_t leastArea(const SegmentationParams& params, Size size) {
  if (params.minAreaPx > 0) return static_cast<uint32_t>(params.minAreaPx);
  return static_cast<uint32_t>(std::max(kDefaultLeastArea, size.area() / kDefaultAreaShare));
}

/// Components above a 32nd of the frame are cut into tiles of about a 64th, of whole 8x8 cells.
RunLimits runLimits(Size size) {
  constexpr int kTilesInFrame = 64, kTilesInRegion = 2, kCell = 8, kLeastTile = 32;
  const auto side = static_cast<int>(integerSqrt(static_cast<uint64_t>(size.area()))) /
                    static_cast<int>(integerSqrt(kTilesInFrame));
  const int tile = std::max(side / kCell * kCell, kLeastTile);
  const int64_t largest =
      kTilesInRegion * std::max<int64_t>(size.area() / kTilesInFrame, int64_t{tile} * tile);
  return {static_cast<uint32_t>(largest), tile};
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

/// Borders as they come, pairs that come again soon joined.
class BorderList {
 public:
  void clear() {
    borders_.clear();
    recent_.fill(0);
  }
  void add(uint32_t a, uint32_t b, uint32_t borderPx) {
    if (a > b) std::swap(a, b);
    uint32_t& at = recent_[(a * 0x9E3779B1u ^ b * 0x85EBCA77u) >> (32 - kRecentBits)];
    if (at < borders_.size() && borders_[at].a == a && borders_[at].b == b) {
      borders_[at].borderPx += borderPx;
      return;
    }
    at = static_cast<uint32_t>(borders_.size());
    borders_.push_back({a, b, borderPx});
  }
  [[nodiscard]] const std::vector<AbsorbedBorder>& borders() const { return borders_; }

 private:
  static constexpr int kRecentBits = 11;
  std::vector<AbsorbedBorder> borders_;
  std::array<uint32_t, 1 << kRecentBits> recent_{};  ///< Where pairs of a hash are.
};

class CpuSegmentation : public SegmentationStage {
 public:
  explicit CpuSegmentation(Context context) : context_(std::move(context)) {}

  Result<std::shared_ptr<const Labels>> process(std::shared_ptr<const Picture> picture,
                                                std::shared_ptr<const Foreground> foreground,
                                                const SegmentationParams& params) override;
  void reset(Reset) override {}

 private:
  ImageView<const uint8_t> chooseScope(const Foreground* foreground, Scope scope);
  void coverAreas(const Foreground& foreground);
  ImageView<const uint8_t> decideByHue(const Picture& picture, const Foreground* foreground,
                                       const HueRules& rules, const HueBand& band,
                                       ImageView<const uint8_t> scope, Labels& labels);
  void collectRegions(const Picture& picture);
  void addRow(const Picture& picture, int y);
  void collectBorders();
  void collectBorders(int y, BorderList& borders) const;
  void numberRegions(uint32_t maxRegions, Labels& labels);

  Context context_;
  Image<uint8_t> scope_, rawHues_, decided_;
  ColourLinks links_;
  PixelRuns runs_;
  struct Sums {
    uint32_t red = 0, green = 0, blue = 0;  // Of a tile's pixels: 255 · 2048² < 2^32.
    uint32_t areaPx = 0;
  };
  std::vector<Sums> sums_;  ///< Of each part, at its first run.
  std::vector<BorderList> bands_;
  Absorption absorption_;
  std::vector<uint32_t> numbers_;
  std::vector<uint64_t> order_;
  Pool<Labels> pool_;
};

Result<std::shared_ptr<const Labels>> CpuSegmentation::process(
    std::shared_ptr<const Picture> picture, std::shared_ptr<const Foreground> foreground,
    const SegmentationParams& params) {
  const bool wantsForeground = params.scope != Scope::Frame;
  if (wantsForeground && !foreground)
    return Error{"scopes foreground and areas need a foreground: add bgremove upstream"};
  if (!picture || (foreground && foreground->status == Status::Skipped))
    return skipped(pool_, params.scope, foreground ? foreground->size : Size{});
  if (foreground && (wantsForeground || foreground->interest) &&
      foreground->mask.size() != picture->size())
    return Error{"the foreground was made for another frame size"};

  const auto labels = pool_.take();
  labels->size = picture->size();
  labels->status = foreground ? foreground->status : Status::Ok;
  labels->scope = params.scope;
  labels->ids.resize(labels->size);
  const uint32_t minArea = leastArea(params, labels->size);
  const auto maxRegions = static_cast<uint32_t>(std::clamp(params.maxRegions, 1, kMostRegions));

  const HueBand band = findFrameBand(*picture);
  const ImageView<const uint8_t> mask =
      decideByHue(*picture, foreground.get(), params.hue, band,
                  chooseScope(foreground.get(), params.scope), *labels);
  links_.build(*picture, mask, {params.similarity, minArea > 1, band}, *context_.cpu);
  runs_.build(links_, runLimits(labels->size), *context_.cpu);
  collectRegions(*picture);
  collectBorders();
  absorption_.run({minArea, maxRegions});
  numberRegions(maxRegions, *labels);
  labels->picture = std::move(picture);
  labels->foreground = std::move(foreground);
  return std::shared_ptr<const Labels>(labels);
}

// Sums by part first: bands have those of their own.
/// The pixels that may get a region are kForegroundPixel; without data: all.
ImageView<const uint8_t> CpuSegmentation::chooseScope(const Foreground* foreground, Scope scope) {
  switch (scope) {
    case Scope::Foreground:
      return foreground->mask;
    case Scope::Areas:
      coverAreas(*foreground);
      return scope_;
    case Scope::Frame:
      break;
  }
  if (foreground && foreground->interest) return *foreground->interest;
  return {};
}

void CpuSegmentation::coverAreas(const Foreground& foreground) {
  const Size size = foreground.mask.size();
  scope_.resize(size);
  scope_.fill(kBackgroundPixel);
  for (const Box& area : foreground.areas) {
    const Box box = intersect(inflate(area, kAreaMargin), boundsOf(size));
    for (int y = box.y; y < box.bottom(); ++y)
      std::fill_n(scope_.row(y) + box.x, box.width, kForegroundPixel);
  }
  if (!foreground.interest) return;
  for (int y = 0; y < size.height; ++y) {
    const uint8_t* isInside = foreground.interest->row(y);
    uint8_t* row = scope_.row(y);
    for (int x = 0; x < size.width; ++x) row[x] = row[x] & isInside[x];
  }
}

ImageView<const uint8_t> CpuSegmentation::decideByHue(const Picture& picture,
                                                      const Foreground* foreground,
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
  for (int y = 0; y < labels.size.height; ++y) {
    const uint8_t* hue = labels.hue.row(y);
    const uint8_t* evidence = hasEvidence ? foreground->mask.row(y) : nullptr;
    uint8_t* out = decided_.row(y);
    for (int x = 0; x < labels.size.width; ++x) {
      const bool isIn = (!scope.data || scope.row(y)[x] == kForegroundPixel) &&
                        (hue[x] == kObjectHue ||
                         (hue[x] == kNoHue && evidence && evidence[x] == kForegroundPixel));
      out[x] = isIn ? kForegroundPixel : kBackgroundPixel;
    }
  }
  return decided_;
}

void CpuSegmentation::collectRegions(const Picture& picture) {
  sums_.resize(runs_.count());
  context_.cpu->forEach(runs_.bandCount(), [&](int band) {
    const Span rows = runs_.bandRows(band);
    std::fill(sums_.begin() + runs_.rowStart(rows.first), sums_.begin() + runs_.rowStart(rows.last),
              Sums{});
    for (int y = rows.first; y < rows.last; ++y) addRow(picture, y);
  });
  std::vector<AbsorbedRegion>& regions = absorption_.regions();
  regions.assign(runs_.componentCount(), {});
  for (uint32_t i = 0; i < runs_.count(); ++i) {
    if (runs_.part(i) != i) continue;
    AbsorbedRegion& region = regions[runs_.component(i)];
    region.red += sums_[i].red;
    region.green += sums_[i].green;
    region.blue += sums_[i].blue;
    region.areaPx += sums_[i].areaPx;
  }
}

void CpuSegmentation::addRow(const Picture& picture, int y) {
  const uint8_t *red = picture.red().row(y), *green = picture.green().row(y),
                *blue = picture.blue().row(y);
  for (uint32_t i = runs_.rowStart(y); i < runs_.rowStart(y + 1); ++i) {
    const PixelRun& run = runs_.run(i);
    Sums sums = sums_[runs_.part(i)];
    for (int x = run.first; x < run.last; ++x) {
      sums.red += red[x];
      sums.green += green[x];
      sums.blue += blue[x];
    }
    sums.areaPx += static_cast<uint32_t>(run.last - run.first);
    sums_[runs_.part(i)] = sums;
  }
}

void CpuSegmentation::collectBorders() {
  bands_.resize(static_cast<size_t>(runs_.bandCount()));
  context_.cpu->forEach(runs_.bandCount(), [&](int band) {
    BorderList& borders = bands_[static_cast<size_t>(band)];
    borders.clear();
    const Span rows = runs_.bandRows(band);
    for (int y = rows.first; y < rows.last; ++y) collectBorders(y, borders);
  });
  std::vector<AbsorbedBorder>& all = absorption_.borders();
  all.clear();
  for (const BorderList& band : bands_)
    all.insert(all.end(), band.borders().begin(), band.borders().end());
}

void CpuSegmentation::collectBorders(int y, BorderList& borders) const {
  for (uint32_t j = runs_.rowStart(y) + 1; j < runs_.rowStart(y + 1); ++j) {
    const uint32_t a = runs_.component(j - 1), b = runs_.component(j);
    if (a != b && runs_.run(j - 1).last == runs_.run(j).first) borders.add(a, b, 1);
  }
  if (y == 0) return;
  forOverlaps(runs_, y, [&](uint32_t i, uint32_t j, int first, int last) {
    const uint32_t a = runs_.component(i), b = runs_.component(j);
    if (a != b) borders.add(a, b, static_cast<uint32_t>(last - first));
  });
}

// Numbers follow the raster order of first pixels, as the components do. Where parts that touch
// nothing are still more than allowed, the smallest go to label 0.
void CpuSegmentation::numberRegions(uint32_t maxRegions, Labels& labels) {
  constexpr uint32_t kDropped = 0, kOpen = ~uint32_t{0};
  numbers_.assign(runs_.componentCount(), kOpen);
  const std::vector<AbsorbedRegion>& left = absorption_.left();
  if (left.size() > maxRegions) {
    order_.clear();
    for (const AbsorbedRegion& region : left)
      order_.push_back(uint64_t{region.areaPx} << 32 | region.representative);
    const size_t surplus = left.size() - maxRegions;
    std::nth_element(order_.begin(), order_.begin() + static_cast<ptrdiff_t>(surplus),
                     order_.end());
    for (size_t i = 0; i < surplus; ++i) numbers_[static_cast<uint32_t>(order_[i])] = kDropped;
  }
  labels.count = 0;
  for (uint32_t i = 0; i < numbers_.size(); ++i) {
    uint32_t& number = numbers_[absorption_.representative(i)];
    if (number == kOpen) number = ++labels.count;
    numbers_[i] = number;
  }
  context_.cpu->forRows(labels.size.height, [&](int firstRow, int lastRow) {
    for (int y = firstRow; y < lastRow; ++y) {
      uint16_t* ids = labels.ids.row(y);
      int done = 0;
      for (uint32_t i = runs_.rowStart(y); i < runs_.rowStart(y + 1); ++i) {
        const PixelRun& run = runs_.run(i);
        const auto id = static_cast<uint16_t>(numbers_[runs_.component(i)]);
        std::fill(ids + done, ids + run.first, kNoRegion);
        std::fill(ids + run.first, ids + run.last, id);
        done = run.last;
      }
      std::fill(ids + done, ids + labels.size.width, kNoRegion);
    }
  });
}

}  // namespace

std::unique_ptr<SegmentationStage> makeSegmentationStage(Context context) {
  return std::make_unique<CpuSegmentation>(std::move(context));
}

}  // namespace rg
