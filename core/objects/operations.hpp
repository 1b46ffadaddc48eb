// SPDX-License-Identifier: LGPL-2.1-or-later
// What the stage does with all pixels, step by step: by the functions of this room, or by a
// device's counterparts of them. Which of the two did a step can't be seen in its result.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/objects/merge/motion_evidence.hpp"
#include "core/objects/merge/own_motion.hpp"
#include "core/objects/tracking/looks/object_pixels.hpp"

#include <cstdint>
#include <span>

namespace rg::objects {

/// What compareRegions() compares.
struct ComparedRegions {
  const ComparedFrame& earlier;
  const motion::Motion& motion;
  std::span<const OwnMotion> own;
};

/// Each does what the function of its name does; this class does it on the CPU. What they read and
/// write is on the host afterwards, too, but for what expectFrame() fills in.
class Operations {
 public:
  explicit Operations(const Executor& executor) : executor_(executor) {}
  virtual ~Operations() = default;
  Operations(const Operations&) = delete;
  Operations& operator=(const Operations&) = delete;

  /// warpByCamera(): s.expected and s.shown, for compareRegions() with the same frame.
  virtual void expectFrame(const ComparedFrame& earlier, OwnMotionScratch& s);
  virtual void compareRegions(const ComparedRegions& regions, OwnMotionScratch& s);
  virtual void carryEvidence(const KnownEvidence& known, const CarriedEvidence& carried);
  virtual void addEvidence(const graph::Graph& graph, std::span<const int16_t> density,
                           const Image<int16_t>& gains, Image<int16_t>& sum);
  virtual void findObjectPixels(const graph::Graph& graph, std::span<const uint8_t> isBackground,
                                const OwnedCells& cells, const ObjectPixels& pixels);

 private:
  const Executor& executor_;
  ObjectPixelScratch pixelScratch_;
};

}  // namespace rg::objects
