// SPDX-License-Identifier: LGPL-2.1-or-later
// The camera's motion from those of the regions (part of stage 5).
//
// A consensus of as many pixels as possible: similarities through two regions each, and shifts, are
// tried on all. What the best one explains is fitted by least squares, of which what doesn't fit is
// left out, by models of more and more freedom: a shift, a similarity, an affinity, a homography.
// Each has to explain so much more than the one before it that its freedom is supported.
//
// Determinism: one thread, a fixed order, and of floating point only what IEEE 754 rounds in one
// way: + − · / √. The result is in integers.
#pragma once

#include "core/motion/motion.hpp"
#include "core/objects/camera/camera_motion.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

struct CameraScratch {
  /// A region; places from the frame's middle and motions as shares of half its diagonal.
  struct Sample {
    double x = 0, y = 0;    ///< Now,
    double px = 0, py = 0;  ///< and before.
    double votes = 0;       ///< Pixels that it stands for, by reliability.
    double weight = 0;      ///< How narrowly it knows its motion.
  };
  std::vector<Sample> samples;  ///< Those that say most first.
  std::vector<double> fitting;  ///< Of each sample, 0 … 1.
  std::vector<uint32_t> order;
};

struct CameraRules {
  motion::RegionMotion shift;           ///< That most pixels agree on.
  CameraMotion before;                  ///< Of the previous frame, what is expected.
  int threshold = motion::kMotionUnit;  ///< Motions that differ by less are alike, 1/16 px.
  std::span<const uint8_t> isDoubtful;  ///< Of each region: an object is expected there. May be
                                        ///< empty.
};

/// How sure it is that there is anything to be seen is the caller's: regions without reliability
/// say nothing, and where all do the result is rules.shift.
[[nodiscard]] CameraMotion fitCamera(const motion::Motion& motion, const CameraRules& rules,
                                     CameraScratch& scratch);

}  // namespace rg::objects
