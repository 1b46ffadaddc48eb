// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/operations.hpp"

#include "core/objects/merge/region_comparison.hpp"

#include <cstddef>

namespace rg::objects {

void Operations::expectFrame(const ComparedFrame& earlier, OwnMotionScratch& s) {
  const Size size = earlier.picture.size();
  s.expected.resize(size);
  s.shown.resize({size.height, 1});
  s.expected.writeOnHost();
  s.shown.writeOnHost();
  warpByCamera(earlier.picture.luma(), earlier.camera, executor_, s.expected,
               std::span(s.shown.row(0), static_cast<size_t>(size.height)));
}

void Operations::compareRegions(const ComparedRegions& regions, OwnMotionScratch& s) {
  objects::compareRegions(regions.motion, regions.own, executor_, s);
}

void Operations::carryEvidence(const KnownEvidence& known, const CarriedEvidence& carried) {
  carried.gains.writeOnHost();
  objects::carryEvidence(known, executor_, carried);
}

void Operations::addEvidence(const graph::Graph& graph, std::span<const int16_t> density,
                             const Image<int16_t>& gains, Image<int16_t>& sum) {
  sum.writeOnHost();
  objects::addEvidence(graph, density, gains, executor_, sum);
}

void Operations::findObjectPixels(const graph::Graph& graph, std::span<const uint8_t> isBackground,
                                  const OwnedCells& cells, const ObjectPixels& pixels) {
  objects::findObjectPixels(graph, isBackground, cells, pixelScratch_, pixels);
}

}  // namespace rg::objects
