// SPDX-License-Identifier: LGPL-2.1-or-later
// Stage 2, element hsvsegment: regions of one colour (paper, section 2.2.2 and 2.3 phase 1.1).
//
// Where the least area allows, regions are grown from cells of 2x2 to 8x8 pixels; then the pixels
// along their borders go where their colours fit. They grow by R'G'B', or by HSV as the paper's do;
// what is too small and the pixels at borders go by R'G'B' in either case.
// Determinism: regions are the components of a predicate on neighbouring pixels, absorption runs in
// synchronous rounds; the result does not depend on any order. Regions count from 1 in the raster
// order of their first pixels.
#pragma once

#include "core/background/background.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/memory/result_plane.hpp"
#include "core/base/picture.hpp"
#include "core/base/result.hpp"
#include "core/base/stage.hpp"
#include "core/base/which.hpp"
#include "core/segmentation/hue_decision.hpp"

#include <cstdint>
#include <memory>

namespace rg::segmentation {

/// Which pixels get a region.
enum class Scope : uint8_t {
  Frame,       ///< All: the camera may move, the largest merged group is the background. No region
               ///< crosses the cover of bgremove's areas, if there are any: inside it they are
               ///< those of Scope::Areas, as far as maxRegions isn't reached.
  Foreground,  ///< Those that bgremove marked, and gaps in them at whose border no colour ends
               ///< (core/base/mask_gaps.hpp); the rest has label 0.
  Areas,       ///< Those that bgremove's areas cover (coverOf); the rest has 0.
};

/// Which region of a frame. Planes of labels hold its number.
using RegionLabel = Which<struct RegionKind, uint16_t>;
inline constexpr uint16_t kNoRegion = RegionLabel().number();  ///< In planes.
inline constexpr int kMostRegions = 65535;
inline constexpr int kAreaMargin = 4;

/// What an area covers: kAreaMargin pixels around its box, up to whole 8x8 cells of the frame.
[[nodiscard]] constexpr Box coverOf(const Box& area, Size frame) {
  constexpr int kCell = 8;
  const Box box = intersect(inflate(area, kAreaMargin), boundsOf(frame));
  const int left = box.x / kCell * kCell, top = box.y / kCell * kCell;
  const int right = (box.right() + kCell - 1) / kCell * kCell;
  const int bottom = (box.bottom() + kCell - 1) / kCell * kCell;
  return intersect({left, top, right - left, bottom - top}, boundsOf(frame));
}
static_assert(coverOf({13, 20, 10, 10}, {40, 30}) == Box{8, 16, 24, 14});

/// What hsvsegment says of one frame. Immutable once published.
struct Labels {
  Size size;
  Status status = Status::Skipped;
  Scope scope = Scope::Frame;
  std::shared_ptr<const Picture> picture;
  std::shared_ptr<const background::Foreground>
      foreground;             ///< None under Scope::Frame without bgremove.
  ResultPlane<uint16_t> ids;  ///< kNoRegion or 1 … count.
  ResultPlane<uint8_t> hue;   ///< What hue says of each pixel (core/segmentation/hue_decision.hpp);
                              ///< empty unless asked.
  uint32_t count = 0;

  void dropSources() {
    picture.reset();
    foreground.reset();
  }
};

struct Params {
  Scope scope = Scope::Frame;
  int similarity = 2;     ///< Largest step between neighbours in one region, in grey levels of a
                          ///< channel of the smoothed picture. 0 … 254; half as much again
                          ///< between cells.
  int minAreaPx = 0;      ///< Smaller regions are absorbed by the neighbour most like them; 0 = by
                          ///< the frame's size. 1 also leaves single pixels alone.
  int maxRegions = 1024;  ///< 1 … kMostRegions, never exceeded.
  /// Hue as a decision. Of the scope's pixels those of an object's hue get a region, those of the
  /// background's don't, and those without a hue follow the foreground, if there is one, and have
  /// none under an objectBand. Label 0 is the background then, whatever the scope.
  HueRules hue{};
  ColourSpace space = ColourSpace::Rgb;  ///< What `similarity` is a step of; a grey picture has one
                                         ///< channel in either.
};

class Stage {
 public:
  virtual ~Stage() = default;
  /// `foreground` may be null under Scope::Frame.
  [[nodiscard]] virtual Result<std::shared_ptr<const Labels>> process(
      std::shared_ptr<const Picture> picture,
      std::shared_ptr<const background::Foreground> foreground, const Params& params) = 0;
  virtual void reset(Reset what) = 0;
};

[[nodiscard]] std::unique_ptr<Stage> makeStage(Context context);

}  // namespace rg::segmentation
