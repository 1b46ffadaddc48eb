// SPDX-License-Identifier: LGPL-2.1-or-later
// What the pixels say of each region: whether it moves as the camera does or otherwise (part of
// stage 5; U1 of the arcs between regions and the ground, core/objects/merge/mrf_merge.hpp).
//
// Vectors of small or plain regions are uncertain, so the pixels are asked: an earlier frame is
// shifted as the camera moved, and compared with and without a further shift. Tried is the region's
// own vector; where that is the camera's, the step of the object that the region is expected to be;
// then, where neither makes it move, the shift of the moving neighbour with the longest border.
// Which neighbours move is a guess that the energy itself makes, region by region.
//
// Nor is tried what the camera's passing by explains (core/objects/merge/parallax.hpp), but of an
// object that has been followed before.
//
// A quarter of a region does not speak for all of it: of eight bands that lie along the shift the
// two neighbours that gain most are left out, so that plain ground does not go with a mover of its
// colour that was cut together with it. What really moves gains along its whole leading edge, and
// little at its trailing one. So pixels behind which another region lies say nothing: of the ground
// ahead of a mover they are half the mover's.
// What a mover has just left says nothing, as it was not to be seen before: else the ground behind
// it, which another piece of ground explains, would go with it. Nor does it if it is a part of the
// mover; its neighbours then take it along. The pixel behind is left with it: half of that was the
// mover's.
//
// A pixel that differs by more than noise can shows something else, and says no more than that:
// a few of strong contrast don't outweigh all others of a region.
//
// All shifts are whole pixels away from the camera's, so that interpolation smooths the noise of
// both sides alike. Determinism: integer sums over pixels; rounds read the state before them.
#pragma once

#include "core/base/camera/camera_warp.hpp"
#include "core/base/memory/image.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/merge/compared_frame.hpp"
#include "core/objects/merge/mrf_merge.hpp"
#include "core/objects/merge/parallax.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

class Operations;

inline constexpr int kAlikeLevels = 16;  ///< By as much a pixel of the same thing may differ.

/// What speaks for a region's moving otherwise than the camera.
struct OwnMotion {
  Point
      shift;  ///< Whole pixels beyond the camera's that were tried; {} = none, it is the ground's.
  int64_t gain = 0;  ///< Of the pixels by that shift, in units (1/kGainUnit) of the noise of one
                     ///< pixel in a frame of 832x832; below 0 where the camera's motion explains
                     ///< them better.
  [[nodiscard]] bool isTried() const { return shift != Point{}; }
  friend constexpr bool operator==(const OwnMotion&, const OwnMotion&) = default;
};

struct OwnMotionScratch {
  static constexpr int kBands = 8;
  struct Sums {
    uint64_t still = 0;   ///< Of absolute differences without the shift,
    uint64_t moved = 0;   ///< and with it,
    uint64_t pixels = 0;  ///< over so many pixels.
  };
  struct Trial {
    Point shift;        ///< {} = none.
    Sums sums;          ///< Of the bands that are not left out.
    uint64_t seen = 0;  ///< Pixels of all bands.
  };
  Image<uint8_t> expected;     ///< The earlier frame as the camera's motion moves it,
  Image<ShownRange> shown;     ///< and of each row the columns that it shows, in a row of these.
  Image<uint16_t> hidden;      ///< Its pixels that a mover covered: the label of that, else 0;
                               ///< all 0 between measurements.
  std::vector<uint8_t> moves;  ///< Of each region, the guess.
  std::vector<Trial> trials;
  struct Surroundings {
    int64_t hold = 0;      ///< U2 and U3 of the arcs to what moves, less those to what does not.
    uint32_t longest = 0;  ///< Of the borders with what moves, in pixels.
    segmentation::RegionLabel neighbour;  ///< At that.
  };
  std::vector<Surroundings> around;  ///< Of each region.
  uint64_t noise = 0;                ///< Mean difference of a pixel, in 1/16 grey level.
  uint8_t mostLevels = 255;          ///< That the difference of a pixel counts.
  int everyRow = 1;                  ///< Of a region's rows one in so many is compared.
  bool hidesAny = false;             ///< Something moves, so that `hidden` is not all 0.
  uint64_t mostPixels = 0;           ///< That a round of the last call compared.
  int rounds = 0;                    ///< In which it compared any.
};

/// Of a track.
struct ExpectedMotion {
  Point step;               ///< Since the earlier frame, pixels, with the camera's.
  bool isFollowed = false;  ///< For long: what it does is no parallax.
};

struct OwnMotionRules {
  std::span<const ArcEnergy> arcs;  ///< Of the graph, as weighArcs() made them.
  MergeWeights weights;
  std::span<const TrackIndex> expected;  ///< Of each region the track that it is expected to be, or
                                         ///< none. May be empty.
  std::span<const ExpectedMotion> tracks;
  const Parallax* parallax = nullptr;  ///< None: all that stands still is of one plane.
};

/// Nothing was tried of any region yet.
void clearOwnMotion(size_t regions, OwnMotionScratch& scratch, std::vector<OwnMotion>& own);

/// Regions that have not moved by more than a pixel otherwise than the camera have moved with it.
/// own: of each region what the previous frame has shown, if that was asked before this one, or
/// nothing (clearOwnMotion()); with the same scratch. Cost:
/// follows the pixels of the movers and of their neighbours; where no vector differs from the
/// camera's, nothing is compared. Where those are more than half a million pixels (a large frame
/// that moves in parts, or of which the camera's motion was not found), some rows of each region
/// stand for all.
void findOwnMotion(const motion::Motion& motion, const ComparedFrame& compared,
                   const OwnMotionRules& rules, Operations& operations, OwnMotionScratch& scratch,
                   std::vector<OwnMotion>& own);

}  // namespace rg::objects
