// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/mask_gaps.hpp"

#include "core/pixel.hpp"

#include <algorithm>
#include <bit>

namespace rg {
namespace {

void addStep(ImageView<const uint8_t> picture, int reach, Point p, Point direction,
             GapContour& contour) {
  const Point outside{p.x + reach * direction.x, p.y + reach * direction.y};
  const Point inside{p.x - 2 * direction.x, p.y - 2 * direction.y};
  const Box bounds = boundsOf(picture.size);
  if (!bounds.contains(outside) || !bounds.contains(inside)) return;
  contour.steps += absDiff(picture.at(inside.x, inside.y), picture.at(outside.x, outside.y));
  ++contour.pixels;
}

void readRun(ImageView<const uint8_t> picture, const BitMask& thick, int reach, const Run& run,
             GapContour& contour) {
  const int width = thick.width(), height = thick.height();
  if (run.begin == 0) contour.frameSides |= 1;
  if (run.y == 0) contour.frameSides |= 2;
  if (run.end == width) contour.frameSides |= 4;
  if (run.y == height - 1) contour.frameSides |= 8;
  if (run.begin > 0) addStep(picture, reach, {run.begin, run.y}, {-1, 0}, contour);
  if (run.end < width) addStep(picture, reach, {run.end - 1, run.y}, {1, 0}, contour);
  for (int x = run.begin; x < run.end; ++x) {
    if (run.y > 0 && thick.at(x, run.y - 1)) addStep(picture, reach, {x, run.y}, {0, -1}, contour);
    if (run.y + 1 < height && thick.at(x, run.y + 1))
      addStep(picture, reach, {x, run.y}, {0, 1}, contour);
  }
}

bool isGap(const Component& part, const GapContour& contour, int mostStep, uint32_t mostPx) {
  return part.areaPx <= mostPx && std::popcount(static_cast<unsigned>(contour.frameSides)) <= 1 &&
         contour.pixels > 0 && contour.steps <= contour.pixels * mostStep;
}

}  // namespace

void fillUnedged(ImageView<const uint8_t> picture, int mostStep, uint32_t mostPx,
                 const Executor& executor, GapScratch& scratch, BitMask& mask) {
  const int margin = std::clamp(mask.height() / 40, 1, 4);
  thicken(mask, margin, executor, scratch.across, scratch.thick);
  findComponents(scratch.thick, false, Connectivity::Four, scratch.parts);
  const std::vector<Component>& list = scratch.parts.list;
  scratch.contours.assign(list.size(), {});
  for (const Run& run : scratch.parts.runs)
    if (list[run.component].areaPx <= mostPx)
      readRun(picture, scratch.thick, margin + 2, run, scratch.contours[run.component]);
  scratch.isChosen.resize(list.size());
  bool isAny = false;
  for (size_t i = 0; i < list.size(); ++i) {
    scratch.isChosen[i] = isGap(list[i], scratch.contours[i], mostStep, mostPx);
    isAny = isAny || scratch.isChosen[i] != 0;
  }
  if (!isAny) return;
  paintComponents(scratch.parts, scratch.isChosen, true, mask);
  // The rim that the thickening took from the gap.
  for (const Run& run : scratch.parts.runs) {
    if (scratch.isChosen[run.component] == 0) continue;
    const int top = std::max(0, run.y - margin),
              bottom = std::min(mask.height() - 1, run.y + margin);
    const int begin = std::max(0, run.begin - margin),
              end = std::min(mask.width(), run.end + margin);
    for (int y = top; y <= bottom; ++y) setColumns(mask.row(y), begin, end, true);
  }
}

}  // namespace rg
