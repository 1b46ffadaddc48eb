// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/scene_watch.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <tuple>

namespace rg::background {
namespace {

template <class Visit>
void forGrid(Size size, int margin, Visit&& visit) {
  const PointGrid grid = PointGrid::over(size, margin);
  for (int y = margin; y < size.height - margin; y += grid.step)
    for (int x = margin; x < size.width - margin; x += grid.step) visit(Point{x, y});
}

/// The mean of a few samples of the first channel.
int modelled(const ConsensusBackground& model, Point p) {
  return modelledLevel([&](int sample) { return +model.sample(p, sample, 0); });
}

}  // namespace

LitPoints countLit(const SmoothPicture& picture, int level) {
  LitPoints points;
  forGrid(picture.size(), 0, [&](Point p) {
    int most = 0;
    for (size_t c = 0; c < static_cast<size_t>(picture.channels); ++c)
      most = std::max<int>(most, picture.planes[c].at(p.x, p.y));
    points.add(most, level);
  });
  return points;
}

bool isDarkerThan(const SmoothPicture& picture, int level) {
  return isDark(countLit(picture, level));
}

VividPoints countVivid(const SmoothPicture& picture, const ConsensusBackground& model) {
  VividPoints points;
  forGrid(picture.size(), 0, [&](Point p) {
    ++points.all;
    points.now += isVivid(picture.planes[0].at(p.x, p.y), picture.planes[1].at(p.x, p.y),
                          picture.planes[2].at(p.x, p.y));
    points.before += isVivid(model.sample(p, 0, 0), model.sample(p, 0, 1), model.sample(p, 0, 2));
  });
  return points;
}

bool hasSwitchedColour(const VividPoints& points) {
  const auto [less, more] = std::minmax(points.now, points.before);
  return 50 * less <= points.all && 10 * more >= points.all;
}

bool hasSwitchedColour(const SmoothPicture& picture, const ConsensusBackground& model) {
  return picture.channels != 1 && hasSwitchedColour(countVivid(picture, model));
}

ShiftedSums sumShifted(const SmoothPicture& picture, const ConsensusBackground& model,
                       Point centre) {
  constexpr int kMostOff = ShiftedSums::kMostOff, kReach = ShiftedSums::kReach;
  ShiftedSums sums;
  forGrid(picture.size(), mostShiftPx(picture.size()), [&](Point p) {
    const int there = modelled(model, p);
    const auto off = [&](int now) {
      return static_cast<uint32_t>(std::min(kMostOff, absDiff(now, there)));
    };
    sums.unmoved += off(picture.planes[0].at(p.x, p.y));
    uint32_t* sum = sums.off;
    for (int y = -kReach; y <= kReach; ++y) {
      const uint8_t* row = picture.planes[0].row(p.y - centre.y - y) + p.x - centre.x;
      for (int x = -kReach; x <= kReach; ++x) *sum++ += off(row[-x]);
    }
  });
  return sums;
}

Shift bestShift(const ShiftedSums& sums, Point centre) {
  constexpr uint64_t kFarther = 256;  // Of which one for each pixel must be explained.
  std::tuple<uint64_t, int, int, int> best{kFarther * sums.unmoved, 0, 0, 0};
  Shift found{{}, sums.unmoved, sums.unmoved};
  for (int i = 0; i < ShiftedSums::kShifts; ++i) {
    const Point by = ShiftedSums::shift(i), to{centre.x + by.x, centre.y + by.y};
    const auto way = static_cast<uint64_t>(absDiff(to.x, 0) + absDiff(to.y, 0));
    const std::tuple key{kFarther * sums.off[i] + way * sums.unmoved, to.x * to.x + to.y * to.y,
                         to.y, to.x};
    if (key >= best) continue;
    best = key;
    found = {to, sums.off[i], sums.unmoved};
  }
  return found;
}

Point centreWithin(Point shift, Size size) {
  const int most = mostShiftPx(size) - ShiftedSums::kReach;
  return {std::clamp(shift.x, -most, most), std::clamp(shift.y, -most, most)};
}

void shiftPicture(Point shift, const Executor& executor, SmoothPicture& spare,
                  SmoothPicture& picture) {
  const Size size = picture.size();
  spare.channels = picture.channels;
  for (size_t c = 0; c < static_cast<size_t>(picture.channels); ++c) spare.planes[c].resize(size);
  executor.forRows(size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (size_t c = 0; c < static_cast<size_t>(picture.channels); ++c) {
        const uint8_t* from = picture.planes[c].row(std::clamp(y - shift.y, 0, size.height - 1));
        uint8_t* to = spare.planes[c].row(y);
        for (int x = 0; x < size.width; ++x)
          to[x] = from[std::clamp(x - shift.x, 0, size.width - 1)];
      }
  });
  std::swap(spare, picture);
}

int countFullFields(const BitMask& raw) {
  int full = 0;
  for (int row = 0; row < kFieldsAlong; ++row)
    for (int column = 0; column < kFieldsAlong; ++column) {
      const Box field = fieldOf(raw.size(), column, row);
      int64_t set = 0;
      for (int y = field.y; y < field.bottom(); ++y)
        set += countColumns(raw.row(y), field.x, field.right());
      full += isFull(field, set);
    }
  return full;
}

bool isEverywhere(const BitMask& raw) {
  return isEverywhere(countFullFields(raw));
}

}  // namespace rg::background
