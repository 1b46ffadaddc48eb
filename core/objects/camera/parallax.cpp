// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/camera/parallax.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cmath>

namespace rg::objects {
namespace {

constexpr int kColumns = 12, kRows = 8;  // Of cells in which no more than their area counts.
constexpr size_t kMostSamples = 256;
constexpr uint32_t kTrials = 128;
constexpr int kLeastTrust = motion::kFullReliability / 32;
constexpr double kSlant = .15;  // Of its length a displacement may leave its line.
// Variance of places over that of a frame's: what is spread over half of its width and height has
// a quarter.
constexpr double kLeastSpread = .35;
constexpr double kLeastShare = .02;  // Of the frame.

}  // namespace

void Parallax::listSamples(const motion::Motion& motion, const CameraMotion& camera) {
  const std::vector<graph::Region>& regions = motion.graph->regions;
  samples_.clear();
  for (size_t i = 0; i < regions.size(); ++i) {
    const motion::RegionMotion& m = motion.regions[i];
    if (m.reliability < kLeastTrust) continue;
    const double x = regions[i].centroidX / 256.0, y = regions[i].centroidY / 256.0;
    const Point ground = camera.at(regions[i].centroidX >> 8, regions[i].centroidY >> 8);
    const double dx = (m.dx - ground.x) / double(motion::kMotionUnit);
    const double dy = (m.dy - ground.y) / double(motion::kMotionUnit);
    if (dx * dx + dy * dy <= threshold_ * threshold_) continue;
    const auto column = static_cast<uint32_t>(x * kColumns / frame_.width);
    const auto row = static_cast<uint32_t>(y * kRows / frame_.height);
    samples_.push_back(
        {x, y, dx, dy, double(regions[i].areaPx) * m.reliability, row * kColumns + column});
  }
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const Sample& a, const Sample& b) { return a.weight > b.weight; });
  if (samples_.size() > kMostSamples) samples_.resize(kMostSamples);
}

int Parallax::sideOf(const Epipole& e, const Sample& s) const {
  const double x = e.x - e.w * s.x, y = e.y - e.w * s.y;
  const double length = std::sqrt(x * x + y * y), own = std::sqrt(s.dx * s.dx + s.dy * s.dy);
  if (length == 0) return -1;
  const double beside = std::abs(s.dx * y - s.dy * x) / length;
  if (beside > std::max(threshold_ / 2, kSlant * own)) return -1;
  return s.dx * x + s.dy * y > 0 ? 0 : 1;
}

Parallax::Support Parallax::supportOf(const Epipole& epipole, int side) {
  const double most = double(frame_.area()) / (kColumns * kRows) * motion::kFullReliability / 4;
  cells_.assign(size_t{kColumns} * kRows, 0);
  for (const Sample& s : samples_)
    if (sideOf(epipole, s) == side) cells_[s.cell] += s.weight;
  double sum = 0, x = 0, y = 0, xx = 0, yy = 0;
  for (size_t i = 0; i < cells_.size(); ++i) {
    const double weight = std::min(cells_[i] / most, 1.0);
    const size_t row = i / kColumns;
    const double cx = (double(i % kColumns) + .5) / kColumns;
    const double cy = (double(row) + .5) / kRows;
    sum += weight;
    x += weight * cx;
    y += weight * cy;
    xx += weight * cx * cx;
    yy += weight * cy * cy;
  }
  if (sum == 0) return {};
  constexpr double kOfFrame = 2 / 12.0;
  const double variance = xx / sum - x * x / (sum * sum) + yy / sum - y * y / (sum * sum);
  return {sum / (kColumns * kRows), variance / kOfFrame};
}

void Parallax::find(const motion::Motion& motion, const CameraMotion& camera, int threshold) {
  frame_ = motion.size;
  threshold_ = threshold / double(motion::kMotionUnit);
  follows_[0] = follows_[1] = false;
  listSamples(motion, camera);
  if (samples_.size() < 2) return;
  double most = 0;
  for (uint32_t trial = 0; trial < kTrials; ++trial) {
    const auto drawn = [&](uint32_t which) -> const Sample& {
      return samples_[mixHash(trial, which, 78) % samples_.size()];
    };
    const Sample &p = drawn(0), &q = drawn(1);
    // Lines through places along displacements, and where they meet.
    const double a = -p.dy, b = p.dx, c = p.dy * p.x - p.dx * p.y;
    const double d = -q.dy, e = q.dx, f = q.dy * q.x - q.dx * q.y;
    Epipole epipole{b * f - c * e, c * d - a * f, a * e - b * d};
    if (epipole.w < 0) epipole = {-epipole.x, -epipole.y, -epipole.w};
    const double size = std::abs(epipole.x) + std::abs(epipole.y);
    if (size == 0) continue;
    double support = 0;
    bool follows[2];
    for (int side = 0; side < 2; ++side) {
      const Support found = supportOf(epipole, side);
      follows[side] = found.weight >= kLeastShare && found.spread >= kLeastSpread;
      if (follows[side]) support += found.weight;
    }
    if (support <= most) continue;
    most = support;
    epipole_ = epipole;
    follows_[0] = follows[0];
    follows_[1] = follows[1];
  }
}

bool Parallax::explains(Point place, Point beyond) const {
  if (!isSeen()) return false;
  const Sample sample{double(place.x),
                      double(place.y),
                      beyond.x / double(motion::kMotionUnit),
                      beyond.y / double(motion::kMotionUnit),
                      0,
                      0};
  const int side = sideOf(epipole_, sample);
  return side >= 0 && follows_[side];
}

}  // namespace rg::objects
