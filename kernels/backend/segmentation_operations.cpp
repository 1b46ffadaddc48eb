// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/segmentation.hpp"
#include "kernels/backend/dispatcher.hpp"
#include "kernels/bit_mask.hpp"
#include "kernels/border_pixels.hpp"
#include "kernels/cell_groups.hpp"
#include "kernels/colour_cells.hpp"
#include "kernels/hues.hpp"
#include "kernels/mask_gaps.hpp"
#include "kernels/primitives.hpp"
#include "kernels/region_division.hpp"
#include "kernels/scopes.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rg::gpu::segmentation {
namespace {

using rg::segmentation::AbsorbedBorder;
using rg::segmentation::AbsorbedRegion;
using rg::segmentation::DivisionPlan;
using rg::segmentation::GrowthLimits;
using rg::segmentation::HueBand;
using rg::segmentation::HueRules;
using rg::segmentation::MeanColour;
using rg::segmentation::Scoped;
using Cpu = rg::segmentation::Operations;

/// What is grown from: pixels, or cells of them.
struct GrownCells {
  PlaneTargets colours;
  ImageView<uint8_t> weights, ranges;  ///< None of pixels.
  ImageView<const uint8_t> scope;
  int sidePx = 1;
};

class GpuOperations final : public Cpu, private Dispatcher {
 public:
  GpuOperations(GpuDevice& device, const Executor& executor) : Cpu(executor), Dispatcher(device) {}

  const Image<uint8_t>& closeGaps(const Picture& picture, const Image<uint8_t>& mask,
                                  Image<uint8_t>& scope) override {
    const Image<uint8_t>* closed = &scope;
    run(
        [&] {
          scope.resize(picture.size());
          closeGapsOnDevice(picture, mask, scope);
        },
        [&] { closed = &Cpu::closeGaps(picture, mask, scope); }, Reads{mask}, Writes{scope});
    return *closed;
  }
  void coverAreas(std::span<const Box> areas, uint8_t around, Image<uint8_t>& scope) override {
    run([&] { coverAreasOnDevice(areas, around, scope); },
        [&] { Cpu::coverAreas(areas, around, scope); }, Writes{scope});
  }
  void keepInside(const Image<uint8_t>& interest, Image<uint8_t>& scope) override {
    run(
        [&] {
          const ImageView<const uint8_t> inside = interest.readOn(device());
          rg::gpu::keepInside(inside, scope.changeOn(device()), stream());
        },
        [&] { Cpu::keepInside(interest, scope); }, Reads{interest}, Changes{scope});
  }
  void classifyHues(const Picture& picture, const HueRules& rules, Scoped scope,
                    Image<uint8_t>& classes) override {
    run([&] { classifyHuesOnDevice(picture, rules, scope, classes); },
        [&] { Cpu::classifyHues(picture, rules, scope, classes); }, ReadsIfAny{scope},
        Writes{classes});
  }
  void scopeByHue(const Image<uint8_t>& hue, Scoped evidence, Scoped scope,
                  Image<uint8_t>& out) override {
    run(
        [&] {
          const ImageView<const uint8_t> classes = hue.readOn(device()), seen = read(evidence);
          segmentation::scopeByHue(classes, seen, read(scope), out.writeOn(device()), stream());
        },
        [&] { Cpu::scopeByHue(hue, evidence, scope, out); }, Reads{hue}, ReadsIfAny{evidence},
        ReadsIfAny{scope}, Writes{out});
  }
  uint32_t divide(const Picture& picture, Scoped scope, const GrowthLimits& limits,
                  Image<uint16_t>& ids) override {
    return ask<uint32_t>(
        [&](uint32_t* count) { divideOnDevice(picture, scope, limits, count, ids); },
        [&] { return Cpu::divide(picture, scope, limits, ids); }, ReadsIfAny{scope}, Writes{ids});
  }
  void publish(Image<uint16_t>& ids, Image<uint8_t>& hue) override {
    onHost([] {}, Reads{ids}, Reads{hue});
  }

