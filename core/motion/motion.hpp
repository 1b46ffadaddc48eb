// SPDX-License-Identifier: LGPL-2.1-or-later
// Stage 4, element prmmotion: partitioned region matching (paper, section 2.3 phase 2.1).
//
// A region's vector is the shift d = (dx, dy) that makes SAD(d) = sum over its matched pixels x of
// |I_t(x) − I_t−1(x − d)| smallest: by how much it moved since the previous frame. Matched are the
// pixels away from the region's border (core/motion/matched_blocks.hpp). Pixels outside the
// previous frame repeat its border. The fraction of a pixel follows from the gradients, and what a
// region can't tell itself, from its neighbours (core/motion/refinement/motion_refinement.hpp).
//
// The reliability is what the region itself saw: low where the luma is flat, or changes along one
// direction only, where another shift matches nearly as well, where the match is poor or differs
// from the neighbours', where part of it lies outside the previous frame.
// Method::Literal is what the paper says and no more: all pixels of each region, whole pixels, and
// nothing of the neighbours (core/motion/literal_search.hpp).
// Determinism: integer sums. Tie-break: smallest (SAD, |d|², dy, dx).
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/result.hpp"
#include "core/base/stage.hpp"
#include "core/graph/graph.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace rg::motion {

inline constexpr int kMotionFractionBits = 4;  ///< Vectors are in 1/16 px.
inline constexpr int kMotionUnit = 1 << kMotionFractionBits;
inline constexpr int kFullReliability = 256;

inline constexpr uint64_t kNotMatched = UINT64_MAX;  ///< A SAD: nothing has been found.

struct RegionMotion {
  int32_t dx = 0;  ///< In 1/16 px, from the previous frame to this one.
  int32_t dy = 0;
  uint64_t sad = 0;          ///< Of the matched pixels at the best whole shift.
  uint16_t reliability = 0;  ///< 0 (says nothing) … kFullReliability.
};

/// What prmmotion says of one frame; regions[i] is that of the label of index i. Immutable once
/// published.
struct Motion {
  Size size;
  Status status = Status::Skipped;  ///< Skipped where there is no previous frame: all vectors are 0
                                    ///< with reliability 0.
  std::shared_ptr<const graph::Graph> graph;
  std::vector<RegionMotion> regions;
  CameraMotion camera;         ///< Where all of the frame is segmented; none elsewhere.
  uint32_t matchedBlocks = 0;  ///< Of 4x1 pixels, over all regions.
  uint32_t stillBlocks = 0;    ///< Of those, in regions where no pixel changed: not searched.

  void dropSources() { graph.reset(); }
};

enum class Method : uint8_t {
  Refined,  ///< Pixels away from borders, then fractions of a pixel and the neighbours' say.
  Literal,  ///< Whole pixels by the SAD of all of a region's pixels, each region alone.
};

struct Params {
  int maxShiftPx = 0;      ///< Searched in both directions of both axes. 1 … 64; 0 = as far as
                           ///< what crosses the frame's height in a second gets, 20 … 64; 20 by
                           ///< Method::Literal.
  bool isSubpixel = true;  ///< False: the best whole-pixel shifts, of no neighbour's influence.
                           ///< Of Method::Refined.
  Method method = Method::Refined;
};

class Stage {
 public:
  virtual ~Stage() = default;
  [[nodiscard]] virtual Result<std::shared_ptr<const Motion>> process(
      std::shared_ptr<const graph::Graph> graph, const Params& params, FrameTime time) = 0;
  virtual void reset(Reset what) = 0;
};

[[nodiscard]] std::unique_ptr<Stage> makeStage(Context context);

}  // namespace rg::motion
