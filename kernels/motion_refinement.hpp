// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/motion/refinement: from whole-pixel vectors of regions to fractions of a
// pixel without a wait between.
#pragma once

#include "core/motion/refinement/refinement_rules.hpp"
#include "kernels/launch.hpp"
#include "kernels/shift_search.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu::motion {

/// The same picture before and after; `previous` is padded by more than any displacement, and a
/// pixel.
struct SeenPlane {
  ImageView<const uint8_t> luma;
  PaddedView previous;
};
/// As it is, and smoothed.
struct SeenPlanes {
  SeenPlane plain, smooth;
};

/// What a region's fits need; contents undefined before fitAlone().
struct FitState {
  rg::motion::MotionFit own;  ///< That the pixels alone say.
  rg::motion::MotionFit fit, mine;
  Point start;
  int64_t known;     ///< The least information of `own`.
  uint8_t isSmooth;  ///< `own` is of the smoothed plane.
  rg::motion::FitMoments moments;
  rg::motion::FitEquations equations;
};

/// Regions with or without parts. [i] of each list: region i's.
struct RefinedRegions {
  MatchedRegions parts;
  const rg::motion::RefinedRegion* regions;
  FitState* states;
};
/// What the search for a consensus begins with.
struct SeenMotions {
  rg::motion::SeenMotion* own;
  int32_t* ownTrust;
  rg::motion::MotionBelief* beliefs;
  rg::motion::MotionPrior* priors;  ///< None.
};

/// rg::motion::MotionNeighbours.
struct NeighboursView {
  const uint32_t *starts, *counts;
  const rg::motion::MotionNeighbour* list;
};

/// Fits each region alone, on the plane that tells more.
void fitAlone(const RefinedRegions& regions, const SeenPlanes& planes, const SeenMotions& out,
              Stream stream);
/// rg::motion::MotionConsensus::run of what fitAlone() found. Leaves in seen.priors what neighbours
/// expect; seen.beliefs and the scratch, of one for each region, change.
void findConsensus(const NeighboursView& neighbours, const SeenMotions& seen,
                   rg::motion::MotionBelief* scratch, int regions, Stream stream);
/// Fits each region again, with what its neighbours expect, and changes `motion`.
void fitTogether(const RefinedRegions& regions, const SeenPlanes& planes,
                 const rg::motion::MotionPrior* priors, rg::motion::RegionMotion* motion,
                 Stream stream);

}  // namespace rg::gpu::motion