 private:
  [[nodiscard]] ImageView<const uint8_t> read(Scoped scope) const {
    return scope != nullptr ? scope->readOn(device()) : ImageView<const uint8_t>{};
  }

  void closeGapsOnDevice(const Picture& picture, const Image<uint8_t>& mask,
                         Image<uint8_t>& scope) {
    const Size size = picture.size();
    const BitTarget whole = scratchMask(size);
    packEqual(mask.readOn(device()), rg::background::kForegroundPixel, whole, stream());
    const GapView view{scratchMask(size), scratchMask(size), components(size),
                       scratch().take<GapContour>(mostRuns(size))};
    fillUnedged(picture.readOn(device()).green, kMostGapStep, mostGapPx(size), view, whole,
                stream());
    const ImageView<uint8_t> out = scope.writeOn(device());
    clear(out);
    paint(whole, rg::background::kForegroundPixel, out, stream());
  }

  void coverAreasOnDevice(std::span<const Box> areas, uint8_t around, Image<uint8_t>& scope) {
    areas_.clear();
    for (const Box& box : areas) areas_.push_back({box, 0, 0});
    const auto count = static_cast<uint32_t>(areas_.size());
    auto* list = scratch().take<Component>(std::max<int64_t>(count, 1));
    auto* listed = scratch().take<uint32_t>(1);
    if (count > 0) send(list, areas_.data(), count * sizeof(Component));
    send(listed, &count, sizeof count);
    segmentation::coverAreas({list, listed}, around, scope.writeOn(device()), stream());
  }

  void classifyHuesOnDevice(const Picture& picture, const HueRules& rules, Scoped scope,
                            Image<uint8_t>& classes) {
    const Planes planes = on().readRed(picture);
    const HueBand peak = fetched(findBand(planes));
    segmentation::classifyHues(planes, bandsOf(rules, peak), read(scope),
                               scratchPlane<uint8_t>(planes.size()), classes.writeOn(device()),
                               stream());
  }

  /// In device memory.
  [[nodiscard]] const HueBand* findBand(const Planes& planes) {
    auto* band = scratch().take<HueBand>(1);
    findFrameBand(planes, scratch().take<uint32_t>(rg::segmentation::kHueCount), band, stream());
    return band;
  }

  void divideOnDevice(const Picture& picture, Scoped scope, const GrowthLimits& limits,
                      uint32_t* count, Image<uint16_t>& ids) {
    const DivisionPlan plan = planOf(picture.size(), limits);
    const Planes planes = on().readRed(picture);
    const HueBand* band = findBand(planes);
    const GrownCells pixels{scratchPlanes(planes.size(), planes.channels), {}, {}, read(scope), 1};
    smoothColours(planes, pixels.colours, stream());
    const GrownCells cells = plan.sidePx == 1 ? pixels : averaged(pixels, plan.sidePx);
    const ImageView<uint16_t> out = ids.writeOn(device());
    if (plan.sidePx == 1) {
      (void)grow(cells, plan, limits, plan.pixels, band, out, count);
      return;
    }
    const ImageView<uint16_t> cellIds = scratchPlane<uint16_t>(cells.colours.size());
    const AbsorbedRegion* labelled =
        grow(cells, plan, limits, plan.cells, band, cellIds, scratch().take<uint32_t>(1));
    refineBorders({cells.colours, cells.scope, cells.ranges, cellIds, pixels.colours, pixels.scope,
                   cells.sidePx},
                  scratch().take<SideChoice>(cellIds.size.area()), out, stream());
    const GroupsView parts = groups(out.size);
    groupLabelled(out, pixels.scope, parts, stream());
    divideAgain(labelled, parts, plan.pixels, division(parts, out.size, plan.pixels, count), out,
                stream());
  }

