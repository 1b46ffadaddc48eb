// SPDX-License-Identifier: LGPL-2.1-or-later
// The paper's model of a window's scale by its id, a ratio of two parabolas (section 3.1, equation
// (2)): as printed, refitted, and how well either fits.
//
// For reports: the detector takes the exact table (search_windows.hpp). Floating point; the last
// bits may depend on the compiler.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/result.hpp"

#include <cstdint>
#include <vector>

namespace rg::detection {

/// scale = (n0 + n1 id + n2 id²) / (1 + d1 id + d2 id²).
struct ScaleModel {
  double n0 = 0, n1 = 0, n2 = 0, d1 = 0, d2 = 0;
  [[nodiscard]] double at(double id) const {
    return (n0 + (n1 + n2 * id) * id) / (1 + (d1 + d2 * id) * id);
  }
  /// The smallest id above 0 at which the denominator is 0: from there on the model means nothing.
  /// Infinite where there is none.
  [[nodiscard]] double pole() const;
};

/// Equation (2) as it is printed. Its pole is at 176 894: it says nothing of windows from there on,
/// and nothing of sets of windows of which there are many more or fewer.
inline constexpr ScaleModel kPrintedModel{1.08, -9.24e-6, 1.79e-11, -1.05e-5, 2.74e-11};

/// Windows as equations (3) to (5) count them, brackets put where they must be, but without the
/// "+ 1": as many in a row as whole steps fit beside the first, the window and the step in
/// fractions of a pixel. For square windows.
struct PaperWindows {
  Size frame;
  double sidePx = 0;
  double stepShare = 0;  ///< The step, as share of the scaled window's side.
  double firstScale = 1, scaleFactor = 1.1;
};

struct PaperScale {
  double scale = 1;
  uint64_t firstId = 0, count = 0;
};
/// Those that have windows. Errors: a frame without pixels, numbers that are not above 0, a factor
/// that does not grow.
[[nodiscard]] Result<std::vector<PaperScale>> paperScalesOf(const PaperWindows& windows);

/// Pairs of a window's id and its scale.
struct ScaleSample {
  double id = 0, scale = 1;
};
/// Of every stride-th window, from 0 on. stride > 0.
[[nodiscard]] std::vector<ScaleSample> sample(const std::vector<PaperScale>& scales,
                                              uint64_t stride);

/// The coefficient of determination: 1 less the sum of the squared errors by that of the squared
/// differences from the mean.
[[nodiscard]] double rSquared(const ScaleModel& model, const std::vector<ScaleSample>& samples);

/// The model with the least squared errors that is reached from another one by damped Gauss-Newton
/// steps (Levenberg, Marquardt). At least five samples.
[[nodiscard]] ScaleModel refit(const ScaleModel& from, const std::vector<ScaleSample>& samples);

}  // namespace rg::detection
