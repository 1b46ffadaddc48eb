// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/graph_view.hpp"

#include "core/base/mapping.hpp"
#include "gst/overlay/painter.hpp"

#include <algorithm>

namespace rg::overlay {
namespace {

constexpr int kCentroidUnit = 256;
constexpr graph::Colour kBetweenObjects{225, 225, 225};

bool showsGraph(const Scene& scene, const Views& views) {
  return views.graph && scene.graph && !scene.graph->regions.empty();
}

bool showsRegionMotion(const Scene& scene, const Views& views) {
  return views.vectors && !scene.objects && scene.graph && scene.motion &&
         !scene.motion->regions.empty();
}

Point centreOf(const graph::Region& region, const FrameMap& map) {
  return {static_cast<int>(divideRounded(map.x(region.centroidX), kCentroidUnit)),
          static_cast<int>(divideRounded(map.y(region.centroidY), kCentroidUnit))};
}

/// The object of a label, 0 = none.
uint64_t objectOf(segmentation::RegionLabel label, const Scene& scene) {
  const bool isKnown = scene.objects && label && label.index() < scene.objects->regionObject.size();
  return isKnown ? scene.objects->regionObject[label.index()] : 0;
}

void drawArcs(const Scene& scene, const FrameMap& map, Canvas& canvas) {
  const auto& regions = scene.graph->regions;
  for (const graph::Arc& arc : scene.graph->arcs) {
    if (!arc.a || !arc.b || arc.a.index() >= regions.size() || arc.b.index() >= regions.size())
      continue;
    const uint64_t object = objectOf(arc.a, scene);
    const bool isWithin = object != 0 && object == objectOf(arc.b, scene);
    const Point ends[] = {centreOf(regions[arc.a.index()], map),
                          centreOf(regions[arc.b.index()], map)};
    canvas.path(ends, isWithin ? colourOf(object) : kBetweenObjects, Ends::Open);
  }
}

void drawNodes(const Scene& scene, const FrameMap& map, Canvas& canvas) {
  const int least = canvas.style().linePx + 1;
  for (size_t i = 0; i < scene.graph->regions.size(); ++i) {
    const graph::Region& region = scene.graph->regions[i];
    const auto side = static_cast<int>(integerSqrt(static_cast<uint64_t>(map.area(region.areaPx))));
    const uint64_t object = objectOf(segmentation::RegionLabel::ofIndex(i), scene);
    canvas.disc(centreOf(region, map), std::clamp(side / 8, least, 3 * least), region.colour,
                object != 0 ? colourOf(object) : kBetweenObjects);
  }
}

void drawRegionMotion(const Scene& scene, const FrameMap& map, Canvas& canvas) {
  const size_t count = std::min(scene.graph->regions.size(), scene.motion->regions.size());
  const double frames = scene.framesPerSecond / 2;
  for (size_t i = 0; i < count; ++i) {
    const motion::RegionMotion& motion = scene.motion->regions[i];
    if (motion.reliability == 0 || (motion.dx == 0 && motion.dy == 0)) continue;
    const Point from = centreOf(scene.graph->regions[i], map);
    const auto along = [&](int64_t shift) {
      constexpr double kFarPx = 1 << 16;  // A framerate of 90000/1 says nothing of the frames.
      return static_cast<int>(
          std::clamp(static_cast<double>(shift) * frames / motion::kMotionUnit, -kFarPx, kFarPx));
    };
    canvas.arrow(from, {from.x + along(map.x(motion.dx)), from.y + along(map.y(motion.dy))},
                 colourOf(i + 1));
  }
}

}  // namespace

bool hasGraphView(const Scene& scene, const Views& views) {
  return showsGraph(scene, views) || showsRegionMotion(scene, views);
}

void drawGraphView(const Scene& scene, const Views& views, Canvas& canvas) {
  if (!scene.graph) return;
  const FrameMap map = mapBetween(scene.graph->size, scene.frame);
  if (showsGraph(scene, views)) {
    drawArcs(scene, map, canvas);
    drawNodes(scene, map, canvas);
  }
  if (showsRegionMotion(scene, views)) drawRegionMotion(scene, map, canvas);
}

}  // namespace rg::overlay
