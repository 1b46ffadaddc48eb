// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/padded_luma.hpp"

#include "core/simd/base/motion_rows.hpp"

#include <algorithm>
#include <cstring>

namespace rg::motion {
namespace {

/// At least `width`, for rows of an odd number of cache lines: the pixels of a column, which the
/// search looks at together, don't contend for the same places of a cache then.
int spreadWidth(int width, size_t pixelBytes) {
  constexpr size_t kLine = 64;
  const size_t lines = (static_cast<size_t>(width) * pixelBytes + kLine - 1) / kLine;
  return static_cast<int>((lines | 1) * kLine / pixelBytes);
}

}  // namespace

/// fillRow(y, to) writes row y of the picture.
template <class FillRow>
void PaddedLuma::fill(Size size, int reach, const Executor& executor, const FillRow& fillRow) {
  reach_ = reach;
  size_ = size;
  const int width = spreadWidth(size.width + 2 * reach + kSlack, 1);
  rows_.resize({width, size.height + 2 * reach});
  const auto before = static_cast<size_t>(reach);
  const auto after = static_cast<size_t>(width - reach - size.width);
  executor.forRows(rows_.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      uint8_t* row = rows_.row(y) + reach;
      fillRow(std::clamp(y - reach, 0, size.height - 1), row);
      std::memset(row - reach, row[0], before);
      std::memset(row + size.width, row[size.width - 1], after);
    }
  });
}

void PaddedLuma::build(ImageView<const uint8_t> luma, int reach, const Executor& executor) {
  fill(luma.size, reach, executor, [&](int y, uint8_t* to) {
    std::memcpy(to, luma.row(y), static_cast<size_t>(luma.width()));
  });
}

void PaddedLuma::buildSmooth(ImageView<const uint8_t> luma, int reach, const Executor& executor) {
  fill(luma.size, reach, executor, [&](int y, uint8_t* to) {
    const rg::simd::ThreeRows rows{luma.row(std::max(y - 1, 0)), luma.row(y),
                                   luma.row(std::min(y + 1, luma.height() - 1))};
    rg::simd::smoothRow(rows, luma.width(), to);
  });
}

void BoxSums::build(const PaddedLuma& luma, const Executor& executor) {
  const ImageView<const uint8_t> from = luma.rows();
  reach_ = luma.reach();
  rows_.resize({spreadWidth(from.width(), sizeof(uint16_t)), from.height()});
  const int last = from.height() - kBoxSide, columns = from.width() - kBoxSide + 1;
  executor.forRows(from.height(), [&](int first, int end) {
    for (int y = first; y < end; ++y) {
      uint16_t* to = rows_.row(y);
      if (y <= last)
        rg::simd::sumBoxRow({{from.row(y), from.row(y + 1), from.row(y + 2), from.row(y + 3)}},
                            columns, to);
      const int summed = y <= last ? columns : 0;
      std::fill_n(to + summed, from.width() - summed, uint16_t{0});
    }
  });
}

}  // namespace rg::motion
