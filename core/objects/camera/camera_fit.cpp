// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/camera/camera_fit.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rg::objects {
namespace {

constexpr size_t kMostSamples = 512;
constexpr uint32_t kTrials = 200;
constexpr int kSteps = 8;
constexpr double kDoubtful = 4;  // What is expected to be an object says so much less.
// By how much more regions' worth a model has to explain for each number that it has more.
constexpr double kFreedomCost = 1.5;
// Priors, as regions' worth: how far pictures turn and grow from frame to frame, and how far they
// slant, per half diagonal.
constexpr double kUsualTurn = .1, kUsualSlant = .03;

using Sample = CameraScratch::Sample;

/// previous = (a x + b y + c, d x + e y + f) / (g x + h y + 1).
struct Model {
  double a = 1, b = 0, c = 0, d = 0, e = 1, f = 0, g = 0, h = 0;

  [[nodiscard]] double squaredMiss(const Sample& s) const {
    const double w = g * s.x + h * s.y + 1;
    const double dx = (a * s.x + b * s.y + c) / w - s.px, dy = (d * s.x + e * s.y + f) / w - s.py;
    return dx * dx + dy * dy;
  }
};

enum class Freedom : int { Shift = 2, Similarity = 4, Affinity = 6, Homography = 8 };

/// Symmetric normal equations of up to eight unknowns.
class Equations {
 public:
  explicit Equations(int count) : count_(count) {}

