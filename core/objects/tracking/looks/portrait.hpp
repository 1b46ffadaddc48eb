// SPDX-License-Identifier: LGPL-2.1-or-later
// What a thing looks like pixel by pixel, learnt while all of it was seen, and where it is when
// only a part of it is: behind another thing, behind the scene, or in a blob of several.
//
// Each sample is compared with the frame: foreground of its colour speaks for a place, and more so
// at an edge that the frame has there, too; foreground of another colour and background speak
// against it, what another thing covers says nothing.
//
// Determinism: integers; of equal places the shorter shift wins, then the higher, then the one
// further left.
#pragma once

#include "core/base/picture.hpp"
#include "core/base/pixel.hpp"
#include "core/objects/tracking/group_grid.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

enum PortraitEdge : uint8_t { kLeftEdge = 1, kRightEdge = 2, kTopEdge = 4, kBottomEdge = 8 };

/// A colour and in how many of the last frames it belonged to the thing.
struct PortraitSample {
  uint8_t red = 0, green = 0, blue = 0;
  uint8_t weight = 0;
  uint8_t edges = 0;  ///< Where it is solid and its neighbour isn't, of PortraitEdge.
};

struct Portrait {
  Size sizePx;
  int stepPx = 1;  ///< Distance of samples, so that there are some thousand at most.
  Size grid;
  std::vector<PortraitSample> samples;  ///< Row by row.
  uint32_t frames = 0;                  ///< From how many it was learnt.
  uint16_t usual = 0;  ///< Share of its samples that agree while all of it is seen, in 1/256.

  static constexpr uint32_t kMostWeight = 8;
  /// Of samples that belong to the thing more often than not.
  [[nodiscard]] uint32_t leastWeight() const {
    return std::max(1u, (std::min(frames, kMostWeight) + 1) / 2);
  }
  [[nodiscard]] bool isSolid(const PortraitSample& sample) const {
    return sample.weight >= leastWeight();
  }
};

inline constexpr int kAlike = 32;  ///< What the differences of three channels stay below.

/// The planes of a picture, found once for many samples.
class PortraitColours {
 public:
  explicit PortraitColours(const Picture& picture)
      : red_(picture.red().data),
        green_(picture.green().data),
        blue_(picture.blue().data),
        strideBytes_(picture.red().strideBytes) {}

  [[nodiscard]] ptrdiff_t strideBytes() const { return strideBytes_; }
  [[nodiscard]] ptrdiff_t placeOf(int x, int y) const { return y * strideBytes_ + x; }
  [[nodiscard]] int difference(const PortraitSample& s, ptrdiff_t place) const {
    return absDiff(s.red, red_[place]) + absDiff(s.green, green_[place]) +
           absDiff(s.blue, blue_[place]);
  }
  /// Whether a pixel has about the colour of a sample.
  [[nodiscard]] bool agrees(const PortraitSample& sample, ptrdiff_t place) const {
    return difference(sample, place) < kAlike;
  }
  [[nodiscard]] graph::Colour at(ptrdiff_t place) const {
    return {red_[place], green_[place], blue_[place]};
  }

 private:
  const uint8_t *red_, *green_, *blue_;
  ptrdiff_t strideBytes_;  ///< Of each of them.
};

/// What is looked at.
struct PortraitScene {
  const GroupGrid& evidence;
  const Picture& picture;
  std::span<const uint8_t> taken;  ///< Of each cell: 1 = another thing covers it. May be empty.
};

struct PortraitMatch {
  Point shift;            ///< From the expected corner, in 1/16 px.
  int64_t gain = 0;       ///< What speaks for the place, less what its distance costs.
  uint32_t samples = 0;   ///< Solid ones.
  uint32_t agreeing = 0;  ///< Of those, foreground of the same colour.
  uint32_t seen = 0;      ///< Of those, foreground that nothing else covers.
  uint32_t covered = 0;   ///< Of those, what another thing covers.
  uint32_t ground = 0;    ///< Of those, where the background is seen.

  /// Gain of a sample, in 1/256.
  [[nodiscard]] int64_t value() const {
    return samples == 0 ? 0 : gain * 256 / static_cast<int64_t>(samples);
  }
  /// Samples within the frame.
  [[nodiscard]] uint32_t inside() const { return seen + covered + ground; }
  /// Share that agrees, in 1/256.
  [[nodiscard]] uint32_t share() const { return samples == 0 ? 0 : agreeing * 256 / samples; }
};

/// Where to look. Distance costs: a third of the size all that can be gained, with `turn` added to
/// that third, so many pixels a thing may be off because it turned round; `calm` times less.
struct PortraitSearch {
  Point corner;  ///< Expected, in pixels.
  Point reach;   ///< The most on either side, in pixels.
  int calm = 1;
  Point turn;
  int32_t appearance = 256;  ///< Weight of the colours against the distance, in 1/256, not 0.
};

struct PortraitScratch {
  struct Solid {
    ptrdiff_t stateAt, pixelAt;  ///< From those of the corner.
    PortraitSample sample;
  };
  struct Samples {
    std::vector<Solid> list;
    std::vector<int64_t> most;  ///< Of each block: what it and all after it can gain.
  };
  std::vector<uint8_t> state;  ///< Of the pixels of the search window.
  Samples all, some;
  uint64_t looks = 0;  ///< At samples, by the last search.
};

/// Mixes in what is at `corner`, where `owner` says `own`. Another size begins anew.
void learn(Portrait& portrait, const PortraitScene& scene, Point corner, Size sizePx,
           std::span<const uint16_t> owner, uint16_t own);

/// The pixels that the result of a search depends on.
[[nodiscard]] Box searchedBox(const Portrait& portrait, const GroupGrid& evidence,
                              const PortraitSearch& where);

[[nodiscard]] PortraitMatch findPortrait(const Portrait& portrait, const PortraitScene& scene,
                                         const PortraitSearch& where, PortraitScratch& s,
                                         const Numbers::Likeness& numbers = {});

/// Calls visit(cell, agrees) for the cells of the grid whose middle shows a solid sample of the
/// portrait at `corner`, is foreground and isn't taken.
template <class Visit>
void forPortraitCells(const Portrait& portrait, const PortraitScene& scene, Point corner,
                      const Visit& visit);

template <class Visit>
void forPortraitCells(const Portrait& p, const PortraitScene& scene, Point corner,
                      const Visit& visit) {
  const GroupGrid& e = scene.evidence;
  const PortraitColours colours(scene.picture);
  const int step = e.stepPx;
  const Box cells = intersect({(corner.x + step - 1) / step - 1, (corner.y + step - 1) / step - 1,
                               p.sizePx.width / step + 2, p.sizePx.height / step + 2},
                              boundsOf(e.grid));
  for (int y = cells.y; y < cells.bottom(); ++y)
    for (int x = cells.x; x < cells.right(); ++x) {
      const size_t cell = e.at(x, y);
      if (e.group[cell] == 0 || (!scene.taken.empty() && scene.taken[cell] != 0)) continue;
      const Point middle = e.middleOf(x, y);
      const Point in{middle.x - corner.x, middle.y - corner.y};
      if (!boundsOf(p.sizePx).contains(in)) continue;
      const int column = in.x / p.stepPx, row = in.y / p.stepPx;
      const PortraitSample& sample = p.samples[static_cast<size_t>(row * p.grid.width + column)];
      if (p.isSolid(sample))
        visit(cell, colours.agrees(sample, colours.placeOf(middle.x, middle.y)));
    }
}

}  // namespace rg::objects
