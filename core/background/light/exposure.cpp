// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/light/exposure.hpp"

#include "core/background/scene_watch.hpp"

namespace rg::background {

GainSums sumGains(const SmoothPicture& picture, const ConsensusBackground& model) {
  GainSums sums;
  const PointGrid grid = PointGrid::over(picture.size(), 0);
  for (int i = 0; i < grid.count(); ++i) {
    const Point p = grid.point(i);
    const int modelled = modelledLevel([&](int sample) { return +model.sample(p, sample, 0); });
    const int shown = picture.planes[0].at(p.x, p.y);
    if (GainSums::tells(shown, modelled))
      sums.weight[GainSums::gainOf(shown, modelled)] += static_cast<uint32_t>(modelled);
  }
  return sums;
}

int medianGain(const GainSums& sums) {
  uint32_t total = 0;
  for (const uint32_t weight : sums.weight) total += weight;
  if (total == 0) return kNoGain;
  uint32_t below = 0;
  int gain = 0;
  while (2 * (below += sums.weight[gain]) < total) ++gain;
  constexpr int kNear = kSameGain / 16;
  uint32_t near = 0;
  for (int i = std::max(0, gain - kNear); i <= std::min(GainSums::kGains - 1, gain + kNear); ++i)
    near += sums.weight[i];
  const bool hunts = kLeastGain <= gain && gain <= kMostGain && 2 * near >= total;
  return hunts ? gain : kNoGain;
}

LevelMap withoutGain(int gain) {
  LevelMap map{};
  for (int level = 0; level < 256; ++level) {
    const int plain = (level * kSameGain + gain / 2) / gain;
    const int clipped = std::max(0, level - GainSums::kClipped);
    const int lost = (255 - plain) * clipped / (255 - GainSums::kClipped) / 2;
    map[static_cast<size_t>(level)] =
        static_cast<uint8_t>(std::min(255, plain + std::max(0, lost)));
  }
  return map;
}

LevelMap withGain(int gain) {
  LevelMap map{};
  for (int level = 0; level < 256; ++level)
    map[static_cast<size_t>(level)] =
        static_cast<uint8_t>(std::min(255, (level * gain + kSameGain / 2) / kSameGain));
  return map;
}

void mapLevels(const LevelMap& map, const Executor& executor, SmoothPicture& picture) {
  const Size size = picture.size();
  executor.forRows(size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (size_t c = 0; c < static_cast<size_t>(picture.channels); ++c) {
        uint8_t* row = picture.planes[c].row(y);
        for (int x = 0; x < size.width; ++x) row[x] = map[row[x]];
      }
  });
}

}  // namespace rg::background
