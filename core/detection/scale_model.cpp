// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/scale_model.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace rg::detection {
namespace {

constexpr size_t kTerms = 5;
constexpr double kIdUnit = 1e5;  // Ids are counted in these, so that all terms are of one size.
using Vector = std::array<double, kTerms>;
using Matrix = std::array<Vector, kTerms>;

/// With ids in units of kIdUnit.
Vector termsOf(const ScaleModel& m) {
  return {m.n0, m.n1 * kIdUnit, m.n2 * kIdUnit * kIdUnit, m.d1 * kIdUnit, m.d2 * kIdUnit * kIdUnit};
}
ScaleModel modelOf(const Vector& t) {
  return {t[0], t[1] / kIdUnit, t[2] / kIdUnit / kIdUnit, t[3] / kIdUnit, t[4] / kIdUnit / kIdUnit};
}

double squaredError(const Vector& terms, const std::vector<ScaleSample>& samples) {
  const ScaleModel model = modelOf(terms);
  double sum = 0;
  for (const ScaleSample& s : samples) {
    const double error = model.at(s.id) - s.scale;
    sum += error * error;
  }
  return sum;
}

/// The normal equations of one step: products of the derivatives, and of these with the errors.
struct Step {
  Matrix products{};
  Vector gradient{};
};
Step linearise(const Vector& t, const std::vector<ScaleSample>& samples) {
  Step step;
  for (const ScaleSample& s : samples) {
    const double x = s.id / kIdUnit;
    const double below = 1 + (t[3] + t[4] * x) * x;
    const double value = (t[0] + (t[1] + t[2] * x) * x) / below;
    const Vector slope{1 / below, x / below, x * x / below, -value * x / below,
                       -value * x * x / below};
    for (size_t i = 0; i < kTerms; ++i) {
      step.gradient[i] += slope[i] * (s.scale - value);
      for (size_t j = 0; j < kTerms; ++j) step.products[i][j] += slope[i] * slope[j];
    }
  }
  return step;
}

/// By Gauss's elimination with the largest pivot of each column.
Vector solve(Matrix a, Vector b) {
  for (size_t i = 0; i < kTerms; ++i) {
    size_t best = i;
    for (size_t r = i + 1; r < kTerms; ++r)
      if (std::abs(a[r][i]) > std::abs(a[best][i])) best = r;
    std::swap(a[i], a[best]);
    std::swap(b[i], b[best]);
    for (size_t r = i + 1; r < kTerms; ++r) {
      const double share = a[r][i] / a[i][i];
      for (size_t c = i; c < kTerms; ++c) a[r][c] -= share * a[i][c];
      b[r] -= share * b[i];
    }
  }
  for (size_t i = kTerms; i-- > 0;) {
    for (size_t c = i + 1; c < kTerms; ++c) b[i] -= a[i][c] * b[c];
    b[i] /= a[i][i];
  }
  return b;
}

}  // namespace

double ScaleModel::pole() const {
  const double none = std::numeric_limits<double>::infinity();
  if (d2 == 0) return d1 < 0 ? -1 / d1 : none;
  const double square = d1 * d1 - 4 * d2;
  if (square < 0) return none;
  const double a = (-d1 - std::sqrt(square)) / (2 * d2), b = (-d1 + std::sqrt(square)) / (2 * d2);
  double first = none;
  for (const double root : {a, b})
    if (root > 0 && root < first) first = root;
  return first;
}

Result<std::vector<PaperScale>> paperScalesOf(const PaperWindows& w) {
  if (w.frame.isEmpty() || !(w.sidePx > 0) || !(w.stepShare > 0) || !(w.firstScale > 0))
    return Error{"frame, window, step and first scale must be above 0"};
  if (!(w.scaleFactor > 1)) return Error{"the scale factor must be above 1"};
  std::vector<PaperScale> scales;
  uint64_t first = 0;
  double next = w.firstScale;
  while (true) {
    const double scale = std::exchange(next, next * w.scaleFactor);
    const double side = w.sidePx * scale, step = side * w.stepShare;
    if (side > w.frame.width || side > w.frame.height) break;
    const auto count = static_cast<uint64_t>(std::floor((w.frame.width - side) / step)) *
                       static_cast<uint64_t>(std::floor((w.frame.height - side) / step));
    if (count > 0) scales.push_back({scale, first, count});
    first += count;
  }
  return scales;
}

std::vector<ScaleSample> sample(const std::vector<PaperScale>& scales, uint64_t stride) {
  assert(stride > 0);
  std::vector<ScaleSample> samples;
  uint64_t id = 0;
  for (const PaperScale& s : scales)
    for (; id < s.firstId + s.count; id += stride)
      samples.push_back({static_cast<double>(id), s.scale});
  return samples;
}

double rSquared(const ScaleModel& model, const std::vector<ScaleSample>& samples) {
  double mean = 0, spread = 0;
  for (const ScaleSample& s : samples) mean += s.scale / static_cast<double>(samples.size());
  for (const ScaleSample& s : samples) spread += (s.scale - mean) * (s.scale - mean);
  return 1 - squaredError(termsOf(model), samples) / spread;
}

ScaleModel refit(const ScaleModel& from, const std::vector<ScaleSample>& samples) {
  assert(samples.size() >= kTerms);
  constexpr int kMostSteps = 500;
  Vector terms = termsOf(from);
  double error = squaredError(terms, samples), damping = 1e-3;
  for (int i = 0; i < kMostSteps && damping < 1e12; ++i) {
    Step step = linearise(terms, samples);
    for (size_t k = 0; k < kTerms; ++k) step.products[k][k] *= 1 + damping;
    Vector next = solve(step.products, step.gradient);
    for (size_t k = 0; k < kTerms; ++k) next[k] += terms[k];
    const double nextError = squaredError(next, samples);
    if (nextError < error) {
      terms = next;
      error = nextError;
      damping /= 10;
    } else {
      damping *= 10;
    }
  }
  return modelOf(terms);
}

}  // namespace rg::detection
