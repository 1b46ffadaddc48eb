// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/hue_decision.hpp"

#include "core/base/row_spans.hpp"
#include "core/segmentation/colour_links.hpp"
#include "core/simd/segmentation/link_rows.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

namespace rg::segmentation {
namespace {

constexpr double kDegrees = 360;

HueBand widen(const HueBand& band, int margin) {
  if (band.count == 0) return band;
  const int first = band.first - margin;
  return {first < 0 ? first + kHueCount : first, std::min(band.count + 2 * margin, kHueCount)};
}

/// Object against background pixels of the 3x3 around each; of equal numbers the pixel's own class
/// stays.
void settleRow(const Image<uint8_t>& raw, int y, ImageView<const uint8_t> scope, uint8_t* out) {
  const int width = raw.width();
  const uint8_t* rows[] = {raw.row(std::max(y - 1, 0)), raw.row(y),
                           raw.row(std::min(y + 1, raw.height() - 1))};
  const auto column = [&](int x) {
    int votes = 0;
    for (const uint8_t* row : rows) votes += row[x] == kNoHue ? 0 : row[x] == kObjectHue ? 1 : -1;
    return votes;
  };
  const uint8_t* isIn = scope.data ? scope.row(y) : nullptr;
  int left = column(0), middle = left;
  for (int x = 0; x < width; ++x) {
    const int right = column(std::min(x + 1, width - 1));
    const int votes = left + middle + right;
    left = middle;
    middle = right;
    out[x] = isIn && !isInScope(isIn[x]) ? kBackgroundHue : settledClass(rows[1][x], votes);
  }
}

/// Of every fourth pixel of a row: `samples` of them.
void countHues(const Picture& picture, int y, int samples, HueHistogram& histogram) {
  constexpr int kBlock = 256;
  const uint8_t* rows[] = {picture.red().row(y), picture.green().row(y), picture.blue().row(y)};
  uint8_t colours[3][kBlock];
  int16_t hues[kBlock];
  for (int first = 0; first < samples; first += kBlock) {
    const int count = std::min(samples - first, kBlock);
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < count; ++i) colours[c][i] = rows[c][(first + i) * kHueSampleStep];
    simd::findHueRow(colours[0], colours[1], colours[2], count, {}, hues);
    for (int i = 0; i < count; ++i)
      if (hues[i] != kAchromatic) ++histogram[static_cast<size_t>(hues[i])];
  }
}

bool readDegrees(std::string_view text, double& to) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), to);
  return error == std::errc{} && end == text.data() + text.size() && to >= 0 && to <= kDegrees;
}

Error noBand(std::string_view text) {
  std::string message(text.substr(0, 80));
  message +=
      " is no range of hues: write it as FROM-TO in degrees from 0 to 360, as in 90-150 for "
      "green or 350-10 for red";
  return {std::move(message)};
}

}  // namespace

HueBands bandsOf(const HueRules& rules, const HueBand& peak) {
  switch (rules.background) {
    case BackgroundHue::Given:
      return {rules.backgroundBand, rules.objectBand};
    case BackgroundHue::FromPeak:
      return {widen(peak, kHueGuard), rules.objectBand};
    default:
      return {{}, rules.objectBand};
  }
}

HueBand findFrameBand(const Picture& picture, const Executor& executor) {
  if (picture.isGrey()) return {};
  const auto samples = [](int length) { return (length + kHueSampleStep - 1) / kHueSampleStep; };
  const Size size{samples(picture.size().width), samples(picture.size().height)};
  HueHistogram total{};
  std::mutex mutex;  // Protects `total`; nothing is called while it is held.
  executor.forRows(size.height, [&](int first, int last) {
    HueHistogram own{};
    for (int y = first; y < last; ++y) countHues(picture, y * kHueSampleStep, size.width, own);
    const std::lock_guard lock(mutex);
    for (size_t i = 0; i < total.size(); ++i) total[i] += own[i];
  });
  return findBackgroundBand(total, static_cast<uint64_t>(size.area()));
}

Result<HueBand> parseHueBand(std::string_view text) {
  if (text.empty()) return HueBand{};
  const size_t dash = text.find('-');
  double from = 0, to = 0;
  if (dash == std::string_view::npos || !readDegrees(text.substr(0, dash), from) ||
      !readDegrees(text.substr(dash + 1), to))
    return noBand(text);
  const auto first = static_cast<int>(std::lround(from / kDegrees * kHueCount)) % kHueCount;
  const auto last = static_cast<int>(std::lround(to / kDegrees * kHueCount));
  const int count = (last - first + kHueCount) % kHueCount;
  return HueBand{first, to - from >= kDegrees ? kHueCount : count + 1};
}

Result<HueRules> parseHueRules(std::string_view background, std::string_view object) {
  HueRules rules;
  const bool isFromPeak = background == "auto";
  const auto given = parseHueBand(isFromPeak ? std::string_view{} : background);
  if (!given) return Error{"background-hue: " + given.error().message + ", or auto"};
  const auto wanted = parseHueBand(object);
  if (!wanted) return Error{"object-hue: " + wanted.error().message};
  if (!background.empty())
    rules.background = isFromPeak ? BackgroundHue::FromPeak : BackgroundHue::Given;
  rules.backgroundBand = *given;
  rules.objectBand = *wanted;
  return rules;
}

void classifyHues(const Picture& picture, const HueRules& rules, const HueBand& peak,
                  ImageView<const uint8_t> scope, const Executor& executor, Image<uint8_t>& raw,
                  ImageView<uint8_t> classes) {
  const HueBands bands = bandsOf(rules, peak);
  raw.resize(picture.size());
  const int width = raw.width();
  // Only what is looked at is converted.
  const auto isNear = [&](int y) {
    return !scope.data || std::any_of(scope.row(y), scope.row(y) + width, isInScope);
  };
  executor.forRows(raw.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      uint8_t* out = raw.row(y);
      std::fill_n(out, width, kNoHue);
      if (!isNear(y)) continue;
      const uint8_t *red = picture.red().row(y), *green = picture.green().row(y),
                    *blue = picture.blue().row(y);
      const uint8_t* isIn = scope.data ? scope.row(y) : nullptr;
      for (int x = 0; x < width; ++x)
        if (!isIn || isInScope(isIn[x])) out[x] = bands.classOf(hueOf(red[x], green[x], blue[x]));
    }
  });
  executor.forRows(raw.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) settleRow(raw, y, scope, classes.row(y));
  });
}

}  // namespace rg::segmentation
