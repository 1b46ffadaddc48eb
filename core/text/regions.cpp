// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/regions.hpp"

#include "core/base/mapping.hpp"

#include <cassert>

namespace rg::text {
namespace {

constexpr int kCentroidUnit = 256;
constexpr int kCentroidDecimals = 2;
constexpr int kMotionDecimals = 4;  // A sixteenth is 0.0625: nothing is lost.

void appendGeometry(std::string& out, const graph::Region& region, const FrameMap& map) {
  const Box box = map.box(region.box);
  for (const int64_t value : {map.area(region.areaPx), int64_t{box.x}, int64_t{box.y},
                              int64_t{box.width}, int64_t{box.height}}) {
    out += ',';
    appendInteger(out, value);
  }
  for (const int64_t value : {map.x(region.centroidX), map.y(region.centroidY)}) {
    out += ',';
    appendFixed(out, value, kCentroidUnit, kCentroidDecimals);
  }
}

void appendMotion(std::string& out, const motion::RegionMotion& motion, const FrameMap& map) {
  for (const int64_t value : {map.x(motion.dx), map.y(motion.dy)}) {
    out += ',';
    appendFixed(out, value, motion::kMotionUnit, kMotionDecimals);
  }
  out += ',';
  appendFixed(out, motion.reliability, motion::kFullReliability, kMotionDecimals);
}

}  // namespace

void appendRegions(std::string& out, const RegionSources& sources, const FrameStamp& stamp) {
  assert(sources.graph);
  const graph::Graph& graph = *sources.graph;
  const FrameMap map = mapBetween(graph.size, stamp.size);
  for (size_t i = 0; i < graph.regions.size(); ++i) {
    const bool hasMotion = sources.motion && i < sources.motion->regions.size();
    const bool hasObject = sources.objects && i < sources.objects->regionObject.size();
    appendUnsigned(out, stamp.number);
    out += ',';
    appendUnsigned(out, segmentation::RegionLabel::ofIndex(i).number());
    appendGeometry(out, graph.regions[i], map);
    appendMotion(out, hasMotion ? sources.motion->regions[i] : motion::RegionMotion{}, map);
    out += ',';
    appendUnsigned(out, hasObject ? sources.objects->regionObject[i] : 0);
    out += '\n';
  }
}

}  // namespace rg::text
