// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/cast_shadows.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr uint32_t kMostDarkShare = 192;  ///< Of 256: an object darker than that casts no shadow.

/// Is (x, y) inside the picture and foreground that is not darkened?
bool isSolid(ImageView<const uint8_t> mask, ImageView<const uint8_t> dark, int x, int y) {
  return boundsOf(mask.size).contains({x, y}) && mask.at(x, y) != 0 && dark.at(x, y) == 0;
}

bool isFree(ImageView<const uint8_t> mask, int x, int y) {
  return boundsOf(mask.size).contains({x, y}) && mask.at(x, y) == 0;
}

void readColumn(ImageView<const uint8_t> mask, ImageView<const uint8_t> dark, Point top,
                DarkPart& part) {
  int end = top.y;
  while (end < mask.height() && dark.at(top.x, end) != 0) ++end;
  ++part.columns;
  part.enclosedColumns += isSolid(mask, dark, top.x, top.y - 1) && isSolid(mask, dark, top.x, end);
}

void readRun(ImageView<const uint8_t> mask, ImageView<const uint8_t> dark, const Run& run,
             DarkPart& part) {
  const auto addSide = [&](int x, int y) {
    part.solidContacts += isSolid(mask, dark, x, y);
    part.freeContacts += isFree(mask, x, y);
  };
  addSide(run.begin - 1, run.y);
  addSide(run.end, run.y);
  for (int x = run.begin; x < run.end; ++x) {
    addSide(x, run.y - 1);
    addSide(x, run.y + 1);
    if (run.y == 0 || dark.at(x, run.y - 1) == 0) readColumn(mask, dark, {x, run.y}, part);
  }
}

/// A part that hangs on solid foreground, is open to the background and is not sandwiched.
bool isCast(const DarkPart& part) {
  return part.solidContacts > 0 && 3 * part.freeContacts >= part.solidContacts &&
         2 * part.enclosedColumns <= part.columns;
}

}  // namespace

void keepCastShadows(ImageView<const uint8_t> mask, ImageView<uint8_t> dark,
                     CastShadowScratch& scratch) {
  findComponents(dark, 255, Connectivity::Four, scratch.darkParts);
  scratch.dark.assign(scratch.darkParts.list.size(), {});
  for (const Run& run : scratch.darkParts.runs)
    readRun(mask, dark, run, scratch.dark[run.component]);
  scratch.isChosen.resize(scratch.dark.size());
  for (size_t i = 0; i < scratch.dark.size(); ++i) scratch.isChosen[i] = !isCast(scratch.dark[i]);
  paintComponents(scratch.darkParts, scratch.isChosen, 0, dark);

  // What is left must not be most of an object.
  Components& objects = scratch.objects;
  findComponents(mask, 255, Connectivity::Eight, objects);
  scratch.darkOf.assign(objects.list.size(), 0);
  for (const Run& run : objects.runs) {
    const uint8_t* row = dark.row(run.y);
    scratch.darkOf[run.component] +=
        static_cast<uint32_t>(std::count(row + run.begin, row + run.end, uint8_t{255}));
  }
  scratch.isChosen.resize(objects.list.size());
  for (size_t i = 0; i < objects.list.size(); ++i)
    scratch.isChosen[i] =
        uint64_t{scratch.darkOf[i]} * 256 > uint64_t{objects.list[i].areaPx} * kMostDarkShare;
  paintComponents(objects, scratch.isChosen, 0, dark);
}

}  // namespace rg
