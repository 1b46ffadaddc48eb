// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_search.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace rg {
namespace {

constexpr int kColumns = 256;   // Of the small picture, at most.
constexpr int kTinyShare = 5;   // Of it the tiny one has one in so many.
constexpr int kShiftShare = 4;  // Of the tiny picture's side, the furthest shift.
constexpr int kFarReach = 8;    // Small pixels round a shift of the whole: zoom and roll, too.
constexpr int kNearReach = 4;   // Round what was expected.
constexpr int kRefinements = 3;
// Small pixels by which motions may differ and count as alike.
constexpr double kAlikeWhole = .75, kAlikeFine = .1;
constexpr double kEnough = .6;  // Share of the votes that tells that no other motion is looked for.
// Nor is one if the camera goes on as it did, and that explains so much of what it explained when
// nothing better was found.
constexpr double kAsMuch = .9;
constexpr double kLeastNoise = 1.0;  // Variance of a difference, grey levels squared.

/// Of shift (dx, dy), in 1/256 grey level.
uint32_t meanDifference(ImageView<const uint8_t> now, ImageView<const uint8_t> before, int dx,
                        int dy) {
  const int first = std::max(0, dx), last = std::min(now.width(), now.width() + dx);
  const int top = std::max(0, dy), bottom = std::min(now.height(), now.height() + dy);
  uint64_t sum = 0;
  for (int y = top; y < bottom; ++y) {
    const uint8_t *a = now.row(y), *b = before.row(y - dy) - dx;
    uint32_t row = 0;
    for (int x = first; x < last; ++x) row += static_cast<uint32_t>(absDiff(a[x], b[x]));
    sum += row;
  }
  return static_cast<uint32_t>(256 * sum / static_cast<uint64_t>((last - first) * (bottom - top)));
}

/// Covariance of a shift that a block's gradients tell, given the variance of a pixel; squared
/// pixels. Gradients are per two pixels.
void setCovariance(const BlockSums& sums, double variance, double unit, CameraSample& sample) {
  // So that a block without gradients has one, too.
  constexpr double kLeast = 1e-3;
  const double xx = double(sums.xx) / 4 + kLeast, yy = double(sums.yy) / 4 + kLeast;
  const double xy = double(sums.xy) / 4;
  const double scale = variance / (xx * yy - xy * xy) / (unit * unit);
  sample.xx = yy * scale;
  sample.xy = -xy * scale;
  sample.yy = xx * scale;
}

}  // namespace

void CameraSearch::reset() {
  nowOf_.reset();
  last_ = {};
  agreement_ = 0;
  inVain_ = 1;
}

void CameraSearch::reduce(const Picture& picture, const Executor& executor, Reduced& to) const {
  shrink(picture.luma(), side_, executor, to.small);
  shrink(to.small, kTinyShare, executor, to.tiny);
}

/// Of the whole picture, in small pixels.
Point CameraSearch::findShift(const Executor& executor) {
  const Size size = now_.tiny.size();
  if (size.isEmpty()) return {};
  const int reachX = size.width / kShiftShare, reachY = size.height / kShiftShare;
  const auto columns = static_cast<size_t>(2 * reachX + 1);
  differences_.resize(columns * static_cast<size_t>(2 * reachY + 1));
  executor.forEach(2 * reachY + 1, [&](int row) {
    for (int dx = -reachX; dx <= reachX; ++dx)
      differences_[static_cast<size_t>(row) * columns + static_cast<size_t>(dx + reachX)] =
          meanDifference(now_.tiny, before_.tiny, dx, row - reachY);
  });
  Point best;
  std::tuple<uint32_t, int> least{UINT32_MAX, 0};
  for (int dy = -reachY; dy <= reachY; ++dy)
    for (int dx = -reachX; dx <= reachX; ++dx) {
      const std::tuple key{differences_[static_cast<size_t>(dy + reachY) * columns +
                                        static_cast<size_t>(dx + reachX)],
                           dx * dx + dy * dy};
      if (key >= least) continue;
      least = key;
      best = {dx * kTinyShare, dy * kTinyShare};
    }
  return best;
}

