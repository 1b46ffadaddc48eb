// SPDX-License-Identifier: LGPL-2.1-or-later
// Parts groups of regions in which two things move apart.
//
// An arc says little where one of its regions is a leg or a sleeve, and a chain of such regions
// ties people together who walk past each other. Here regions are joined one arc after the other,
// those first that were one object and that move most alike, and what was joined is compared as a
// whole. Then limbs go back to the bodies that they hang from.
//
// Determinism: integers; arcs in the order of (expected objects, difference, border, labels).
#pragma once

#include "core/base/geometry.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/indices.hpp"
#include "core/objects/numbers.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// Something that moves, and how much of it says so.
struct Mover {
  int64_t dx = 0, dy = 0;  ///< In 1/16 px per frame.
  int64_t weight = 0;      ///< In any unit, of both that are compared.
};

/// Whether two things move apart: by `least` if the smaller one has `smallShare` of the other's
/// weight, by more the less there is of it, for the more its motion is off.
[[nodiscard]] bool moveApart(const Mover& a, const Mover& b, int64_t least,
                             Number smallShare = Numbers::Layers{}.smallShare);

struct LayerScratch {
  struct Layer {
    Box box;
    int64_t areaPx = 0;
    int64_t weight = 0;  ///< Sum of area x reliability.
    int64_t momentX = 0, momentY = 0;
    int64_t expectedPx = 0;
    TrackIndex expected;  ///< What most of it is expected to be.
  };
  struct Link {
    uint64_t key = 0;
    uint32_t a = 0, b = 0;
  };
  std::vector<Layer> layers;  ///< Each at its smallest region.
  std::vector<Link> links;
  std::vector<uint32_t> parent;
};

/// Replaces the groups by their parts that don't move apart, numbered by their first regions.
/// trends: core/objects/merge/motion_trends.hpp; expected: of each region the track that it is
/// predicted to be, or none.
void partGroups(const motion::Motion& trends, std::span<const TrackIndex> expected,
                LayerScratch& scratch, std::vector<uint32_t>& groupOf,
                const Numbers::Layers& numbers = {});

}  // namespace rg::objects
