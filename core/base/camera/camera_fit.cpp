// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_fit.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace rg {
namespace {

constexpr size_t kMostTried = 400;  // Samples that a start is tried on.
constexpr uint32_t kTrials = 160;
constexpr int kSteps = 7;
// By how many more votes a model has to explain for each number that it has more.
constexpr double kFreedomCost = 1.5;
// Priors, as votes: how far pictures turn and grow from frame to frame, and how far they slant, per
// half diagonal.
constexpr double kUsualTurn = .1, kUsualSlant = .03;
constexpr double kEnough = .8;  // Share of the votes that makes further trials idle.

using Sample = CameraSample;
using Weights = CameraFitScratch::Weights;
using Row = std::array<double, 8>;

enum class Freedom : int { None = 0, Shift = 2, Similarity = 4, Affinity = 6, Homography = 8 };

struct Miss {
  double x, y;
};

Miss missOf(const CameraModel& m, const Sample& s) {
  const double w = m.g * s.x + m.h * s.y + 1;
  return {(m.a * s.x + m.b * s.y + m.c) / w - s.px, (m.d * s.x + m.e * s.y + m.f) / w - s.py};
}

/// In squares of what counts as alike.
double squaredMiss(const CameraModel& m, const Sample& s, const Weights& w, double alike) {
  const Miss miss = missOf(m, s);
  return (w.xx * miss.x * miss.x + 2 * w.xy * miss.x * miss.y + w.yy * miss.y * miss.y) /
         (alike * alike);
}

/// Of a covariance and what counts as alike: alike² (covariance + alike²)⁻¹.
Weights weightsOf(const Sample& s, double alike) {
  const double unit = alike * alike;
  const double xx = s.xx + unit, yy = s.yy + unit;
  const double determinant = xx * yy - s.xy * s.xy;
  Weights w{unit * yy / determinant, -unit * s.xy / determinant, unit * xx / determinant};
  const double half = (s.xx - s.yy) / 2;
  const double most = (s.xx + s.yy) / 2 + std::sqrt(half * half + s.xy * s.xy);
  w.vote = (w.xx + w.yy) / 2;
  w.sure = unit / (unit + most);
  return w;
}

/// Symmetric normal equations of up to eight unknowns.
class Equations {
 public:
  explicit Equations(int count) : count_(count) {}

  void add(const Row& row, double right, double weight) {
    for (int i = 0; i < count_; ++i) {
      const double scaled = weight * row[at(i)];
      for (int j = i; j < count_; ++j) left_[at(i)][at(j)] += scaled * row[at(j)];
      right_[at(i)] += scaled * right;
    }
  }
  void expect(int unknown, double value, double weight) {
    left_[at(unknown)][at(unknown)] += weight;
    right_[at(unknown)] += weight * value;
  }
  /// By Cholesky's way; false where it has no single answer.
  [[nodiscard]] bool solve(Row& x) {
    std::array<Row, 8> low{};
    for (int i = 0; i < count_; ++i)
      for (int j = 0; j <= i; ++j) {
        double sum = left_[at(j)][at(i)];
        for (int k = 0; k < j; ++k) sum -= low[at(i)][at(k)] * low[at(j)][at(k)];
        if (i != j) {
          low[at(i)][at(j)] = sum / low[at(j)][at(j)];
        } else if (sum <= 0) {
          return false;
        } else {
          low[at(i)][at(i)] = std::sqrt(sum);
        }
      }
    for (int i = 0; i < count_; ++i) {
      double sum = right_[at(i)];
      for (int k = 0; k < i; ++k) sum -= low[at(i)][at(k)] * x[at(k)];
      x[at(i)] = sum / low[at(i)][at(i)];
    }
    for (int i = count_ - 1; i >= 0; --i) {
      double sum = x[at(i)];
      for (int k = i + 1; k < count_; ++k) sum -= low[at(k)][at(i)] * x[at(k)];
      x[at(i)] = sum / low[at(i)][at(i)];
    }
    return true;
  }

