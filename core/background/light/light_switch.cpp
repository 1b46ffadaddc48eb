// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/light/light_switch.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>

namespace rg::background {
namespace {

uint64_t sum(const Histogram& histogram) {
  uint64_t total = 0;
  for (const uint32_t count : histogram) total += count;
  return total;
}

}  // namespace

LevelMap matchLevels(const Histogram& from, const Histogram& to) {
  // Ranks in units of both totals' product, so that pictures of different sizes compare exactly.
  const uint64_t fromTotal = std::max<uint64_t>(1, sum(from));
  const uint64_t toTotal = std::max<uint64_t>(1, sum(to));
  LevelMap map{};
  uint64_t below = 0, reached = to[0];
  size_t level = 0;
  for (size_t i = 0; i < map.size(); ++i) {
    // The middle of a level's pixels stands for them all. Counts stay below 2³², products in 64.
    const uint64_t middle = 2 * below + from[i];
    while (level < 255 && 2 * reached * fromTotal <= middle * toTotal) reached += to[++level];
    map[i] = static_cast<uint8_t>(level);
    below += from[i];
  }
  return map;
}

LevelMaps matchLight(const std::array<Image<uint8_t>, 3>& shown, const SmoothPicture& picture,
                     const Executor& executor) {
  LevelMaps maps{};
  for (size_t c = 0; c < static_cast<size_t>(picture.channels); ++c)
    maps[c] =
        matchLevels(countLevels(shown[c], executor), countLevels(picture.planes[c], executor));
  return maps;
}

uint32_t countApart(const std::array<Image<uint8_t>, 3>& shown, const SmoothPicture& picture,
                    const LevelMaps& maps, const ConsensusBackground& model,
                    const Tolerance& tolerance) {
  const Size size = picture.size();
  uint32_t pixels = 0;
  for (int y = 0; y < size.height; ++y) {
    const RadiusRow radius = radiusRow(model, tolerance, y);
    for (int x = 0; x < size.width; ++x) {
      int off = 0;
      for (size_t c = 0; c < static_cast<size_t>(picture.channels); ++c)
        off = std::max(off, absDiff(maps[c][shown[c].row(y)[x]], picture.planes[c].row(y)[x]));
      pixels += off > radiusAt(radius, picture.planes[0].row(y)[x], x);
    }
  }
  return pixels;
}

void relight(const LevelMaps& maps, const Executor& executor, ConsensusBackground& model) {
  executor.forRows(model.noise.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      uint8_t* samples = model.samples.row(y);
      for (int block = 0; block * kWordColumns < model.samples.width(); ++block) {
        const LevelMap& map = maps[static_cast<size_t>(block % model.channels)];
        for (int x = 0; x < kWordColumns; ++x, ++samples) *samples = map[*samples];
      }
    }
  });
}

}  // namespace rg::background
