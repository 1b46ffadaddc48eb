// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/accuracy/copies.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cmath>

namespace rg::truth {
namespace {

constexpr Copy kCopies[] = {
    {},
    {.name = "brighter", .brighter = 3},
    {.name = "darker", .brighter = -3},
    {.name = "flatter", .contrastPercent = 98},
    {.name = "harder", .contrastPercent = 102},
    {.name = "paler", .saturationPercent = 90},
    {.name = "noisier", .noise = 1.5},
    {.name = "half-rate", .every = 2},
    {.name = "half-size", .isHalved = true},
};

/// Each pixel is the mean of four; an odd last row or column is left out.
void halve(bench::RawFrame& frame) {
  const Size from = frame.layout.size, to{from.width / 2, from.height / 2};
  const auto at = [&](int x, int y, int channel) -> int {
    return frame
        .bytes[3 * static_cast<size_t>(int64_t{y} * from.width + x) + static_cast<size_t>(channel)];
  };
  std::vector<uint8_t> bytes;
  bytes.reserve(3 * static_cast<size_t>(to.area()));
  for (int y = 0; y < 2 * to.height; y += 2)
    for (int x = 0; x < 2 * to.width; x += 2)
      for (int c = 0; c < 3; ++c) {
        const int sum = at(x, y, c) + at(x + 1, y, c) + at(x, y + 1, c) + at(x + 1, y + 1, c);
        bytes.push_back(static_cast<uint8_t>((sum + 2) / 4));
      }
  frame.layout.size = to;
  frame.bytes = std::move(bytes);
}

/// Nearly normal with deviation 1: the sum of four numbers that are even.
double noiseAt(size_t pixel, size_t channel, uint64_t number) {
  const uint32_t bits = mixHash(static_cast<uint32_t>(pixel), static_cast<uint32_t>(number),
                                static_cast<uint32_t>(channel));
  double sum = 0;
  for (int shift = 0; shift < 32; shift += 8) sum += (bits >> shift & 255) / 255.0 - 0.5;
  return sum * std::sqrt(3.0);
}

}  // namespace

std::span<const Copy> copies() {
  return kCopies;
}

void change(const Copy& copy, uint64_t number, bench::RawFrame& frame) {
  if (copy.isHalved) halve(frame);
  if (copy.brighter == 0 && copy.contrastPercent == 100 && copy.saturationPercent == 100 &&
      copy.noise == 0)
    return;
  for (size_t i = 0; i + 3 <= frame.bytes.size(); i += 3) {
    uint8_t* pixel = frame.bytes.data() + i;
    const double grey = (pixel[0] + pixel[1] + pixel[2]) / 3.0;
    for (size_t c = 0; c < 3; ++c) {
      const double pale = grey + (pixel[c] - grey) * copy.saturationPercent / 100;
      const double flat = 128 + (pale - 128) * copy.contrastPercent / 100 + copy.brighter;
      const double noisy = flat + (copy.noise > 0 ? copy.noise * noiseAt(i, c, number) : 0);
      pixel[c] = static_cast<uint8_t>(std::clamp(std::lround(noisy), 0L, 255L));
    }
  }
}

}  // namespace rg::truth
