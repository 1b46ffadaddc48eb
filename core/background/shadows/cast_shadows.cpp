// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/shadows/cast_shadows.hpp"

namespace rg::background {
namespace {

/// Is (x, y) inside the picture and foreground that is not darkened?
bool isSolid(const BitMask& mask, const BitMask& dark, int x, int y) {
  return boundsOf(mask.size()).contains({x, y}) && mask.at(x, y) && !dark.at(x, y);
}

bool isFree(const BitMask& mask, int x, int y) {
  return boundsOf(mask.size()).contains({x, y}) && !mask.at(x, y);
}

void readColumn(const BitMask& mask, const BitMask& dark, Point top, DarkPart& part) {
  int end = top.y;
  while (end < mask.height() && dark.at(top.x, end)) ++end;
  ++part.columns;
  part.enclosedColumns += isSolid(mask, dark, top.x, top.y - 1) && isSolid(mask, dark, top.x, end);
}

void readRun(const BitMask& mask, const BitMask& dark, const ComponentRun& run, DarkPart& part) {
  const auto addSide = [&](int x, int y) {
    part.solidContacts += isSolid(mask, dark, x, y);
    part.freeContacts += isFree(mask, x, y);
  };
  addSide(run.begin - 1, run.y);
  addSide(run.end, run.y);
  for (int x = run.begin; x < run.end; ++x) {
    addSide(x, run.y - 1);
    addSide(x, run.y + 1);
    if (run.y == 0 || !dark.at(x, run.y - 1)) readColumn(mask, dark, {x, run.y}, part);
  }
}

}  // namespace

void keepCastShadows(const BitMask& mask, BitMask& dark, CastShadowScratch& scratch) {
  findComponents(dark, true, Connectivity::Four, scratch.darkParts);
  scratch.dark.assign(scratch.darkParts.list.size(), {});
  for (const ComponentRun& run : scratch.darkParts.runs)
    readRun(mask, dark, run, scratch.dark[run.component]);
  scratch.isChosen.resize(scratch.dark.size());
  for (size_t i = 0; i < scratch.dark.size(); ++i) scratch.isChosen[i] = !isCast(scratch.dark[i]);
  paintComponents(scratch.darkParts, scratch.isChosen, false, dark);

  // What is left must not be most of an object.
  Components& objects = scratch.objects;
  findComponents(mask, true, Connectivity::Eight, objects);
  scratch.darkOf.assign(objects.list.size(), 0);
  for (const ComponentRun& run : objects.runs)
    scratch.darkOf[run.component] +=
        static_cast<uint32_t>(countColumns(dark.row(run.y), run.begin, run.end));
  scratch.isChosen.resize(objects.list.size());
  for (size_t i = 0; i < objects.list.size(); ++i)
    scratch.isChosen[i] = isMostlyDark(scratch.darkOf[i], objects.list[i].areaPx);
  paintComponents(objects, scratch.isChosen, false, dark);
}

}  // namespace rg::background
