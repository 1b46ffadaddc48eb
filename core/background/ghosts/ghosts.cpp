// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/ghosts.hpp"

#include "core/simd/background/still_rows.hpp"

#include <algorithm>
#include <array>

namespace rg::background {
namespace {

void fadeFresh(int y, StillPixels& still) {
  uint8_t& freshFrames = still.freshRows[static_cast<size_t>(y)];
  if (freshFrames == 0) return;
  --freshFrames;
  uint8_t* fresh = still.fresh.row(y);
  for (int x = 0; x < still.fresh.width(); ++x)
    fresh[x] = static_cast<uint8_t>(std::max(uint8_t{1}, fresh[x]) - 1);
}

void followWord(const SmoothPicture& picture, uint64_t foreground, uint16_t mostAge,
                RadiusRow radius, Point at, StillPixels& still) {
  const int begin = at.x * kWordColumns;
  StillWord word{{}, {}, still.ages.row(at.y) + begin, mostAge, picture.channels, foreground};
  for (size_t c = 0; c < static_cast<size_t>(picture.channels); ++c) {
    word.pixels[c] = picture.planes[c].row(at.y) + begin;
    word.kept[c] = still.colours[c].row(at.y) + begin;
  }
  radius.noise += begin;
  radius.unrest += begin;
  simd::followStillWord(word, radius);
}

/// Reads the contour of still parts: how strong an edge do picture and model have there?
class ContourReader {
 public:
  ContourReader(const SmoothPicture& picture, const ConsensusBackground& model,
                const BitMask& foreground, StillScratch& scratch, ImageView<const uint8_t> fresh)
      : picture_(picture),
        model_(model),
        foreground_(foreground),
        still_(scratch.still),
        fresh_(fresh),
        contours_(scratch.contours) {}

  void read(const ComponentRun& run) {
    addAcross({run.begin, run.y}, {-1, 0}, run.component);
    addAcross({run.end - 1, run.y}, {1, 0}, run.component);
    for (int x = run.begin; x < run.end; ++x) {
      addAcross({x, run.y}, {0, -1}, run.component);
      addAcross({x, run.y}, {0, 1}, run.component);
    }
  }

 private:
  /// The mask's border is a pixel or two off: compare one pixel inside with two outside.
  void addAcross(Point p, Point step, uint32_t component) {
    const Point beside{p.x + step.x, p.y + step.y};
    const Point outside{p.x + 2 * step.x, p.y + 2 * step.y};
    const Point inside{p.x - step.x, p.y - step.y};
    const Box bounds = boundsOf(foreground_.size());
    if (!bounds.contains(outside) || !bounds.contains(inside)) return;
    if (still_.at(beside.x, beside.y)) return;
    ContourSums& sums = contours_[component];
    ++sums.allPixels;
    if (foreground_.at(beside.x, beside.y) || foreground_.at(outside.x, outside.y)) return;
    if (fresh_.at(outside.x, outside.y) != 0) return;
    sums.inPicture += edgeBetween(picture_.channels, inside, outside, [&](Point at, int channel) {
      return +picture_.planes[static_cast<size_t>(channel)].at(at.x, at.y);
    });
    sums.inModel += edgeBetween(picture_.channels, inside, outside, [&](Point at, int channel) {
      return modelledLevel([&](int sample) { return +model_.sample(at, sample, channel); });
    });
    ++sums.readPixels;
  }

  const SmoothPicture& picture_;
  const ConsensusBackground& model_;
  const BitMask &foreground_, &still_;
  ImageView<const uint8_t> fresh_;
  std::vector<ContourSums>& contours_;
};

uint32_t judgeParts(StillScratch& scratch) {
  const std::vector<Component>& parts = scratch.parts.list;
  scratch.isGhost.resize(parts.size());
  uint32_t pixels = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    const bool isGhost = isGhostly(scratch.contours[i]);
    scratch.isGhost[i] = isGhost;
    if (isGhost) pixels += parts[i].areaPx;
  }
  return pixels;
}

}  // namespace

void prepare(Size size, int channels, StillPixels& still) {
  for (size_t c = 0; c < static_cast<size_t>(channels); ++c) still.colours[c].resize(size);
  const int words = (size.width + kWordColumns - 1) / kWordColumns;
  still.ages.resize({words * kWordColumns, size.height});
  still.aged.resize(size);
  still.fresh.resize(size);
  still.freshRows.resize(static_cast<size_t>(size.height));
}

void clear(StillPixels& still) {
  still.ages.fill(0);
  still.aged.clear();
  still.fresh.fill(0);
  std::fill(still.freshRows.begin(), still.freshRows.end(), uint8_t{0});
}

void followStill(const SmoothPicture& picture, const ConsensusBackground& model,
                 const Tolerance& tolerance, const BitMask& foreground, uint16_t mostAge,
                 const Executor& executor, StillPixels& still) {
  executor.forRows(picture.size().height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      fadeFresh(y, still);
      const RadiusRow radius = radiusRow(model, tolerance, y);
      uint64_t* aged = still.aged.row(y);
      for (int word = 0; word < still.aged.wordsPerRow(); ++word) {
        const uint64_t now = foreground.row(y)[word];
        if ((aged[word] | now) != 0) followWord(picture, now, mostAge, radius, {word, y}, still);
        aged[word] = now;
      }
    }
  });
}

void addAged(const BitMask& foreground, const StillPixels& still, int64_t leastAge,
             BitMask& places) {
  if (leastAge > UINT16_MAX) return;
  const auto least = static_cast<uint16_t>(std::max<int64_t>(0, leastAge));
  for (int y = 0; y < foreground.height(); ++y)
    for (int word = 0; word < foreground.wordsPerRow(); ++word) {
      const uint64_t bits = foreground.row(y)[word];
      if (bits == 0) continue;
      const uint16_t* ages = still.ages.row(y) + word * kWordColumns;
      places.row(y)[word] |= bits & simd::agedColumns(ages, least);
    }
}

uint32_t findGhosts(const SmoothPicture& picture, const ConsensusBackground& model,
                    const BitMask& foreground, StillPixels& still, int leastAge,
                    StillScratch& scratch, BitMask& ghosts) {
  scratch.still.resize(foreground.size());
  scratch.still.clear();
  ghosts.clear();
  addAged(foreground, still, leastAge, scratch.still);
  findComponents(scratch.still, true, Connectivity::Eight, scratch.parts);
  scratch.contours.assign(scratch.parts.list.size(), {});
  ContourReader reader(picture, model, foreground, scratch, still.fresh);
  for (const ComponentRun& run : scratch.parts.runs) reader.read(run);
  const uint32_t pixels = judgeParts(scratch);
  if (pixels == 0) return 0;
  paintComponents(scratch.parts, scratch.isGhost, true, ghosts);
  paintComponents(scratch.parts, scratch.isGhost, kFreshFrames, still.fresh);
  for (const ComponentRun& run : scratch.parts.runs)
    if (scratch.isGhost[run.component] != 0)
      still.freshRows[static_cast<size_t>(run.y)] = kFreshFrames;
  return pixels;
}

}  // namespace rg::background
