// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/looks/appearance.hpp"

#include <algorithm>
#include <numeric>

namespace rg::objects {
namespace {

/// ⌊a / chroma⌋ = a · kReciprocals[chroma] >> kReciprocalBits for a < 2^13: what is added to the
/// exact product is then less than 2^kReciprocalBits / chroma.
constexpr int kReciprocalBits = 21;
constexpr auto kReciprocals = [] {
  std::array<uint32_t, 256> table{};
  for (uint32_t i = 1; i < table.size(); ++i) table[i] = ((1u << kReciprocalBits) + i - 1) / i;
  return table;
}();

}  // namespace

uint8_t colourBin(int red, int green, int blue) {
  constexpr int kHues = 12, kGreyFrom = 24;
  const int high = std::max({red, green, blue}), low = std::min({red, green, blue});
  const int chroma = high - low;
  // Below this the hue is noise: an eighth of the value, at least 12 levels.
  if (chroma < 12 || 8 * chroma < high) return static_cast<uint8_t>(kGreyFrom + high / 32);
  // Hue as 0 … 6 chroma around the circle, red in the middle of bin 0.
  int hue = high == red     ? green - blue
            : high == green ? 2 * chroma + blue - red
                            : 4 * chroma + red - green;
  hue = 2 * hue + chroma / 2;
  if (hue < 0) hue += kHues * chroma;
  const auto bin = static_cast<int>(
      static_cast<uint32_t>(hue) * kReciprocals[static_cast<size_t>(chroma)] >> kReciprocalBits);
  const int isStrong = 3 * chroma > high;
  return static_cast<uint8_t>(bin * 2 + isStrong);
}

void learn(Look& look, const LookCounts& counts) {
  const uint32_t weight = std::min(look.frames, 7u);
  bool hasSamples = false;
  for (size_t band = 0; band < kBodyBands; ++band) {
    const auto& bins = counts.bins[band];
    const uint64_t total = std::accumulate(bins.begin(), bins.end(), uint64_t{0});
    if (total == 0) continue;
    hasSamples = true;
    auto& shares = look.shares[band];
    const bool isEmpty = std::all_of(shares.begin(), shares.end(), [](uint16_t s) { return !s; });
    for (size_t i = 0; i < kColourBins; ++i) {
      const auto share =
          static_cast<uint32_t>((uint64_t{bins[i]} * kFullMatch + total / 2) / total);
      shares[i] = static_cast<uint16_t>(
          isEmpty ? share : (shares[i] * weight + share + (weight + 1) / 2) / (weight + 1));
    }
  }
  look.frames += hasSamples && look.frames < 1000;
}

int similarity(const Look& a, const Look& b) {
  int bands = 0, sum = 0;
  for (size_t band = 0; band < kBodyBands; ++band) {
    int common = 0, ofA = 0, ofB = 0;
    for (size_t i = 0; i < kColourBins; ++i) {
      const int p = a.shares[band][i], q = b.shares[band][i];
      common += std::min(p, q);
      ofA += p;
      ofB += q;
    }
    if (ofA == 0 || ofB == 0) continue;
    sum += std::min(common, kFullMatch);
    ++bands;
  }
  return bands > 0 ? sum / bands : kFullMatch / 2;
}

int shareOf(const Look& look, int bin) {
  int sum = 0;
  for (const auto& shares : look.shares) sum += shares[static_cast<size_t>(bin)];
  return sum / kBodyBands;
}

}  // namespace rg::objects