  [[nodiscard]] GrownCells averaged(const GrownCells& pixels, int sidePx) {
    const Size frame = pixels.colours.size();
    const Size size{(frame.width + sidePx - 1) / sidePx, (frame.height + sidePx - 1) / sidePx};
    GrownCells cells{scratchPlanes(size, pixels.colours.channels),
                     scratchPlane<uint8_t>(size),
                     scratchPlane<uint8_t>(size),
                     {},
                     sidePx};
    const ImageView<uint8_t> scope = scratchPlane<uint8_t>(size);
    averageCells(pixels.colours, pixels.scope, sidePx,
                 {cells.colours, scope, cells.weights, cells.ranges}, stream());
    if (pixels.scope.data != nullptr) cells.scope = scope;
    return cells;
  }

  /// Returns what is left, by label.
  [[nodiscard]] const AbsorbedRegion* grow(const GrownCells& cells, const DivisionPlan& plan,
                                           const GrowthLimits& limits,
                                           const rg::segmentation::RegionDivision::Limits& wanted,
                                           const HueBand* band, ImageView<uint16_t> ids,
                                           uint32_t* count) {
    const Size size = cells.colours.size();
    const Planes colours = cells.colours;
    const bool isByHsv = limits.space == rg::segmentation::ColourSpace::Hsv;
    const LinkTargets links{scratchPlane<uint8_t>(size), scratchPlane<uint8_t>(size),
                            scratchPlane<int16_t>(size),
                            isByHsv ? scratchPlanes(size, 2) : PlaneTargets{}};
    linkColours(colours, cells.scope, {plan.similarity, limits.minAreaPx > 1, {}, limits.space},
                band, links, stream());
    const GroupsView linked = groups(size);
    groupLinked(links.links, cells.scope, plan.runs, cells.sidePx, linked, stream());
    const DivisionView view = division(linked, size, wanted, count);
    divideRegions({colours, cells.weights, cells.sidePx}, linked, wanted, view, ids, stream());
    return view.labelled;
  }

  [[nodiscard]] GroupsView groups(Size size) {
    const int64_t cells = size.area();
    const auto numbers = [&](int64_t count) { return scratch().take<uint32_t>(count); };
    const auto borders = static_cast<int64_t>(mostBorders(cells));
    const int64_t slots = slotsFor(mostBorders(cells));
    return {numbers(cells),
            numbers(cells),
            numbers(cells + 1),
            numbers(scanScratchOf(static_cast<int>(cells))),
            numbers(cells),
            numbers(cells),
            numbers(cells),
            numbers(cells),
            {scratch().take<unsigned long long>(slots), numbers(slots)},
            {scratch().take<AbsorbedBorder>(borders), numbers(1)}};
  }
  [[nodiscard]] DivisionView division(const GroupsView& groups, Size size,
                                      const rg::segmentation::RegionDivision::Limits& limits,
                                      uint32_t* count) {
    const int64_t most = size.area();
    const auto numbers = [&](int64_t wanted) { return scratch().take<uint32_t>(wanted); };
    const AbsorptionView absorption{scratch().take<AbsorbedRegion>(most),
                                    numbers(1),
                                    numbers(1),
                                    groups.borders,
                                    groups.pairs,
                                    numbers(most),
                                    numbers(most),
                                    numbers(most),
                                    numbers(most),
                                    scratch().take<unsigned long long>(most),
                                    scratch().take<MeanColour>(most),
                                    scratch().take<uint8_t>(most)};
    return {absorption, numbers(most), numbers(most),
            scratch().take<AbsorbedRegion>(int64_t{limits.maxRegions} + 1), count};
  }

  std::vector<Component> areas_;
};

}  // namespace
}  // namespace rg::gpu::segmentation

template <>
std::unique_ptr<rg::segmentation::Operations> rg::gpu::operationsOn(GpuDevice& device,
                                                                    const Executor& executor) {
  return std::make_unique<segmentation::GpuOperations>(device, executor);
}