  void add(const std::array<double, 8>& row, double right, double weight) {
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
  [[nodiscard]] bool solve(std::array<double, 8>& x) {
    std::array<std::array<double, 8>, 8> low{};
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
  std::array<std::array<double, 8>, 8> left_{};
  std::array<double, 8> right_{};
};

using Row = std::array<double, 8>;

/// What a sample says of the unknowns: its two lines of the equations.
std::pair<Row, Row> linesOf(Freedom freedom, const Sample& s) {
  switch (freedom) {
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

/// unit: a motion that is alike, as share of half the diagonal.
Model solveFor(Freedom freedom, std::span<const Sample> samples, std::span<const double> fitting,
               double unit, const Model& otherwise) {
  const int count = static_cast<int>(freedom);
  Equations equations(count);
  for (size_t i = 0; i < samples.size(); ++i) {
    const Sample& s = samples[i];
    const double weight = s.weight * fitting[i];
    if (weight == 0) continue;
    const auto [x, y] = linesOf(freedom, s);
    equations.add(x, s.px - s.x, weight);
    equations.add(y, s.py - s.y, weight);
  }
  const double units = unit * unit;
  for (int i = 2; i < count; ++i) {
    const double usual = i < 6 ? kUsualTurn : kUsualSlant;
    equations.expect(i, 0, units / (usual * usual));
  }
  std::array<double, 8> found{};
  if (!equations.solve(found)) return otherwise;
  Model m;
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

/// Of the votes for what a model explains within `limit`.
double supportOf(const Model& model, std::span<const Sample> samples, double limit) {
  double sum = 0;
  for (const Sample& s : samples) {
    const double share = 1 - model.squaredMiss(s) / (limit * limit);
    if (share > 0) sum += s.votes * share;
  }
  return sum;
}

/// What a model leaves unexplained, in regions' worth; sets how well each sample fits.
double costOf(const Model& model, std::span<const Sample> samples, double limit,
              std::span<double> fitting) {
  double cost = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    const double ratio = model.squaredMiss(samples[i]) / (limit * limit);
    const double share = 1 / (1 + ratio);
    fitting[i] = share * share;
    cost += samples[i].weight * (1 - share);
  }
  return cost;
}

Model similarityThrough(const Sample& p, const Sample& q) {
  const double x = q.x - p.x, y = q.y - p.y, u = q.px - p.px, v = q.py - p.py;
  const double length = x * x + y * y;
  Model m;
  m.a = m.e = (x * u + y * v) / length;
  m.d = (x * v - y * u) / length;
  m.b = -m.d;
  m.c = p.px - m.a * p.x - m.b * p.y;
  m.f = p.py - m.d * p.x - m.e * p.y;
  return m;
}

bool isUsual(const Model& m) {
  constexpr double kMost = .25;
  return std::abs(m.a - 1) < kMost && std::abs(m.d) < kMost;
}

struct Frame {
  double middleX, middleY, half;
};

Frame frameOf(Size size) {
  const double w = size.width, h = size.height;
  return {std::floor(w / 2), std::floor(h / 2), std::sqrt(w * w + h * h) / 2};
}

void listSamples(const motion::Motion& motion, const CameraRules& rules, const Frame& frame,
                 CameraScratch& s) {
  const std::vector<graph::Region>& regions = motion.graph->regions;
  s.order.clear();
  for (uint32_t i = 0; i < regions.size(); ++i)
    if (motion.regions[i].reliability > 0) s.order.push_back(i);
  const auto votesOf = [&](uint32_t i) {
    return int64_t{regions[i].areaPx} * motion.regions[i].reliability;
  };
  const auto sorts = [&](uint32_t a, uint32_t b) {
    return votesOf(a) != votesOf(b) ? votesOf(a) > votesOf(b) : a < b;
  };
  if (s.order.size() > kMostSamples) {
    std::nth_element(s.order.begin(), s.order.begin() + kMostSamples, s.order.end(), sorts);
    s.order.resize(kMostSamples);
  }
  std::sort(s.order.begin(), s.order.end(), sorts);
  s.samples.clear();
  for (const uint32_t i : s.order) {
    const graph::Region& region = regions[i];
    const motion::RegionMotion& m = motion.regions[i];
    const double doubt = !rules.isDoubtful.empty() && rules.isDoubtful[i] != 0 ? kDoubtful : 1;
    const double trust = double(m.reliability) / motion::kFullReliability / doubt;
    const double x = region.centroidX / 256.0 - frame.middleX;
    const double y = region.centroidY / 256.0 - frame.middleY;
    s.samples.push_back(
        {x / frame.half, y / frame.half, (x - m.dx / double(motion::kMotionUnit)) / frame.half,
         (y - m.dy / double(motion::kMotionUnit)) / frame.half, trust * region.areaPx, trust});
  }
}

Model modelOf(const CameraMotion& camera, const Frame& frame) {
  const CameraMotion::Matrix& m = camera.matrix();
  const auto part = [&](size_t i) { return double(m[i]) / double(m[8]); };
  return {part(0),
          part(1),
          part(2) / frame.half,
          part(3),
          part(4),
          part(5) / frame.half,
          part(6) * frame.half,
          part(7) * frame.half};
}

CameraMotion motionOf(const Model& m, const Frame& frame) {
  const auto part = [](double value) {
    return static_cast<int64_t>(std::floor(value * double(CameraMotion::kOne) + .5));
  };
  return {
      {part(m.a), part(m.b), part(m.c * frame.half), part(m.d), part(m.e), part(m.f * frame.half),
       part(m.g / frame.half), part(m.h / frame.half), CameraMotion::kOne},
      {static_cast<int>(frame.middleX), static_cast<int>(frame.middleY)}};
}

/// Whether it can be told all over the frame and a little beyond.
bool isTame(const Model& m) {
  constexpr double kMostSlant = .5, kMostShear = .5, kMostShift = 1;
  return std::abs(m.g) + std::abs(m.h) < kMostSlant && std::abs(m.a - 1) < kMostShear &&
         std::abs(m.e - 1) < kMostShear && std::abs(m.b) < kMostShear &&
         std::abs(m.d) < kMostShear && std::abs(m.c) < kMostShift && std::abs(m.f) < kMostShift;
}

Model bestTrial(const CameraRules& rules, const Frame& frame, double limit,
                std::span<const Sample> samples) {
  Model best;
  best.c = -rules.shift.dx / double(motion::kMotionUnit) / frame.half;
  best.f = -rules.shift.dy / double(motion::kMotionUnit) / frame.half;
  double most = supportOf(best, samples, limit);
  const auto consider = [&](const Model& model) {
    const double support = supportOf(model, samples, limit);
    if (support <= most) return;
    most = support;
    best = model;
  };
  consider(modelOf(rules.before, frame));
  double total = 0;
  for (const Sample& s : samples) total += s.votes;
  const auto drawn = [&](uint32_t trial, uint32_t which) -> const Sample& {
    // Half by the pixels that they stand for, half all alike, so that those of a large thing don't
    // outnumber all others.
    const uint32_t hash = mixHash(trial, which, 77);
    if (trial % 2 == 0) return samples[hash % samples.size()];
    double at = double(hash) / 4294967296.0 * total;
    for (const Sample& s : samples) {
      at -= s.votes;
      if (at < 0) return s;
    }
    return samples.back();
  };
  constexpr double kNear = .2;
  for (uint32_t trial = 0; trial < kTrials; ++trial) {
    const Sample &p = drawn(trial, 0), &q = drawn(trial, 1);
    const double dx = p.x - q.x, dy = p.y - q.y;
    if (dx * dx + dy * dy < kNear * kNear) continue;
    const Model model = similarityThrough(p, q);
    if (isUsual(model)) consider(model);
  }
  return best;
}

}  // namespace

CameraMotion fitCamera(const motion::Motion& motion, const CameraRules& rules, CameraScratch& s) {
  const CameraMotion shift(Point{rules.shift.dx, rules.shift.dy});
  const Frame frame = frameOf(motion.size);
  listSamples(motion, rules, frame, s);
  if (s.samples.size() < 2) return shift;
  const double unit = rules.threshold / double(motion::kMotionUnit) / frame.half;
  const Model start = bestTrial(rules, frame, 2 * unit, s.samples);
  s.fitting.resize(s.samples.size());
  Model chosen = start;
  double least = INFINITY;
  for (const Freedom freedom :
       {Freedom::Shift, Freedom::Similarity, Freedom::Affinity, Freedom::Homography}) {
    Model model = start;
    for (int step = 0; step < kSteps; ++step) {
      const double limit = unit * std::max(.5, 2.0 - step * .25);
      costOf(model, s.samples, limit, s.fitting);
      model = solveFor(freedom, s.samples, s.fitting, unit, model);
    }
    const double cost =
        costOf(model, s.samples, unit / 2, s.fitting) + kFreedomCost * static_cast<int>(freedom);
    if (!isTame(model) || cost >= least) continue;
    least = cost;
    chosen = model;
  }
  if (!isTame(chosen)) return shift;
  return motionOf(chosen, frame);
}

}  // namespace rg::objects
