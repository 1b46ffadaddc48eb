// SPDX-License-Identifier: LGPL-2.1-or-later
// The camera's motion from those of parts of the picture.
//
// A consensus of as many parts as possible: what was expected, a shift, and similarities through
// two parts each are tried on all. What the best one explains is fitted by least squares, of which
// what doesn't fit is left out, by models of more and more freedom: none, a shift, a similarity, an
// affinity, a homography. Each has to explain so much more than the one before it that its freedom
// is supported.
//
// Each part counts by how narrowly it knows its motion, along each direction for itself, but none
// for more than what motions that count as alike may differ by: a thing of strong contrast is not
// louder than a faint ground of the same extent.
//
// Determinism: one thread, a fixed order, and of floating point only what IEEE 754 rounds in one
// way: + − · / √. The result is in integers.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/geometry.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg {

/// A homography in double precision, of places from the picture's middle as shares of half its
/// diagonal: previous = (a x + b y + c, d x + e y + f) / (g x + h y + 1).
struct CameraModel {
  double a = 1, b = 0, c = 0, d = 0, e = 1, f = 0, g = 0, h = 0;
  friend constexpr bool operator==(const CameraModel&, const CameraModel&) = default;
};

/// What a part of the picture says.
struct CameraSample {
  double x = 0, y = 0;            ///< Now,
  double px = 0, py = 0;          ///< and before, both as shares of half the diagonal.
  double xx = 0, xy = 0, yy = 0;  ///< Covariance of (px, py).
  [[nodiscard]] bool operator==(const CameraSample&) const = default;
};

struct CameraFitScratch {
  struct Weights {
    double xx = 0, xy = 0, yy = 0;  ///< Of the two directions, at most 1.
    double vote = 0;                ///< Their mean,
    double sure = 0;                ///< and that of the direction that it knows less of.
    double fitting = 0;             ///< How well the model explains it, 0 … 1.
  };
  std::vector<Weights> weights;  ///< Of each sample.
};

struct CameraFitRules {
  double alike = .01;                     ///< Motions that differ by less are; shares.
  std::span<const CameraModel> expected;  ///< Where to start from.
  bool triesPairs = true;                 ///< Similarities through two samples are tried, too.
};

struct CameraFit {
  CameraModel model;
  double explained = 0;  ///< Share of the votes that agree with it.
  double votes = 0;      ///< All of them.
  double sure = 0;       ///< Samples that agree, each as far as it knows both directions.
};

[[nodiscard]] CameraFit fitCamera(std::span<const CameraSample> samples,
                                  const CameraFitRules& rules, CameraFitScratch& scratch);

/// Where a picture's middle lies, and half its diagonal; pixels.
struct CameraFrame {
  double middleX = 0, middleY = 0, half = 1;
  [[nodiscard]] static CameraFrame of(Size size);
};

[[nodiscard]] bool isShift(const CameraModel& model);
/// Of a model that is one, in 1/16 px.
[[nodiscard]] Point shiftOf(const CameraModel& model, const CameraFrame& frame);
[[nodiscard]] CameraMotion motionOf(const CameraModel& model, const CameraFrame& frame);

}  // namespace rg
