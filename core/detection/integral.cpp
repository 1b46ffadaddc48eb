// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/integral.hpp"

#include <algorithm>
#include <cassert>

namespace rg::detection {
namespace {

/// 65025 · 16384 < 2^32: a row's squares fit.
void sumRow(const uint8_t* pixels, int count, const Integrals& to, Point at) {
  const uint32_t* above = to.sums.row(at.y - 1) + at.x;
  const double* squaresAbove = to.squares.row(at.y - 1) + at.x;
  uint32_t* sums = to.sums.row(at.y) + at.x;
  double* squares = to.squares.row(at.y) + at.x;
  uint32_t sum = 0, squared = 0;
  sums[0] = 0;
  squares[0] = 0;
  for (int x = 0; x < count; ++x) {
    const uint32_t level = pixels[x];
    sum += level;
    squared += level * level;
    sums[x + 1] = above[x + 1] + sum;
    squares[x + 1] = squaresAbove[x + 1] + static_cast<double>(squared);
  }
}

}  // namespace

void sumArea(ImageView<const uint8_t> luma, const Box& area, const Integrals& to) {
  assert(intersect(area, boundsOf(luma.size)) == area);
  std::fill_n(to.sums.row(area.y) + area.x, area.width + 1, 0U);
  std::fill_n(to.squares.row(area.y) + area.x, area.width + 1, 0.0);
  for (int y = area.y; y < area.bottom(); ++y)
    sumRow(luma.row(y) + area.x, area.width, to, {area.x, y + 1});
}

void sumIntegrals(ImageView<const uint8_t> luma, const Integrals& to) {
  sumArea(luma, boundsOf(luma.size), to);
}

}  // namespace rg::detection
