// SPDX-License-Identifier: LGPL-2.1-or-later
// The paper's figures 18 and 19 as lines of JSON: how many search windows pictures have, and which
// scale a window's id stands for, by the table, by equation (2) as printed and refitted.
#include "core/detection/detection.hpp"

#include <array>
#include <cstdio>

namespace rg {
namespace {

using detection::PaperWindows;

/// The paper's sizes, and the two that its text and figures confuse.
constexpr std::array kSizes{Size{100, 100}, Size{120, 160}, Size{200, 200}, Size{400, 400},
                            Size{460, 480}, Size{640, 480}, Size{900, 450}, Size{1024, 768}};
constexpr std::array kFactors{1.05, 1.1, 1.25};
constexpr Size kWindow{24, 24};

/// Windows that come nearest to the printed equation (core/detection/README.md).
const PaperWindows kNearest{{460, 480}, 25, 1.0 / 8, 1.05, 1.05};
constexpr uint64_t kSamples = 600;

bool printCounts() {
  for (const Size size : kSizes)
    for (const double factor : kFactors) {
      const auto scales = detection::scalesOf({size, kWindow, factor});
      detection::SearchWindows windows;
      if (!scales || !windows.lay(*scales, std::array{boundsOf(size)})) return false;
      std::printf(
          "{\"figure\":18,\"width\":%d,\"height\":%d,\"window\":%d,\"factor\":%g,\"scales\":%zu,"
          "\"windows\":%u}\n",
          size.width, size.height, kWindow.width, factor, scales->size(), windows.table().count);
    }
  return true;
}

bool printScales() {
  const auto scales = detection::paperScalesOf(kNearest);
  if (!scales) return false;
  const uint64_t count = scales->back().firstId + scales->back().count;
  const auto samples = detection::sample(*scales, count / kSamples),
             all = detection::sample(*scales, 1);
  const auto fitted = detection::refit(detection::kPrintedModel, samples);
  for (const detection::ScaleSample& s : samples)
    std::printf("{\"figure\":19,\"id\":%.0f,\"scale\":%.6f,\"printed\":%.6f,\"refit\":%.6f}\n",
                s.id, s.scale, detection::kPrintedModel.at(s.id), fitted.at(s.id));
  std::printf(
      "{\"equation\":2,\"windows\":%llu,\"scales\":%zu,\"pole\":%.0f,\"r2_printed\":%.4f,"
      "\"r2_refit\":%.4f,\"r2_printed_all\":%.4f,\"refit\":[%.6g,%.6g,%.6g,%.6g,%.6g]}\n",
      static_cast<unsigned long long>(count), scales->size(), detection::kPrintedModel.pole(),
      detection::rSquared(detection::kPrintedModel, samples), detection::rSquared(fitted, samples),
      detection::rSquared(detection::kPrintedModel, all), fitted.n0, fitted.n1, fitted.n2,
      fitted.d1, fitted.d2);
  return true;
}

}  // namespace
}  // namespace rg

int main() {
  return rg::printCounts() && rg::printScales() ? 0 : 1;
}
