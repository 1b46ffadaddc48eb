// SPDX-License-Identifier: LGPL-2.1-or-later
// What has happened to a scene of which much differs from its model: no light, no colour, a camera
// that was pushed. All but isEverywhere() look at a grid of at most 4096 points.
//
// Determinism: integer sums over fixed points, one after the other.
#pragma once

#include "core/background/models/consensus_background.hpp"
#include "core/base/bit_mask.hpp"
#include "core/base/geometry.hpp"
#include "core/base/memory/executor.hpp"

namespace rg::background {

/// Nothing to be seen: no more than one point in 50 is brighter than `level`. Something lit before
/// pure black is seen all the same: there is no noise to be taken for it, as in drawn pictures.
[[nodiscard]] bool isDarkerThan(const SmoothPicture& picture, int level);

/// The picture has lost its colour against the model, or has got some: a camera that switched
/// between day and night (infra-red) view. Never in a grey picture.
[[nodiscard]] bool hasSwitchedColour(const SmoothPicture& picture,
                                     const ConsensusBackground& model);

/// How far the model's content is from where the picture shows it, at most 3 pixels each way:
/// model(p + shift) = picture(p). {0, 0} unless that explains at least a quarter of the difference;
/// the smallest of equal ones.
[[nodiscard]] Point findShift(const SmoothPicture& picture, const ConsensusBackground& model);

/// Moves the picture's content by `shift`; its border is repeated. `spare` is scratch.
void shiftPicture(Point shift, const Executor& executor, SmoothPicture& spare,
                  SmoothPicture& picture);

/// Of 8x8 fields of the frame three quarters have at least an eighth of their pixels set: no object
/// looks like that.
[[nodiscard]] bool isEverywhere(const BitMask& raw);

}  // namespace rg::background
