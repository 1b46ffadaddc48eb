// SPDX-License-Identifier: LGPL-2.1-or-later
// First half of the search of core/objects/merge/mrf_merge.hpp: groups that like each other best
// become one, as long as that keeps more weight.
//
// Determinism: the heaviest arc first, then a hash of the two groups, then the groups, each of them
// called by its smallest number; so the result depends on the graph and the start alone.
#pragma once

#include "core/objects/merge/mrf_merge.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

/// Joins groups of `groupOf`, whose numbers are below its size. A joined group keeps the smallest
/// of its numbers. Needs scratch.firstArc and scratch.neighbours.
/// Time: O(E) a round; rounds get shorter with the groups that are left. Where they don't (a node
/// that most others touch gains one of them a round), mutual choice ends after a few times the arcs
/// with scratch.isCutShort set: from then on each group joins the one it likes best.
void contract(MergeScratch& scratch, std::vector<uint32_t>& groupOf);

}  // namespace rg::objects
