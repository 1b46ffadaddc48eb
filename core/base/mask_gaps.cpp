// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/mask_gaps.hpp"

#include <algorithm>

namespace rg {
namespace {

void readRun(const EdgeTest& test, const BitMask& thick, const ComponentRun& run,
             GapContour& contour) {
  const int width = thick.width(), height = thick.height();
  if (run.begin == 0) contour.frameSides |= 1;
  if (run.y == 0) contour.frameSides |= 2;
  if (run.end == width) contour.frameSides |= 4;
  if (run.y == height - 1) contour.frameSides |= 8;
  if (run.begin > 0) addStep(test, {run.begin, run.y}, {-1, 0}, contour);
  if (run.end < width) addStep(test, {run.end - 1, run.y}, {1, 0}, contour);
  for (int x = run.begin; x < run.end; ++x) {
    if (run.y > 0 && thick.at(x, run.y - 1)) addStep(test, {x, run.y}, {0, -1}, contour);
    if (run.y + 1 < height && thick.at(x, run.y + 1)) addStep(test, {x, run.y}, {0, 1}, contour);
  }
}

}  // namespace

bool fillUnedged(ImageView<const uint8_t> picture, int mostStep, uint32_t mostPx,
                 const Executor& executor, GapScratch& scratch, BitMask& mask) {
  const int margin = gapMargin(mask.size());
  thicken(mask, margin, executor, scratch.across, scratch.thick);
  findComponents(scratch.thick, false, Connectivity::Four, scratch.parts);
  const std::vector<Component>& list = scratch.parts.list;
  scratch.contours.assign(list.size(), {});
  for (const ComponentRun& run : scratch.parts.runs)
    if (list[run.component].areaPx <= mostPx)
      readRun({picture, margin + 2, mostStep}, scratch.thick, run, scratch.contours[run.component]);
  scratch.isChosen.resize(list.size());
  bool isAny = false;
  for (size_t i = 0; i < list.size(); ++i) {
    scratch.isChosen[i] = isGap(list[i].areaPx, scratch.contours[i], mostPx);
    isAny = isAny || scratch.isChosen[i] != 0;
  }
  if (!isAny) return false;
  paintComponents(scratch.parts, scratch.isChosen, true, mask);
  // The rim that the thickening took from the gap.
  for (const ComponentRun& run : scratch.parts.runs) {
    if (scratch.isChosen[run.component] == 0) continue;
    const int top = std::max(0, run.y - margin),
              bottom = std::min(mask.height() - 1, run.y + margin);
    const int begin = std::max(0, run.begin - margin),
              end = std::min(mask.width(), run.end + margin);
    for (int y = top; y <= bottom; ++y) setColumns(mask.row(y), begin, end, true);
  }
  return true;
}

}  // namespace rg
