// SPDX-License-Identifier: LGPL-2.1-or-later
// What moves otherwise than a moving camera, in this frame and in those before it (part of stage
// 5).
//
// A region is compared with the previous frame and with one that is old enough for a slow thing to
// have moved by a pixel (core/objects/merge/past_frames.hpp); of the two, that counts which speaks
// more for a motion of its own. What was found is kept (core/objects/merge/motion_evidence.hpp).
#pragma once

#include "core/objects/merge/motion_evidence.hpp"
#include "core/objects/merge/own_motion.hpp"
#include "core/objects/merge/parallax.hpp"
#include "core/objects/merge/past_frames.hpp"
#include "core/objects/tracking/track.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

struct MoverRules {
  std::span<const ArcEnergy> arcs;  ///< Of the graph, as weighArcs() made them.
  MergeWeights weights;
  std::span<const TrackIndex> expected;  ///< Of each region the track that it is expected to be.
  std::span<const Track> tracks;
  int64_t stepNs = 0;      ///< Since the previous frame.
  int64_t perPixelNs = 0;  ///< In which a slow thing moves by a pixel.
  Numbers::Parallax parallax;
};

class Movers {
 public:
  void find(const motion::Motion& motion, const MoverRules& rules, Operations& operations);
  /// What find() has found is known to the frames that follow.
  void remember(const motion::Motion& motion, const MoverRules& rules, Operations& operations);
  /// No frame is like those before.
  void reset();

  /// Of each region, in this frame.
  [[nodiscard]] std::span<const OwnMotion> own() const { return own_; }
  /// What a region's pixels have shown in earlier frames, as OwnMotion's gain.
  [[nodiscard]] int64_t gainBefore(size_t region) const { return evidence_.gainOf(region); }
  /// Of each region whether it is guessed to move.
  [[nodiscard]] std::vector<uint8_t>& moves() { return scratch_.moves; }

 private:
  void compareWith(const PastFrame& past, const motion::Motion& motion, const MoverRules& rules,
                   Operations& operations);

  PastFrames past_;
  Parallax parallax_;
  std::vector<uint8_t> isKnown_;  ///< Of each region, by an object that has been followed.
  MotionEvidence evidence_;
  OwnMotionScratch scratch_;
  std::vector<OwnMotion> own_;
  std::vector<OwnMotion> sinceLast_;      ///< What the previous frame alone shows.
  std::vector<ExpectedMotion> expected_;  ///< Of each track, since the frame that is compared.
};

}  // namespace rg::objects
