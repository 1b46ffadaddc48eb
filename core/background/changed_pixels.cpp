// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/changed_pixels.hpp"

#include "core/simd/background/difference_rows.hpp"

#include <array>

namespace rg::background {
namespace {

RowPair rowPairAt(const ColourPlanes& a, const ColourPlanes& b, const Run& at) {
  const auto rows = [&](const ColourPlanes& planes) -> std::array<const uint8_t*, 3> {
    return {planes.green.row(at.y) + at.begin, planes.red.row(at.y) + at.begin,
            planes.blue.row(at.y) + at.begin};
  };
  const bool isGrey = a.red.data == a.green.data || b.red.data == b.green.data;
  return {rows(a), rows(b), isGrey ? 1 : 3, at.end - at.begin};
}

}  // namespace

ColourPlanes planesOf(const Picture& picture) {
  return {picture.red(), picture.green(), picture.blue()};
}

ImageView<const uint8_t> everyRow(ImageView<const uint8_t> plane, int first, int step) {
  const int rows = (plane.height() - first + step - 1) / step;
  return {plane.row(first), {plane.width(), rows}, plane.strideBytes * step};
}

ColourPlanes everyRow(const ColourPlanes& planes, int first, int step) {
  return {everyRow(planes.red, first, step), everyRow(planes.green, first, step),
          everyRow(planes.blue, first, step)};
}

void measureChange(const ColourPlanes& a, const ColourPlanes& b, const Run& at, uint8_t* out) {
  simd::measureDistances(rowPairAt(a, b, at), out);
}

void markChange(const ColourPlanes& a, const ColourPlanes& b, const Run& at, int threshold,
                uint8_t* out) {
  simd::markFar(rowPairAt(a, b, at), static_cast<uint8_t>(threshold), out);
}

void addStrange(const ColourPlanes& a, const ColourPlanes& b, const Run& at, int threshold,
                const uint8_t* isKnown, uint8_t* out) {
  simd::addFar(rowPairAt(a, b, at), static_cast<uint8_t>(threshold), isKnown, out);
}

void keepDense(const uint8_t* above, const uint8_t* row, const uint8_t* below, const Run& at,
               uint8_t* out) {
  simd::keepDense({above + at.begin, row + at.begin, below + at.begin}, at.end - at.begin,
                  out + at.begin);
}

}  // namespace rg::background
