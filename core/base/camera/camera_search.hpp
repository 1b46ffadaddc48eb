// SPDX-License-Identifier: LGPL-2.1-or-later
// How a camera has moved since the previous frame, from the pixels of both.
//
// Both frames are looked at as small pictures of at most 256 columns, in blocks of 8x8. What the
// pixels of each block differ by from what a motion makes expect, along their gradients, says how
// far off that is (Gauss and Newton's way), block by block, and camera_fit makes a motion of it;
// the first is that of the frame before. Where it explains too few, each block is looked for where
// the camera was heading, then where the picture as a whole has gone (tried on still smaller
// pictures), and of the motion from there and that of the frame before, both made as fine as
// possible, the one counts that explains more. That is not done again while the camera goes on just
// as it did when it was done in vain.
//
// Determinism: integers on pixels; camera_fit tells of the rest.
#pragma once

#include "core/base/camera/camera_fit.hpp"
#include "core/base/camera/camera_motion.hpp"
#include "core/base/camera/picture_blocks.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"

#include <memory>
#include <vector>

namespace rg {

class CameraSearch {
 public:
  /// The motion from `previous` to `current`, pictures of one size. None where nothing tells.
  [[nodiscard]] CameraMotion find(const std::shared_ptr<const Picture>& current,
                                  const std::shared_ptr<const Picture>& previous,
                                  const Executor& executor);
  /// Share of the picture that knows its motion and agrees with what was found last, 0 … 1.
  [[nodiscard]] double agreement() const { return agreement_; }
  /// The next frame has nothing to do with those before.
  void reset();

 private:
  struct Reduced {
    Image<uint8_t> small, tiny;
  };

  void reduce(const Picture& picture, const Executor& executor, Reduced& to) const;
  [[nodiscard]] Point findShift(const Executor& executor);
  void match(const CameraModel& camera, int reach, const Executor& executor);
  void measure(const CameraMotion& camera, const Executor& executor);
  void listMatches();
  [[nodiscard]] CameraFit fitMatches(const CameraModel& expected);
  [[nodiscard]] CameraFit refine(const CameraModel& camera, const Executor& executor);
  [[nodiscard]] CameraFit approach(const CameraModel& start, const Executor& executor);
  [[nodiscard]] CameraFit search(const Executor& executor);
  void listResiduals(const CameraModel& camera);
  [[nodiscard]] double noise();

  int side_ = 1;
  CameraFrame frame_;  ///< Of the small pictures.
  BlockGrid grid_;
  Reduced now_, before_;
  std::shared_ptr<const Picture> nowOf_;  ///< Whose pictures now_ holds.
  CameraModel last_;
  double agreement_ = 0;
  double inVain_ = 1;  ///< Share explained when a search found nothing better; 1 = none has.
  std::vector<uint32_t> differences_;  ///< Of each shift of the tiny pictures.
  std::vector<Point> shifts_;
  std::vector<BlockMatch> matches_;
  std::vector<BlockSums> sums_;
  std::vector<double> variances_;
  std::vector<CameraSample> samples_;
  CameraFitScratch scratch_;
};

}  // namespace rg
