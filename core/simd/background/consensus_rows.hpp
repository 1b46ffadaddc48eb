// SPDX-License-Identifier: LGPL-2.1-or-later
// The hot loops of core/background/models/consensus_background.hpp over one row, by the widest
// instructions there are.
//
// The same bits on every target. plain:: is the reference that the tests compare with.
// Rows must be readable and writable up to the next multiple of 64 columns, as an Image's are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace rg::background {

/// Three rows of a plane: the one above, the row itself, the one below.
struct RowsAround {
  const uint8_t *above, *here, *below;
  int width;
};

/// A row of the picture and of its model: channel c of sample k of the columns 64 i … 64 i + 63 is
/// at samples + 64 ((i · sampleCount + k) · channels + c).
struct ModelRow {
  std::array<const uint8_t*, 3> pixels;
  const uint8_t* samples;
  int channels;  ///< 1 or 3.
  int sampleCount;
  int width;
};

/// What the distance is compared with: least + brightness · pixel / 256 + noise / 4 + unrest / 16,
/// at most 255.
struct RadiusRow {
  const uint8_t *noise, *unrest;
  uint8_t least, brightness;
};
/// 7/8 of a radius, rounded down, so that small ones differ too.
[[nodiscard]] constexpr int faintRadius(int radius) {
  return radius - ((radius < 248 ? radius + 7 : 255) >> 3);
}
/// What counts as far: 2.5 times the radius, but never the largest distance.
[[nodiscard]] constexpr int farRadius(int radius) {
  return 5 * radius / 2 < 254 ? 5 * radius / 2 : 254;
}
[[nodiscard]] constexpr int radiusOf(int tolerance, int noise, int unrest) {
  const int sum = tolerance + (noise >> 2) + (unrest >> 4);
  return sum < 255 ? sum : 255;
}
[[nodiscard]] constexpr int radiusAt(const RadiusRow& radius, uint8_t pixel, int x) {
  return radiusOf(radius.least + (pixel * radius.brightness >> 8), radius.noise[x],
                  radius.unrest[x]);
}

/// Where fewer than two samples are within the radius, 2.5 times the radius, 7/8 of it.
struct VerdictRow {
  uint64_t *raw, *strong, *faint;
};

/// Noise follows the distance to the nearest sample where `kept` is 0.
struct NoiseRow {
  uint8_t* noise;  ///< 1/8 grey level.
  const uint64_t* kept;
};

namespace plain {
void smoothRow(const RowsAround& in, uint8_t* out);
void judgeRow(const ModelRow& row, const RadiusRow& radius, const VerdictRow& out);
void followNoiseRow(const ModelRow& row, const NoiseRow& noise);
void meanOfFour(const uint8_t* first, ptrdiff_t step, uint8_t* out);

/// The columns begin … end − 1 of smoothRow.
void smoothColumns(const RowsAround& in, int begin, int end, uint8_t* out);
/// Unsets the bits beyond the row's end.
void clearBeyond(int width, const VerdictRow& out);
}  // namespace plain

namespace simd {
/// 3x3 (1 2 1) / 16, rounded; the row's ends are repeated.
void smoothRow(const RowsAround& in, uint8_t* out);
void judgeRow(const ModelRow& row, const RadiusRow& radius, const VerdictRow& out);
/// A quarter of the way, rounded away from the old value; distances count up to 31.
void followNoiseRow(const ModelRow& row, const NoiseRow& noise);
/// The mean, rounded down, of 64 columns at first, first + step, first + 2 step and first + 3 step.
void meanOfFour(const uint8_t* first, ptrdiff_t step, uint8_t* out);
}  // namespace simd

}  // namespace rg::background
