// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/changed_pixels.hpp"

#include <algorithm>
#include <array>

namespace rg {
namespace {

/// The pixels of a segment in both pictures.
struct Pairs {
  std::array<const uint8_t*, 3> a, b;
  int count;
  bool isGrey;
};

Pairs pairsAt(const ColourPlanes& a, const ColourPlanes& b, const Segment& at) {
  const auto rows = [&](const ColourPlanes& planes) -> std::array<const uint8_t*, 3> {
    return {planes.green.row(at.y) + at.first, planes.red.row(at.y) + at.first,
            planes.blue.row(at.y) + at.first};
  };
  return {rows(a), rows(b), at.last - at.first,
          a.red.data == a.green.data || b.red.data == b.green.data};
}

constexpr uint8_t distance(uint8_t a, uint8_t b) {
  return static_cast<uint8_t>(std::max(a, b) - std::min(a, b));
}

/// Calls write(x, difference); the loops are branchless, so that compilers vectorise them.
template <class Write>
void forDifferences(const Pairs& pairs, Write write) {
  const auto [a0, a1, a2] = pairs.a;
  const auto [b0, b1, b2] = pairs.b;
  if (pairs.isGrey)
    for (int x = 0; x < pairs.count; ++x) write(x, distance(a0[x], b0[x]));
  else
    for (int x = 0; x < pairs.count; ++x)
      write(x, std::max(std::max(distance(a0[x], b0[x]), distance(a1[x], b1[x])),
                        distance(a2[x], b2[x])));
}

constexpr uint8_t allBitsIf(bool isSet) {
  return static_cast<uint8_t>(isSet ? 255 : 0);
}

}  // namespace

ColourPlanes planesOf(const Picture& picture) {
  return {picture.red(), picture.green(), picture.blue()};
}

ColourPlanes everyRow(const ColourPlanes& planes, int first, int step) {
  const auto thin = [&](ImageView<const uint8_t> plane) -> ImageView<const uint8_t> {
    const int rows = (plane.height() - first + step - 1) / step;
    return {plane.row(first), {plane.width(), rows}, plane.strideBytes * step};
  };
  return {thin(planes.red), thin(planes.green), thin(planes.blue)};
}

void measureChange(const ColourPlanes& a, const ColourPlanes& b, const Segment& at, uint8_t* out) {
  forDifferences(pairsAt(a, b, at), [out](int x, uint8_t difference) { out[x] = difference; });
}

void markChange(const ColourPlanes& a, const ColourPlanes& b, const Segment& at, int threshold,
                uint8_t* out) {
  const auto limit = static_cast<uint8_t>(threshold);
  forDifferences(pairsAt(a, b, at), [out, limit](int x, uint8_t difference) {
    out[x] = allBitsIf(difference > limit);
  });
}

void addStrange(const ColourPlanes& a, const ColourPlanes& b, const Segment& at, int threshold,
                const uint8_t* isKnown, uint8_t* out) {
  const auto limit = static_cast<uint8_t>(threshold);
  forDifferences(pairsAt(a, b, at), [=](int x, uint8_t difference) {
    out[x] = static_cast<uint8_t>(out[x] | (allBitsIf(difference > limit) & isKnown[x]));
  });
}

void keepDense(const uint8_t* above, const uint8_t* row, const uint8_t* below, const Segment& at,
               uint8_t* out) {
  constexpr int kLeast = 4;
  const auto column = [&](int x) { return (above[x] & 1) + (row[x] & 1) + (below[x] & 1); };
  for (int x = at.first; x < at.last; ++x) {
    const auto count = static_cast<uint8_t>(column(x - 1) + column(x) + column(x + 1));
    out[x] = allBitsIf(count >= kLeast);
  }
}

}  // namespace rg
