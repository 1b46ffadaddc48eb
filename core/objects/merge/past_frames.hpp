// SPDX-License-Identifier: LGPL-2.1-or-later
// The frames before this one, as far back as it takes until what moves slowly is seen to move.
//
// From one frame to the next, a slow thing moves by a part of a pixel where frames are small or
// many: its pixels show nothing then. It is therefore compared with a frame that is old enough,
// which is the previous one where frames are large or few. What is fast is compared with the
// previous one.
//
// Determinism: integers, and the products of matrices of core/base/camera/camera_place.hpp.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/picture.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace rg::objects {

struct PastFrame {
  std::shared_ptr<const Picture> picture;
  CameraMotion camera;  ///< Since then.
  int64_t ageNs = 0;
};

class PastFrames {
 public:
  /// All frames are older by stepNs, in which the picture has moved by `camera`.
  void advance(const CameraMotion& camera, int64_t stepNs);
  /// Of those that there are the one whose age is nearest to `ns`; null where there is none. Older
  /// ones are forgotten.
  [[nodiscard]] const PastFrame* nearest(int64_t ns);
  /// The youngest; null where there is none.
  [[nodiscard]] const PastFrame* previous() const {
    return count_ == 0 ? nullptr : &frames_[count_ - 1];
  }
  /// The present frame. Of those before it one for each eighth of `ns` is kept.
  void add(std::shared_ptr<const Picture> picture, int64_t ns);
  void clear();

 private:
  void forget(size_t count);

  static constexpr size_t kMost = 12;  // Eight of an eighth, and where times are uneven.

  std::array<PastFrame, kMost> frames_;  ///< The oldest first.
  size_t count_ = 0;
};

}  // namespace rg::objects