 private:
  static constexpr size_t at(int i) { return static_cast<size_t>(i); }
  int count_;
  std::array<Row, 8> left_{};
  Row right_{};
};

/// What a sample says of the unknowns: its two lines of the equations.
std::pair<Row, Row> linesOf(Freedom freedom, const Sample& s) {
  switch (freedom) {
    case Freedom::None:
    case Freedom::Shift:
      return {{1, 0}, {0, 1}};
    case Freedom::Similarity:
      return {{1, 0, s.x, -s.y}, {0, 1, s.y, s.x}};
    case Freedom::Affinity:
    case Freedom::Homography:
      break;
  }
  return {{1, 0, s.x, s.y, 0, 0, -s.x * s.px, -s.y * s.px},
          {0, 1, 0, 0, s.x, s.y, -s.x * s.py, -s.y * s.py}};
}

void addSample(const Sample& s, const Weights& w, Freedom freedom, Equations& equations) {
  const auto [x, y] = linesOf(freedom, s);
  const double rightX = s.px - s.x, rightY = s.py - s.y;
  // The weights' root is triangular: two lines that know nothing of each other.
  const double ratio = w.xy / w.xx;
  Row line{};
  for (size_t i = 0; i < line.size(); ++i) line[i] = x[i] + ratio * y[i];
  equations.add(line, rightX + ratio * rightY, w.fitting * w.xx);
  equations.add(y, rightY, w.fitting * (w.yy - w.xy * ratio));
}

CameraModel modelOf(Freedom freedom, const Row& found) {
  CameraModel m;
  m.c = found[0];
  m.f = found[1];
  if (freedom == Freedom::Similarity) {
    m.a = m.e = 1 + found[2];
    m.b = -found[3];
    m.d = found[3];
  } else if (freedom != Freedom::Shift) {
    m.a = 1 + found[2];
    m.b = found[3];
    m.d = found[4];
    m.e = 1 + found[5];
    m.g = found[6];
    m.h = found[7];
  }
  return m;
}

CameraModel solveFor(Freedom freedom, std::span<const Sample> samples,
                     std::span<const Weights> weights, double alike, const CameraModel& otherwise) {
  const int count = static_cast<int>(freedom);
  Equations equations(count);
  for (size_t i = 0; i < samples.size(); ++i) addSample(samples[i], weights[i], freedom, equations);
  for (int i = 2; i < count; ++i) {
    const double usual = (i < 6 ? kUsualTurn : kUsualSlant) / alike;
    equations.expect(i, 0, 1 / (usual * usual));
  }
  Row found{};
  if (!equations.solve(found)) return otherwise;
  return modelOf(freedom, found);
}

/// Votes.
struct Explained {
  double left = 0;  ///< Those that are left unexplained.
  double sure = 0;  ///< Of those that are explained, what is known along both directions.
};

/// Sets how well each sample fits.
Explained explain(const CameraModel& model, std::span<const Sample> samples, double alike,
                  double limit, std::span<Weights> weights) {
  Explained all;
  for (size_t i = 0; i < samples.size(); ++i) {
    Weights& w = weights[i];
    const double share = 1 / (1 + squaredMiss(model, samples[i], w, alike) / (limit * limit));
    w.fitting = share * share;
    all.left += w.vote * (1 - share);
    all.sure += w.sure * share;
  }
  return all;
}

CameraModel similarityThrough(const Sample& p, const Sample& q) {
  const double x = p.x - q.x, y = p.y - q.y, u = p.px - q.px, v = p.py - q.py;
  const double length = x * x + y * y;
  CameraModel m;
  m.a = m.e = (x * u + y * v) / length;
  m.d = (x * v - y * u) / length;
  m.b = -m.d;
  m.c = p.px - m.a * p.x - m.b * p.y;
  m.f = p.py - m.d * p.x - m.e * p.y;
  return m;
}

bool isUsual(const CameraModel& m) {
  constexpr double kMost = .25;
  return std::abs(m.a - 1) < kMost && std::abs(m.d) < kMost;
}

/// Whether it can be told all over the frame and a little beyond.
bool isTame(const CameraModel& m) {
  constexpr double kMostSlant = .5, kMostShear = .5, kMostShift = 1;
  return std::abs(m.g) + std::abs(m.h) < kMostSlant && std::abs(m.a - 1) < kMostShear &&
         std::abs(m.e - 1) < kMostShear && std::abs(m.b) < kMostShear &&
         std::abs(m.d) < kMostShear && std::abs(m.c) < kMostShift && std::abs(m.f) < kMostShift;
}

/// The start that most votes are for.
class Starts {
 public:
  Starts(std::span<const Sample> samples, std::span<const Weights> weights, double alike)
      : samples_(samples),
        weights_(weights),
        alike_(alike),
        step_((samples.size() + kMostTried - 1) / kMostTried) {
    for (size_t i = 0; i < samples.size(); i += step_) all_ += weights[i].vote;
  }

  void consider(const CameraModel& model) {
    constexpr double kLimit = 2;
    double support = 0, open = all_;
    for (size_t i = 0; i < samples_.size() && support + open > most_; i += step_) {
      open -= weights_[i].vote;
      const double share =
          1 - squaredMiss(model, samples_[i], weights_[i], alike_) / (kLimit * kLimit);
      if (share > 0) support += weights_[i].vote * share;
    }
    if (support <= most_) return;
    most_ = support;
    best_ = model;
  }

