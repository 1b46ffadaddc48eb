// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/methods/difference_operations.hpp"

#include "core/background/changed_pixels.hpp"
#include "core/background/ghosts/outline_ghosts.hpp"

namespace rg::background {
namespace {

constexpr uint64_t kOtherScene = 154;  ///< Of 256: share of the known scene that no object covers.
constexpr uint64_t kOneDirection = 230;  ///< Of 256: so many pixels brighter, or darker: the light.

void fill(ImageView<uint8_t> image, uint8_t value) {
  for (int y = 0; y < image.height(); ++y) std::fill_n(image.row(y), image.width(), value);
}

ColourPlanes scanned(const Picture& picture, const ScannedRows& rows) {
  return everyRow(planesOf(picture), rows.first, rows.step);
}

}  // namespace

SceneEvent SceneCounts::event() const {
  const uint64_t changed = uint64_t{brighter} + darker;
  if (changed * 256 <= known * kOtherScene) return SceneEvent::None;
  return std::max(brighter, darker) * uint64_t{256} >= changed * kOneDirection
             ? SceneEvent::LightSwitched
             : SceneEvent::CameraMoved;
}

SceneCounts countScene(ImageView<const uint8_t> now, ImageView<const uint8_t> scene,
                       ImageView<const uint8_t> isKnown, int threshold) {
  SceneCounts counts;
  for (int y = 0; y < now.height(); ++y) {
    const uint8_t *level = now.row(y), *before = scene.row(y), *known = isKnown.row(y);
    uint32_t knownHere = 0, brighterHere = 0, darkerHere = 0;
    for (int x = 0; x < now.width(); x += kComparedColumns) {
      const int bit = known[x] & 1;
      knownHere += static_cast<uint32_t>(bit);
      brighterHere += static_cast<uint32_t>(bit & int{level[x] > before[x] + threshold});
      darkerHere += static_cast<uint32_t>(bit & int{before[x] > level[x] + threshold});
    }
    counts.known += knownHere;
    counts.brighter += brighterHere;
    counts.darker += darkerHere;
  }
  return counts;
}

void markCells(const JudgedParts& parts, Image<uint8_t>& cells) {
  const Box grid = boundsOf(parts.search.grid());
  cells.resize(parts.search.grid());
  cells.fill(0);
  const auto add = [&](const Box& box, uint8_t bits) {
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x) cells.at(x, y) |= bits;
  };
  for (const ComponentRun& run : parts.search.parts().runs) {
    const Box box{run.begin, run.y, run.end - run.begin, 1};
    if (parts.is(run, Verdict::Scene)) add(box, kSceneCell);
    if (!parts.is(run, Verdict::Thing)) continue;
    add(box, kThingCell);
    add(intersect(inflate(box, 1), grid), kKeptCell);
  }
}

ImageView<const uint8_t> countedRows(ImageView<const uint8_t> changes) {
  const int step = changes.height() < 2 * kLeastScannedRows - 2 ? 1 : 2;
  return {changes.data, {changes.width(), changes.height() / step}, step * changes.strideBytes};
}

void clearMask(Foreground& out) {
  fill(out.mask.view().crop(out.extent), kBackgroundPixel);
  out.extent = {};
}

Box extentOfThings(const JudgedParts& parts, Size frame) {
  Box extent;
  for (const ComponentRun& run : parts.search.parts().runs)
    if (parts.is(run, Verdict::Thing)) extent = unite(extent, pixelsOfCells(run, frame));
  return extent;
}

