// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/row_spans.hpp"

#include <algorithm>

namespace rg {

void keepInside(ImageView<const uint8_t> interest, ImageView<uint8_t> scope) {
  for (int y = 0; y < scope.height(); ++y) {
    const uint8_t* isInside = interest.row(y);
    uint8_t* row = scope.row(y);
    for (int x = 0; x < scope.width(); ++x) row[x] = row[x] & isInside[x];
  }
}

void RowSpans::find(Size size, ImageView<const uint8_t> scope, const Executor& executor) {
  size_ = size;
  spans_.assign(static_cast<size_t>(size.height), Span{0, size.width});
  if (scope.data == nullptr) return;
  executor.forRows(size.height, [&](int firstRow, int lastRow) {
    for (int y = firstRow; y < lastRow; ++y) {
      const uint8_t* row = scope.row(y);
      const uint8_t* end = row + size.width;
      const uint8_t* first = std::find_if(row, end, isInScope);
      const uint8_t* last = end;
      while (last != first && !isInScope(last[-1])) --last;
      spans_[static_cast<size_t>(y)] = {static_cast<int>(first - row),
                                        static_cast<int>(last - row)};
    }
  });
}

Span RowSpans::hull(int first, int last) const {
  Span result{size_.width, 0};
  for (int y = std::max(first, 0); y < std::min(last, size_.height); ++y) {
    const Span row = of(y);
    if (row.count() == 0) continue;
    result = {std::min(result.first, row.first), std::max(result.last, row.last)};
  }
  return result;
}

}  // namespace rg
