// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/padded_luma.hpp"

#include "core/simd/motion_rows.hpp"

#include <algorithm>
#include <cstring>
#include <span>

namespace rg {
namespace {

void padRow(const uint8_t* from, int width, int before, std::span<uint8_t> to) {
  std::memset(to.data(), from[0], static_cast<size_t>(before));
  std::memcpy(to.data() + before, from, static_cast<size_t>(width));
  const auto end = static_cast<size_t>(before + width);
  std::memset(to.data() + end, from[width - 1], to.size() - end);
}

}  // namespace

void PaddedLuma::build(ImageView<const uint8_t> luma, int reach, const Executor& executor) {
  reach_ = reach;
  rows_.resize({luma.width() + 2 * reach + kSlack, luma.height() + 2 * reach});
  executor.forRows(rows_.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y)
      padRow(luma.row(std::clamp(y - reach, 0, luma.height() - 1)), luma.width(), reach,
             {rows_.row(y), static_cast<size_t>(rows_.width())});
  });
}

void BoxSums::build(const PaddedLuma& luma, const Executor& executor) {
  const ImageView<const uint8_t> from = luma.rows();
  reach_ = luma.reach();
  rows_.resize(from.size);
  const int last = from.height() - kBoxSide, columns = from.width() - kBoxSide + 1;
  executor.forRows(from.height(), [&](int first, int end) {
    for (int y = first; y < end; ++y) {
      uint16_t* to = rows_.row(y);
      if (y <= last)
        simd::sumBoxRow({{from.row(y), from.row(y + 1), from.row(y + 2), from.row(y + 3)}}, columns,
                        to);
      const int summed = y <= last ? columns : 0;
      std::fill_n(to + summed, from.width() - summed, uint16_t{0});
    }
  });
}

}  // namespace rg
