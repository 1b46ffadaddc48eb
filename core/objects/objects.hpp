// SPDX-License-Identifier: LGPL-2.1-or-later
// Stage 5, element mrfmerge: regions merged by motion become objects that keep their identity
// (paper, section 2.3 phases 2.2 to 2.5).
//
// Determinism: integers in state and decisions. Objects sorted by id, ids count from 1 and are
// never used again within a stream. What was told can be held back to be told with what comes later
// (object_delay.hpp), kept in little memory (result_packer.hpp), and told as of a part of the frame
// (result_placer.hpp, placement_matrix.hpp).
#pragma once

#include "core/base/result.hpp"
#include "core/base/stage.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/numbers.hpp"
#include "core/objects/object.hpp"
#include "core/objects/object_delay.hpp"
#include "core/objects/placement_matrix.hpp"
#include "core/objects/result_packer.hpp"
#include "core/objects/result_placer.hpp"

#include <cstdint>
#include <memory>

namespace rg::objects {

enum class Method : uint8_t {
  Extended,  ///< Regions by their trends and layers, and the ground as a node of the graph.
  Literal,   ///< As the paper says: the energy over the regions and their motion in this frame
             ///< alone decides. The largest group is the background, and its motion the camera's;
             ///< what has no region counts as one group that stands still.
};

/// Weights of the energy U = U1 + U2 + U3 + prediction (core/objects/merge/mrf_merge.hpp), and the
/// tracker's times.
struct Params {
  double motionWeight = 1.0;      ///< Of U1: what keeping regions together costs that move apart.
  double borderWeight = 2.0;      ///< Of U2: what a pixel of border between two groups costs where
                                  ///< it shows no edge.
  double arcWeight = 1.0;         ///< Of U3: what a broken arc between like colours costs, in
                                  ///< sixteenths of the root of the frame's area.
  double predictionWeight = 2.0;  ///< What it costs to part regions that were expected to be one
                                  ///< object.
  double appearanceWeight = 1.0;  ///< Of how alike what is seen and an object look, against how far
                                  ///< from its expected place that is.
  double motionThreshold = 4.5;   ///< Speeds that differ by less are alike; percent of the root of
                                  ///< the frame's area per second.
  double maxLostTimeS = 2.0;      ///< An object that is not seen for longer ends.
  double minObjectArea = 0.0;     ///< Share of the frame, in percent; 0 = learnt from the scene.
  Method method = Method::Extended;
  Numbers numbers{};
};

/// What mrfmerge looks at in one frame.
struct Input {
  std::shared_ptr<const motion::Motion> motion;
  std::shared_ptr<const background::Foreground> foreground;  ///< That the regions lie in; may be
                                                             ///< null.

  Input() = default;
  /// The foreground that the motion's regions were found in.
  Input(std::shared_ptr<const motion::Motion> found);  // NOLINT(google-explicit-constructor)
};

class Stage {
 public:
  virtual ~Stage() = default;
  [[nodiscard]] virtual Result<std::shared_ptr<const Objects>> process(Input in,
                                                                       const Params& params,
                                                                       FrameTime time) = 0;
  /// Ends of tracks that this causes are told by the next frame's events.
  virtual void reset(Reset what) = 0;
};

[[nodiscard]] std::unique_ptr<Stage> makeStage(Context context);

}  // namespace rg::objects
