// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/graph.hpp"

#include "core/base/mapping.hpp"
#include "core/text/json_parts.hpp"

#include <algorithm>

namespace rg::text {
namespace {

constexpr int64_t kEnergyUnit = 256;
constexpr int64_t kCentroidUnit = 256;

bool isKept(const objects::Objects& objects, const graph::Arc& arc) {
  return objects.regionGroup[arc.a.index()] == objects.regionGroup[arc.b.index()];
}

void appendTerms(std::string& out, const objects::ArcEnergy& energy) {
  appendReal(out, "motion", energy.motion, kEnergyUnit);
  out += ',';
  appendReal(out, "border", energy.border, kEnergyUnit);
  out += ',';
  appendReal(out, "arc", energy.arc, kEnergyUnit);
  out += ',';
  appendReal(out, "prediction", energy.prediction, kEnergyUnit);
}

bool isGround(const objects::Objects& objects, size_t region) {
  return objects.regionGroup[region] == objects.groundGroup;
}

/// A term below 0 counts where its opposite would otherwise.
void addGround(const objects::Objects& objects, objects::ArcEnergy& sum) {
  for (size_t i = 0; i < objects.ground.size(); ++i) {
    const objects::GroundEnergy& energy = objects.ground[i];
    const bool isKept = isGround(objects, i);
    sum.motion += std::max(int64_t{0}, isKept ? energy.motion : -energy.motion);
    sum.prediction += std::max(int64_t{0}, isKept ? -energy.prediction : energy.prediction);
  }
}

/// The terms of U that count: U1 of kept arcs, the others of broken ones.
void appendTotals(std::string& out, const objects::Objects& objects, const graph::Graph* graph) {
  objects::ArcEnergy sum;
  for (size_t i = 0; graph && i < graph->arcs.size(); ++i) {
    const objects::ArcEnergy& arc = objects.arcs[i];
    if (isKept(objects, graph->arcs[i])) {
      sum.motion += arc.motion;
    } else {
      sum.border += arc.border;
      sum.arc += arc.arc;
      sum.prediction += arc.prediction;
    }
  }
  addGround(objects, sum);
  out += ",\"energy\":{";
  appendTerms(out, sum);
  out += ',';
  appendReal(out, "total", sum.motion + sum.border + sum.arc + sum.prediction, kEnergyUnit);
  out += '}';
}

void appendGround(std::string& out, const objects::Objects& objects, size_t region) {
  const objects::GroundEnergy& energy = objects.ground[region];
  out += ",\"ground\":{";
  appendReal(out, "motion", energy.motion, kEnergyUnit);
  out += ',';
  appendReal(out, "prediction", energy.prediction, kEnergyUnit);
  out += ',';
  appendReal(out, "weight", energy.weight(), kEnergyUnit);
  out += isGround(objects, region) ? ",\"kept\":true}" : ",\"kept\":false}";
}

void appendRegion(std::string& out, const objects::Objects& objects, size_t index,
                  const FrameMap& map) {
  const graph::Region& region = objects.motion->graph->regions[index];
  const motion::RegionMotion& motion = objects.motion->regions[index];
  out += "{\"id\":";
  appendUnsigned(out, segmentation::RegionLabel::ofIndex(index).number());
  out += ',';
  appendBox(out, map.box(region.box));
  out += ',';
  appendPair(out, "centroid", map.x(region.centroidX), map.y(region.centroidY), kCentroidUnit);
  out += ',';
  appendNumber(out, "area", map.area(region.areaPx));
  out += ',';
  appendColour(out, region.colour);
  out += ',';
  appendPair(out, "motion", map.x(motion.dx), map.y(motion.dy), motion::kMotionUnit);
  out += ',';
  appendReal(out, "reliability", motion.reliability, motion::kFullReliability);
  out += ',';
  appendNumber(out, "group", objects.regionGroup[index].index());
  out += ",\"expected\":";
  appendUnsigned(out, objects.regionExpected[index]);
  out += ",\"object\":";
  appendUnsigned(out, objects.regionObject[index]);
  if (!objects.ground.empty()) appendGround(out, objects, index);
  out += '}';
}

void appendArc(std::string& out, const objects::Objects& objects, size_t index) {
  const graph::Arc& arc = objects.motion->graph->arcs[index];
  const objects::ArcEnergy& energy = objects.arcs[index];
  out += '{';
  appendNumber(out, "a", arc.a.number());
  out += ',';
  appendNumber(out, "b", arc.b.number());
  out += ',';
  appendNumber(out, "length", arc.borderPx);
  out += ',';
  appendReal(out, "contrast", arc.contrast, arc.borderPx);
  out += ',';
  appendTerms(out, energy);
  out += ',';
  appendReal(out, "weight", energy.weight(), kEnergyUnit);
  out += isKept(objects, arc) ? ",\"kept\":true}" : ",\"kept\":false}";
}

}  // namespace

void appendGraph(std::string& out, const objects::Objects& objects, const FrameStamp& stamp) {
  const FrameMap map = mapBetween(objects.size, stamp.size);
  const bool hasGraph = objects.motion && objects.motion->graph && !objects.regionGroup.empty();
  const graph::Graph* graph = hasGraph ? objects.motion->graph.get() : nullptr;
  appendHead(out, objects.status, stamp, kGraphSchema);
  appendTotals(out, objects, graph);
  out += ",\"regions\":[";
  for (size_t i = 0; graph && i < graph->regions.size(); ++i) {
    appendComma(out);
    appendRegion(out, objects, i, map);
  }
  out += "],\"arcs\":[";
  for (size_t i = 0; graph && i < graph->arcs.size(); ++i) {
    appendComma(out);
    appendArc(out, objects, i);
  }
  out += "]}\n";
}

}  // namespace rg::text
