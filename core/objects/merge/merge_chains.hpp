// SPDX-License-Identifier: LGPL-2.1-or-later
// Second half of the local search of core/objects/merge/mrf_merge.hpp: several nodes that change
// groups together, where no single one would.
//
// Determinism: nodes in the order of their numbers, ties by number.
#pragma once

#include "core/objects/merge/mrf_merge.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

/// From each node that has a motive (a negative arc in its group, or a positive one out of it),
/// lets it and then up to kMostFollowers of its neighbours, best first, move between its group and
/// another, or an empty one; keeps as much of the chain as gains weight. Needs scratch.firstArc and
/// scratch.neighbours. Returns whether anything moved.
/// What it did before on the same arcs it knows by scratch.searched, and leaves out what can't have
/// come to gain anything since; the first search is one with scratch.searched empty.
/// Ends early, and says so in scratch.isCutShort, once scratch.visits has come to
/// scratch.visitLimit.
bool moveChains(std::vector<uint32_t>& groupOf, MergeScratch& scratch);

}  // namespace rg::objects
