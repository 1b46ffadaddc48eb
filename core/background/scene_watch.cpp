// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/scene_watch.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace rg::background {
namespace {

constexpr int64_t kMostPoints = 4096;
constexpr int kMostShift = 3;
constexpr int kMostOff = 32;  ///< Grey levels that a point counts at most: it may be an object's.
constexpr int kLeastChroma = 20;
constexpr int kFields = 8;
constexpr int kBlack = 2;  ///< Grey levels up to which nothing shines and nothing is noise.
constexpr int kLit = 64;   ///< And from which something shines.

template <class Visit>
void forGrid(Size size, int margin, Visit&& visit) {
  int step = 1;
  while (size.area() > kMostPoints * step * step) ++step;
  for (int y = margin; y < size.height - margin; y += step)
    for (int x = margin; x < size.width - margin; x += step) visit(Point{x, y});
}

bool isVivid(int a, int b, int c) {
  const auto [least, most] = std::minmax({a, b, c});
  return most - least >= kLeastChroma;
}

int modelled(const ConsensusBackground& model, Point p) {
  int sum = 0;
  for (int k = 0; k < kSamples; k += kSamples / 4) sum += model.sample(p, k, 0);
  return sum / 4;
}

}  // namespace

bool isDarkerThan(const SmoothPicture& picture, int level) {
  int points = 0, bright = 0, lit = 0, dim = 0;
  forGrid(picture.size(), 0, [&](Point p) {
    int most = 0;
    for (size_t c = 0; c < static_cast<size_t>(picture.channels); ++c)
      most = std::max<int>(most, picture.planes[c].at(p.x, p.y));
    ++points;
    bright += most > level;
    lit += most >= kLit;
    dim += most > kBlack && most <= level;
  });
  const bool isOnBlack = 500 * lit >= points && dim <= lit;
  return 50 * bright <= points && !isOnBlack;
}

bool hasSwitchedColour(const SmoothPicture& picture, const ConsensusBackground& model) {
  if (picture.channels == 1) return false;
  int points = 0, now = 0, before = 0;
  forGrid(picture.size(), 0, [&](Point p) {
    ++points;
    now += isVivid(picture.planes[0].at(p.x, p.y), picture.planes[1].at(p.x, p.y),
                   picture.planes[2].at(p.x, p.y));
    before += isVivid(model.sample(p, 0, 0), model.sample(p, 0, 1), model.sample(p, 0, 2));
  });
  const auto [less, more] = std::minmax(now, before);
  return 50 * less <= points && 10 * more >= points;
}

Point findShift(const SmoothPicture& picture, const ConsensusBackground& model) {
  constexpr int kSide = 2 * kMostShift + 1;
  std::array<int64_t, kSide * kSide> off{};
  forGrid(picture.size(), kMostShift, [&](Point p) {
    const int there = modelled(model, p);
    size_t i = 0;
    for (int y = -kMostShift; y <= kMostShift; ++y) {
      const uint8_t* row = picture.planes[0].row(p.y - y) + p.x;
      for (int x = -kMostShift; x <= kMostShift; ++x)
        off[i++] += std::min(kMostOff, absDiff(row[-x], there));
    }
  });
  const int64_t unmoved = off[off.size() / 2];
  std::tuple<int64_t, int, int, int> best{unmoved, 0, 0, 0};
  for (size_t i = 0; i < off.size(); ++i) {
    const int x = static_cast<int>(i) % kSide - kMostShift;
    const int y = static_cast<int>(i) / kSide - kMostShift;
    best = std::min(best, {off[i], x * x + y * y, y, x});
  }
  const auto [least, distance, y, x] = best;
  return 4 * least <= 3 * unmoved ? Point{x, y} : Point{};
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

bool isEverywhere(const BitMask& raw) {
  int full = 0;
  for (int row = 0; row < kFields; ++row)
    for (int column = 0; column < kFields; ++column) {
      const int top = raw.height() * row / kFields, bottom = raw.height() * (row + 1) / kFields;
      const int left = raw.width() * column / kFields;
      const int right = raw.width() * (column + 1) / kFields;
      int64_t set = 0;
      for (int y = top; y < bottom; ++y) set += countColumns(raw.row(y), left, right);
      full += 8 * set >= int64_t{bottom - top} * (right - left);
    }
  return 4 * full >= 3 * kFields * kFields;
}

}  // namespace rg::background