/// Looks for each block round where a camera's motion makes it come from.
void CameraSearch::match(const CameraModel& camera, int reach, const Executor& executor) {
  const CameraMotion motion = motionOf(camera, frame_);
  shifts_.clear();
  for (int block = 0; block < grid_.count(); ++block) {
    const Point at = grid_.cornerOf(block);
    const Point by = motion.at(at.x + kCameraBlock / 2, at.y + kCameraBlock / 2);
    constexpr int kUnit = 1 << CameraMotion::kMotionBits;
    shifts_.push_back({static_cast<int>(divideRounded(by.x, kUnit)),
                       static_cast<int>(divideRounded(by.y, kUnit))});
  }
  matchBlocks(now_.small, before_.small, shifts_, reach, executor, matches_);
}

void CameraSearch::measure(const CameraMotion& camera, const Executor& executor) {
  sums_.resize(static_cast<size_t>(grid_.count()));
  sumBlocks(now_.small, before_.small, camera, executor, sums_);
}

/// The variance of a pixel that most blocks come up to.
double CameraSearch::noise() {
  if (variances_.empty()) return kLeastNoise;
  const auto middle = variances_.begin() + static_cast<std::ptrdiff_t>(variances_.size() / 2);
  std::nth_element(variances_.begin(), middle, variances_.end());
  return std::max(kLeastNoise, *middle);
}

/// sums_ holds the blocks' gradients.
void CameraSearch::listMatches() {
  variances_.clear();
  constexpr double kPixels = kCameraBlock * kCameraBlock;
  for (const BlockMatch& match : matches_)
    if (match.sad != BlockMatch::kNone) {
      const double mean = match.sad / kPixels;
      variances_.push_back(1.57 * mean * mean);  // Of a normal distribution.
    }
  const double noise = this->noise();
  samples_.clear();
  for (int block = 0; block < grid_.count(); ++block) {
    const BlockMatch& match = matches_[static_cast<size_t>(block)];
    if (match.sad == BlockMatch::kNone) continue;
    const Point at = grid_.cornerOf(block);
    const double x = at.x + (kCameraBlock - 1) / 2.0 - frame_.middleX;
    const double y = at.y + (kCameraBlock - 1) / 2.0 - frame_.middleY;
    CameraSample sample{x / frame_.half, y / frame_.half, (x - match.shift.x) / frame_.half,
                        (y - match.shift.y) / frame_.half};
    setCovariance(sums_[static_cast<size_t>(block)], noise, frame_.half, sample);
    samples_.push_back(sample);
  }
}

/// sums_ was measured with `camera`.
void CameraSearch::listResiduals(const CameraModel& camera) {
  variances_.clear();
  constexpr int kPixels = kCameraBlock * kCameraBlock;
  constexpr double kLevels = 16;
  for (const BlockSums& sums : sums_)
    if (sums.pixels == kPixels)
      variances_.push_back(double(sums.ee) / (kLevels * kLevels * kPixels));
  const double noise = this->noise();
  samples_.clear();
  for (int block = 0; block < grid_.count(); ++block) {
    const BlockSums& sums = sums_[static_cast<size_t>(block)];
    if (sums.pixels < kPixels) continue;
    // What still is to be added to the motion: gradients are per two pixels.
    const double ridge = 4 * noise;
    const double xx = double(sums.xx) / 4 + ridge, yy = double(sums.yy) / 4 + ridge;
    const double xy = double(sums.xy) / 4, determinant = xx * yy - xy * xy;
    const double ex = double(sums.xe) / (2 * kLevels), ey = double(sums.ye) / (2 * kLevels);
    const double dx = -(yy * ex - xy * ey) / determinant, dy = -(xx * ey - xy * ex) / determinant;
    const Point at = grid_.cornerOf(block);
    CameraSample sample{(at.x + (kCameraBlock - 1) / 2.0 - frame_.middleX) / frame_.half,
                        (at.y + (kCameraBlock - 1) / 2.0 - frame_.middleY) / frame_.half};
    const double w = camera.g * sample.x + camera.h * sample.y + 1;
    sample.px = (camera.a * sample.x + camera.b * sample.y + camera.c) / w - dx / frame_.half;
    sample.py = (camera.d * sample.x + camera.e * sample.y + camera.f) / w - dy / frame_.half;
    setCovariance(sums, noise, frame_.half, sample);
    samples_.push_back(sample);
  }
}