Scan DifferenceOperations::scan(const DifferenceFrame& frame, const SceneMemory& memory,
                                LevelsOf levels, int threshold, Image<uint8_t>& changes) {
  const ColourPlanes now = scanned(frame.now, frame.scanned);
  changes.resize(now.green.size);
  if (frame.before != nullptr) {
    const ColourPlanes before = scanned(*frame.before, frame.scanned);
    executor_.forRows(changes.height(), [&](int first, int last) {
      for (int y = first; y < last; ++y)
        measureChange(now, before, runOf(y, 0, changes.width()), changes.row(y));
    });
  } else {
    changes.fill(0);
  }
  const auto thinned = [&](ImageView<const uint8_t> plane) {
    return everyRow(plane, frame.scanned.first, frame.scanned.step);
  };
  Scan scan{
      countScene(now.green, thinned(memory.planes().green), thinned(memory.known()), threshold)};
  if (levels == LevelsOf::Frame) scan.levels = countLevels(now.green, executor_);
  if (levels == LevelsOf::Changes) scan.levels = countLevels(countedRows(changes), executor_);
  return scan;
}

void DifferenceOperations::search(const DifferenceFrame& frame, const SceneMemory& memory,
                                  const SearchPlan& plan, const Image<uint8_t>& changes,
                                  CellSearch& search) {
  for (int row = 0; row < changes.height(); ++row)
    search.addHits(changes.row(row), frame.scanned.first + row * frame.scanned.step,
                   plan.threshold);
  const ColourPlanes before = frame.before != nullptr ? planesOf(*frame.before) : ColourPlanes{};
  search.run(plan.scope, {planesOf(frame.now), before, memory, plan.threshold, plan.sceneThreshold},
             executor_);
}

void DifferenceOperations::findGhosts(const Picture& now, const SceneMemory& memory,
                                      const CellSearch& search, std::span<const uint32_t> parts,
                                      std::vector<uint8_t>& isGhost) {
  isGhost.clear();
  for (const uint32_t part : parts)
    isGhost.push_back(sumOutline(search, part, planesOf(now), memory).isGhost());
}

void DifferenceOperations::paint(const JudgedParts& parts, Foreground& out) {
  clearMask(out);
  const Size frame = out.mask.size();
  out.extent = extentOfThings(parts, frame);
  for (const ComponentRun& run : parts.search.parts().runs) {
    if (!parts.is(run, Verdict::Thing)) continue;
    const Box box = pixelsOfCells(run, frame);
    for (int y = box.y; y < box.bottom(); ++y)
      keepDense(parts.search.foundRow(y - 1), parts.search.foundRow(y),
                parts.search.foundRow(y + 1), runOf(y, box.x, box.right()), out.mask.row(y));
  }
  const ImageView<uint8_t> part = out.mask.view().crop(out.extent);
  packEqual(part, kForegroundPixel, bits_);
  fillHoles(bits_, mostHolePx(frame), scratch_);
  dropSmallParts(bits_, leastThingPx(frame), scratch_);
  fill(part, kBackgroundPixel);
  rg::paint(bits_, kForegroundPixel, part);
}

void DifferenceOperations::learn(const DifferenceFrame& frame, const JudgedParts& parts,
                                 SceneMemory& memory) {
  const ColourPlanes now = planesOf(frame.now);
  const Size size = now.green.size;
  const Image<uint8_t>& cells = marked(parts);
  for (const ComponentRun& run : parts.search.parts().runs) {
    if (!parts.is(run, Verdict::Scene)) continue;
    const Box box = pixelsOfCells(run, size);
    for (int y = box.y; y < box.bottom(); ++y) memory.learn(now, runOf(y, box.x, box.right()));
  }
  for (int y = frame.scanned.first; y < size.height; y += frame.scanned.step) {
    const uint8_t* row = cells.row(y / kCellPx);
    const auto isKept = [&](int x) { return (row[x] & kKeptCell) != 0; };
    for (int x = 0; x < cells.width();) {
      const int begin = x;
      while (x < cells.width() && !isKept(x)) ++x;
      if (x > begin)
        memory.learn(now, runOf(y, begin * kCellPx, std::min(x * kCellPx, size.width)));
      while (x < cells.width() && isKept(x)) ++x;
    }
  }
}

const Image<uint8_t>& DifferenceOperations::marked(const JudgedParts& parts) {
  markCells(parts, cells_);
  return cells_;
}

}  // namespace rg::background
