// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/memory/result_plane.hpp"

#include "core/base/memory/spare.hpp"
#include "core/simd/base/run_rows.hpp"

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>

namespace rg {
namespace {

/// Labels as they lie; bytes widened into `row`.
const uint16_t* wideRow(const uint16_t* pixels, int, std::vector<uint16_t>&) {
  return pixels;
}
const uint16_t* wideRow(const uint8_t* pixels, int width, std::vector<uint16_t>& row) {
  row.assign(pixels, pixels + width);
  return row.data();
}

}  // namespace

template <class T>
void PlanePacker::pack(const ResultPlane<T>& from, ResultPlane<T>& to, Size shown) {
  assert(!from.isPacked() && std::max(from.width(), shown.width) <= UINT16_MAX);
  to.isPacked_ = true;
  to.size_ = from.size().isEmpty() ? from.size() : shown;
  if (from.size() != doubled(to.size_)) return packView(from.view(), to);
  auto& half = std::get<Image<T>>(halves_);
  half.resize(to.size_);
  for (int y = 0; y < half.height(); ++y)
    halveRows(from.row(2 * y), from.row(2 * y + 1), half.width(), half.row(y));
  packView(std::as_const(half).view(), to);
}

template <class T>
void PlanePacker::packView(ImageView<const T> from, ResultPlane<T>& to) {
  if (packRows(from, to)) {
    to.whole_ = {};
    giveBackSpare(to.begins_);
    giveBackSpare(to.values_);
    giveBackSpare(to.starts_);
  } else {
    to.whole_.copyFrom(from);
    to.starts_ = {};
    to.begins_ = {};
    to.values_ = {};
  }
}

/// False where the plane itself takes less.
template <class T>
bool PlanePacker::packRows(ImageView<const T> from, ResultPlane<T>& to) {
  const auto width = static_cast<size_t>(from.width());
  const size_t most =
      width * static_cast<size_t>(from.height()) * sizeof(T) / (sizeof(T) + sizeof(uint16_t));
  const FrameMap map{from.size, to.size_};
  const bool isScaled = map.from != map.to;
  begins_.resize(width + 1);
  to.starts_.assign(1, 0);
  to.begins_.clear();
  to.values_.clear();
  for (int y = 0; y < from.height(); ++y) {
    const T* pixels = from.row(y);
    const int runs =
        simd::findRuns(wideRow(pixels, from.width(), row_), from.width(), begins_.data());
    const std::span<const uint16_t> begins(begins_.data(), static_cast<size_t>(runs));
    if (to.begins_.size() + begins.size() > most) return false;
    for (const uint16_t begin : begins)
      to.begins_.push_back(isScaled ? static_cast<uint16_t>(map.firstX(begin)) : begin);
    for (const uint16_t begin : begins) to.values_.push_back(pixels[begin]);
    to.starts_.push_back(static_cast<uint32_t>(to.begins_.size()));
  }
  return true;
}

template void PlanePacker::pack(const ResultPlane<uint8_t>& from, ResultPlane<uint8_t>& to,
                                Size shown);
template void PlanePacker::pack(const ResultPlane<uint16_t>& from, ResultPlane<uint16_t>& to,
                                Size shown);

}  // namespace rg
