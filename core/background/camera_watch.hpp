// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether the camera goes somewhere, so that no model of what stands still can hold (part of stage
// 1).
//
// Its motion is found on small pictures of two frames (core/base/camera/camera_search.hpp), and
// added up at the frame's corners: a camera that sways comes back, one that is turned does not.
//
// Determinism: that of the search; sums of integers.
#pragma once

#include "core/base/camera/camera_search.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/picture.hpp"
#include "core/base/time/frame_clock.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace rg::background {

class CameraWatch {
 public:
  /// To be called for each frame, before it is asked about. None: nobody wants to know, and what
  /// was known is forgotten.
  void show(std::shared_ptr<const Picture> picture);
  /// The next frame does not follow the last one.
  void breakOff();

  /// Has been moving since it was told to start, until it was told to stop.
  [[nodiscard]] bool isMoving() const { return isMoving_; }
  /// Of a camera that stood still, in a frame that is off the model or still teaches it: whether it
  /// has gone away within a second of such frames.
  [[nodiscard]] bool starts(bool differsEverywhere, const FrameClock& clock,
                            const Executor& executor);
  /// In a frame like any other: what starts() has added up says nothing, nor the pictures that it
  /// was found in.
  void passOver();
  /// Of a camera that moves: whether it has stood still for long enough, or swayed for longer. A
  /// picture that tells nothing, as the sea's, stands.
  [[nodiscard]] bool stops(const FrameClock& clock, const Executor& executor);
  /// It is taken to stand from now on.
  void rest() { isMoving_ = false; }

  /// What the one or the other of these has seen last, and since which picture; none without one.
  [[nodiscard]] const CameraMotion& motion() const { return motion_; }
  [[nodiscard]] const std::shared_ptr<const Picture>& since() const { return previous_; }

 private:
  /// Of the frame's corners, in 1/16 px, and the frames that they took.
  struct Way {
    std::array<Point, 4> corners;
    int64_t frames = 0;
  };

  void reset();
  [[nodiscard]] bool look(const Executor& executor);
  void goOn(Way& way) const;
  [[nodiscard]] bool isAtLeast(const Way& way, int share) const;

  std::shared_ptr<const Picture> previous_, current_;
  CameraSearch search_;
  CameraMotion motion_;
  Way way_;    ///< Until it starts; then, until it has gone as far as tells that it moves.
  Way range_;  ///< Of a camera that moves: until it has gone further than one that sways.
  bool isMoving_ = false;
};

}  // namespace rg::background
