// SPDX-License-Identifier: LGPL-2.1-or-later
// Evidence that things move otherwise than a moving camera adds up from frame to frame (part of
// stage 5; U1 of the arcs between regions and the ground, core/objects/merge/mrf_merge.hpp).
//
// One frame says little: a limb pauses, a wall looks alike a step further, a match is wrong. What
// own_motion found is kept on a grid of samples, and goes along with what it was found of: a sample
// takes over what lay where its region came from, if the previous frame shows the same there and at
// the sample that is nearest to it, which may be another thing's. What a thing uncovers was not to
// be seen before, so that it has nothing to take over. Evidence fades with time, and is taken back
// where pixels follow the ground; it never speaks for the ground.
//
// Determinism: integers, each sample for itself.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/pixel.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/merge/own_motion.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

inline constexpr int kEvidenceStep = 4;  ///< Pixels between samples.
inline constexpr int kAllEvidence = 256;

/// What time leaves of kAllEvidence.
[[nodiscard]] constexpr int leftOfEvidence(int64_t ns) {
  constexpr int64_t kHalfNs = 100'000'000;  // That leave half of it.
  return static_cast<int>(kAllEvidence * kHalfNs / (kHalfNs + std::min(ns, 1000 * kHalfNs)));
}

[[nodiscard]] constexpr Size evidenceGridOf(Size frame) {
  return {(frame.width + kEvidenceStep - 1) / kEvidenceStep,
          (frame.height + kEvidenceStep - 1) / kEvidenceStep};
}
/// Where a region's pixel was in the previous frame.
[[nodiscard]] constexpr Point cameFrom(Point p, const motion::RegionMotion& m) {
  return {p.x - static_cast<int>(divideRounded(m.dx, motion::kMotionUnit)),
          p.y - static_cast<int>(divideRounded(m.dy, motion::kMotionUnit))};
}
/// Whether a pixel may show the same thing still.
[[nodiscard]] constexpr bool showsTheSame(uint8_t now, uint8_t before) {
  return absDiff(now, before) <= kAlikeLevels;
}
/// Where a sample is.
[[nodiscard]] constexpr Point pixelOf(Point sample) {
  return {sample.x * kEvidenceStep, sample.y * kEvidenceStep};
}
/// The sample that is nearest to a pixel.
[[nodiscard]] constexpr Point sampleAt(Point pixel, Size grid) {
  const auto nearest = [](int px, int samples) {
    const int at = (px + kEvidenceStep / 2) / kEvidenceStep;
    return at < samples ? at : samples - 1;
  };
  return {nearest(pixel.x, grid.width), nearest(pixel.y, grid.height)};
}
/// left: of kAllEvidence.
[[nodiscard]] constexpr int16_t fadedGain(int gain, int left) {
  return static_cast<int16_t>(gain * left / kAllEvidence);
}
/// Of a pixel, 0 … kGainUnit.
[[nodiscard]] constexpr int16_t gainWith(int gain, int more) {
  const int sum = gain + more, most = static_cast<int>(kGainUnit);
  return static_cast<int16_t>(sum < 0 ? 0 : sum > most ? most : sum);
}

/// What is known, of the previous frame, and where this one's regions come from.
struct KnownEvidence {
  const motion::Motion& motion;
  const Picture& previous;
  const Image<int16_t>& gains;  ///< By samples.
  int left;                     ///< Of kAllEvidence.
};
/// What of it this frame's regions show.
struct CarriedEvidence {
  Image<int16_t>& gains;        ///< By samples; has their size.
  std::span<int64_t> sums;      ///< Of each region, 0 before,
  std::span<uint32_t> samples;  ///< and of how many.
};
void carryEvidence(const KnownEvidence& known, const Executor& executor,
                   const CarriedEvidence& carried);

/// sum: `gains` and what each region shows by a pixel in this frame; has their size.
void addEvidence(const graph::Graph& graph, std::span<const int16_t> density,
                 const Image<int16_t>& gains, const Executor& executor, Image<int16_t>& sum);

class MotionEvidence {
 public:
  /// What was known is carried to this frame's regions. previous: what `motion` was measured
  /// against, stepNs before; null where nothing can be carried.
  void carry(const motion::Motion& motion, const Picture* previous, int64_t stepNs,
             Operations& operations);
  /// No frame is like those before.
  void reset();
  /// What a region's pixels have shown in earlier frames, as OwnMotion's gain.
  [[nodiscard]] int64_t gainOf(size_t region) const { return carried_[region]; }
  /// And what they show in this one is added. own: one entry per region.
  void add(const motion::Motion& motion, std::span<const OwnMotion> own, Operations& operations);

 private:
  Size frame_;
  Image<int16_t> known_;           ///< Gain of a pixel, by samples;
  Image<int16_t> shown_;           ///< what of that this frame shows.
  bool hasAny_ = false;            ///< Not all of that is 0.
  std::vector<int64_t> carried_;   ///< Of each region.
  std::vector<int64_t> sums_;      ///< Of each region's samples,
  std::vector<uint32_t> samples_;  ///< and how many there are.
  std::vector<int16_t> density_;   ///< Of each region in this frame.
};

}  // namespace rg::objects