  void considerPairs() {
    constexpr double kNear = .2, kLeastSure = .1;
    const auto count = static_cast<uint32_t>(samples_.size());
    for (uint32_t trial = 0; trial < kTrials && most_ < kEnough * all_; ++trial) {
      const size_t i = mixHash(trial, 0, 77) % count, j = mixHash(trial, 1, 77) % count;
      if (weights_[i].sure < kLeastSure || weights_[j].sure < kLeastSure) continue;
      const double dx = samples_[i].x - samples_[j].x, dy = samples_[i].y - samples_[j].y;
      if (dx * dx + dy * dy < kNear * kNear) continue;
      const CameraModel model = similarityThrough(samples_[i], samples_[j]);
      if (isUsual(model)) consider(model);
    }
  }

  [[nodiscard]] const CameraModel& best() const { return best_; }

 private:
  std::span<const Sample> samples_;
  std::span<const Weights> weights_;
  double alike_;
  size_t step_;
  double all_ = 0, most_ = -1;
  CameraModel best_;
};

}  // namespace

CameraFit fitCamera(std::span<const CameraSample> samples, const CameraFitRules& rules,
                    CameraFitScratch& s) {
  if (samples.size() < 2) return {};
  CameraFit fit;
  s.weights.clear();
  for (const Sample& sample : samples) {
    s.weights.push_back(weightsOf(sample, rules.alike));
    fit.votes += s.weights.back().vote;
  }
  Starts starts(samples, s.weights, rules.alike);
  for (const CameraModel& model : rules.expected) starts.consider(model);
  if (rules.triesPairs) starts.considerPairs();
  // What is only made finer begins where what fits has been told apart.
  const int first = rules.triesPairs ? 0 : kSteps / 2;
  double least = INFINITY, unexplained = fit.votes;
  for (const Freedom freedom : {Freedom::None, Freedom::Shift, Freedom::Similarity,
                                Freedom::Affinity, Freedom::Homography}) {
    CameraModel model = freedom == Freedom::None ? CameraModel() : starts.best();
    for (int step = first; step < kSteps && freedom != Freedom::None; ++step) {
      (void)explain(model, samples, rules.alike, 2.0 - step * .25, s.weights);
      model = solveFor(freedom, samples, s.weights, rules.alike, model);
    }
    const Explained explained = explain(model, samples, rules.alike, .5, s.weights);
    const double cost = explained.left + kFreedomCost * static_cast<int>(freedom);
    if (!isTame(model) || cost >= least) continue;
    least = cost;
    unexplained = explained.left;
    fit.sure = explained.sure;
    fit.model = model;
  }
  if (fit.votes > 0) fit.explained = 1 - unexplained / fit.votes;
  return fit;
}

CameraFrame CameraFrame::of(Size size) {
  const double w = size.width, h = size.height;
  return {(w - 1) / 2, (h - 1) / 2, std::sqrt(w * w + h * h) / 2};
}

bool isShift(const CameraModel& m) {
  return m.a == 1 && m.e == 1 && m.b == 0 && m.d == 0 && m.g == 0 && m.h == 0;
}

Point shiftOf(const CameraModel& m, const CameraFrame& frame) {
  constexpr int kUnit = 1 << CameraMotion::kMotionBits;
  const auto rounded = [&](double share) {
    return static_cast<int>(std::floor(-share * frame.half * kUnit + .5));
  };
  return {rounded(m.c), rounded(m.f)};
}

CameraMotion motionOf(const CameraModel& m, const CameraFrame& frame) {
  // From the middle to a whole pixel beside it.
  const Point origin{static_cast<int>(frame.middleX), static_cast<int>(frame.middleY)};
  const double tx = (origin.x - frame.middleX) / frame.half;
  const double ty = (origin.y - frame.middleY) / frame.half;
  const double w = m.g * tx + m.h * ty + 1;
  const auto part = [&](double value) {
    return static_cast<int64_t>(std::floor(value / w * double(CameraMotion::kOne) + .5));
  };
  const auto along = [&](double x, double y, double shift, double t) {
    return std::array{part(x - t * m.g), part(y - t * m.h),
                      part((x * tx + y * ty + shift - t * w) * frame.half)};
  };
  const auto first = along(m.a, m.b, m.c, tx), second = along(m.d, m.e, m.f, ty);
  return {{first[0], first[1], first[2], second[0], second[1], second[2], part(m.g / frame.half),
           part(m.h / frame.half), CameraMotion::kOne},
          origin};
}

}  // namespace rg
