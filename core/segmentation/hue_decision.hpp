// SPDX-License-Identifier: LGPL-2.1-or-later
// Hue as a decision (paper, section 2.2.2): pixels whose hue lies in a band round the background's
// hue belong to the background, those of another hue to objects. The intensity has no say, so that
// light and shadow change nothing. Pixels without a colour are told apart: other evidence decides.
//
// Determinism: integers; the band comes from counts, a pixel's class from its 3x3 neighbours.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"
#include "core/base/result.hpp"
#include "core/segmentation/hue.hpp"

#include <cstdint>
#include <string_view>

namespace rg::segmentation {

/// Values of a hue mask.
inline constexpr uint8_t kBackgroundHue = 0;
inline constexpr uint8_t kNoHue = 128;
inline constexpr uint8_t kObjectHue = 255;

/// Whether a pixel of this class is divided into regions; isForeground: other evidence says so.
[[nodiscard]] constexpr bool isWanted(uint8_t hueClass, bool isForeground) {
  return hueClass == kObjectHue || (hueClass == kNoHue && isForeground);
}

enum class BackgroundHue : uint8_t {
  Ignored,   ///< The background's hue decides nothing.
  FromPeak,  ///< The band round the peak of the frame's hue histogram.
  Given,     ///< HueRules::backgroundBand.
};

struct HueRules {
  BackgroundHue background = BackgroundHue::Ignored;
  HueBand backgroundBand;
  HueBand objectBand;  ///< Only these hues are objects; none: all but the background's.

  [[nodiscard]] bool decide() const {
    return background != BackgroundHue::Ignored || objectBand.count > 0;
  }
};

/// What hue alone says of a pixel, for it lies in these bands or not.
struct HueBands {
  HueBand background, objects;

  [[nodiscard]] constexpr uint8_t classOf(int hue) const {
    if (hue == kAchromatic) return kNoHue;
    const bool isObject =
        !background.contains(hue) && (objects.count == 0 || objects.contains(hue));
    return isObject ? kObjectHue : kBackgroundHue;
  }
};
[[nodiscard]] HueBands bandsOf(const HueRules& rules, const HueBand& peak);

/// The class of a pixel of the class `own` in whose 3x3 `votes` more are of an object than of the
/// background.
[[nodiscard]] constexpr uint8_t settledClass(uint8_t own, int votes) {
  if (own == kNoHue || votes == 0) return own;
  return votes > 0 ? kObjectHue : kBackgroundHue;
}

inline constexpr int kHueSampleStep = 4;
/// The band of the background's hues: that of the histogram of every fourth pixel of every fourth
/// row, of the whole frame whatever part of it is looked at.
[[nodiscard]] HueBand findFrameBand(const Picture& picture, const Executor& executor);

/// Reads "FROM-TO", degrees of the colour circle from 0 (red) over 120 (green) and 240 (blue) to
/// 360; FROM may be the larger one: 350-10 lies round red. Empty text: no band.
[[nodiscard]] Result<HueBand> parseHueBand(std::string_view text);

/// Reads both properties of hsvsegment: `background` may also be empty (Ignored) or "auto".
[[nodiscard]] Result<HueRules> parseHueRules(std::string_view background, std::string_view object);

/// Writes the class of every pixel in scope (core/base/row_spans.hpp; all, where it has no data),
/// else kBackgroundHue. `peak`: what findFrameBand() says; widened by kHueGuard on both sides,
/// since noise turns the hue of dark pixels. A pixel is of an object when most chromatic ones of
/// its 3x3 are.
void classifyHues(const Picture& picture, const HueRules& rules, const HueBand& peak,
                  ImageView<const uint8_t> scope, const Executor& executor, Image<uint8_t>& raw,
                  ImageView<uint8_t> classes);

}  // namespace rg::segmentation