CameraFit CameraSearch::fitMatches(const CameraModel& expected) {
  listMatches();
  const std::array starts{expected, last_, CameraModel()};
  return fitCamera(samples_, {kAlikeWhole / frame_.half, starts, true}, scratch_);
}

/// Of a motion that is nearly right.
CameraFit CameraSearch::refine(const CameraModel& camera, const Executor& executor) {
  measure(motionOf(camera, frame_), executor);
  listResiduals(camera);
  const std::array starts{camera};
  return fitCamera(samples_, {kAlikeFine / frame_.half, starts, false}, scratch_);
}

/// Refines a motion for as long as that changes it, at most kRefinements times.
CameraFit CameraSearch::approach(const CameraModel& start, const Executor& executor) {
  CameraModel seen = start;
  CameraFit fit = refine(seen, executor);
  for (int i = 1; i < kRefinements && fit.model != seen; ++i) {
    seen = fit.model;
    fit = refine(seen, executor);
  }
  return fit;
}

/// Of any motion. sums_ holds the blocks' gradients.
CameraFit CameraSearch::search(const Executor& executor) {
  matches_.assign(static_cast<size_t>(grid_.count()), {});
  match(last_, kNearReach, executor);
  const CameraFit near = fitMatches(last_);
  if (near.explained >= kEnough) return near;
  CameraModel whole;
  const Point shift = findShift(executor);
  whole.c = -shift.x / frame_.half;
  whole.f = -shift.y / frame_.half;
  match(whole, kFarReach, executor);
  if (shift != Point{}) match({}, kNearReach, executor);
  return fitMatches(whole);
}

CameraMotion CameraSearch::find(const std::shared_ptr<const Picture>& current,
                                const std::shared_ptr<const Picture>& previous,
                                const Executor& executor) {
  const Size size = current->size();
  side_ = (size.width + kColumns - 1) / kColumns;
  std::swap(now_, before_);
  if (nowOf_ != previous) reduce(*previous, executor, before_);
  reduce(*current, executor, now_);
  nowOf_ = current;
  frame_ = CameraFrame::of(now_.small.size());
  grid_ = BlockGrid::of(now_.small.size());
  agreement_ = 0;
  if (grid_.count() == 0) return {};
  CameraFit fit = approach(last_, executor);
  if (fit.explained >= kEnough) {
    inVain_ = 1;
  } else if (fit.model != last_ || fit.explained < kAsMuch * inVain_) {
    measure(motionOf(last_, frame_), executor);
    const CameraFit other = approach(search(executor).model, executor);
    const bool isBetter = other.explained > fit.explained;
    if (isBetter) fit = other;
    inVain_ = isBetter ? 1 : fit.explained;
  }
  const CameraModel& model = fit.model;
  last_ = model;
  agreement_ = fit.sure / grid_.count();
  // The small picture's middle is not quite the picture's.
  const double places = side_, half = frame_.half * places;
  const CameraFrame full{frame_.middleX * places + (places - 1) / 2,
                         frame_.middleY * places + (places - 1) / 2, half};
  const CameraMotion camera =
      isShift(model) ? CameraMotion(shiftOf(model, full)) : motionOf(model, full);
  return camera.isSafe() ? camera : CameraMotion();
}

}  // namespace rg
