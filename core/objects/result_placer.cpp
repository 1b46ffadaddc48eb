// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/result_placer.hpp"

#include "core/base/camera/camera_place.hpp"
#include "core/base/mapping.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace rg::objects {
namespace {

constexpr int kCentroidUnit = 256;  ///< Of regions.

int32_t narrowed(int64_t value) {
  using Limits = std::numeric_limits<int32_t>;
  return static_cast<int32_t>(std::clamp<int64_t>(value, Limits::min(), Limits::max()));
}

/// From a result to the frame that its pixels are in now.
class Way {
 public:
  Way(Size madeFor, const Placement& placement)
      : map_(mapBetween(madeFor, placement.whole)), to_(placement) {}

  [[nodiscard]] Box bounds() const { return boundsOf(to_.size()); }
  [[nodiscard]] Box box(const Box& from) const {
    Box box = map_.box(from);
    box.x -= to_.part.x;
    box.y -= to_.part.y;
    if (to_.isTransposed) box = {box.y, box.x, box.height, box.width};
    if (to_.isMirroredX) box.x = to_.size().width - box.right();
    if (to_.isMirroredY) box.y = to_.size().height - box.bottom();
    return box;
  }
  [[nodiscard]] Box shown(const Box& from) const { return intersect(box(from), bounds()); }

  /// A pixel, or a mean of pixels in 1/unit of one.
  void moveCentre(int32_t& x, int32_t& y, int unit) const {
    int64_t toX = map_.centreX(x, unit) - int64_t{to_.part.x} * unit;
    int64_t toY = map_.centreY(y, unit) - int64_t{to_.part.y} * unit;
    if (to_.isTransposed) std::swap(toX, toY);
    if (to_.isMirroredX) toX = int64_t{to_.size().width - 1} * unit - toX;
    if (to_.isMirroredY) toY = int64_t{to_.size().height - 1} * unit - toY;
    x = narrowed(toX);
    y = narrowed(toY);
  }
  void moveVector(int32_t& dx, int32_t& dy) const {
    int64_t toX = map_.x(dx), toY = map_.y(dy);
    if (to_.isTransposed) std::swap(toX, toY);
    dx = narrowed(to_.isMirroredX ? -toX : toX);
    dy = narrowed(to_.isMirroredY ? -toY : toY);
  }
  [[nodiscard]] CameraMotion camera(const CameraMotion& from) const {
    PixelWay way = wayAlong(map_);
    way.x0 -= to_.part.x;
    way.y0 -= to_.part.y;
    if (to_.isTransposed) way = {way.yx, way.yy, way.y0, way.xx, way.xy, way.x0};
    if (to_.isMirroredX)
      way = {-way.xx, -way.xy, to_.size().width - 1 - way.x0, way.yx, way.yy, way.y0};
    if (to_.isMirroredY)
      way = {way.xx, way.xy, way.x0, -way.yx, -way.yy, to_.size().height - 1 - way.y0};
    return moved(from, way);
  }
  void moveContour(std::vector<Point>& contour) const {
    const Box within = bounds();
    for (Point& point : contour) {
      moveCentre(point.x, point.y, 1);
      point = {std::clamp(point.x, 0, within.width - 1), std::clamp(point.y, 0, within.height - 1)};
    }
    contour.erase(std::unique(contour.begin(), contour.end()), contour.end());
    const bool turnsTheOtherWay = (to_.isTransposed != to_.isMirroredX) != to_.isMirroredY;
    if (turnsTheOtherWay) std::reverse(contour.begin(), contour.end());
  }
  [[nodiscard]] uint32_t area(uint32_t px) const {
    return static_cast<uint32_t>(std::clamp<int64_t>(map_.area(px), px > 0, UINT32_MAX));
  }

  /// What is empty stays so.
  template <class T>
  [[nodiscard]] Image<T> plane(const ResultPlane<T>& from) const {
    if (from.pixelSize().isEmpty()) return {};
    Image<T> scratch;
    const ImageView<const T> pixels = from.unpacked(scratch);
    const FrameMap map{from.pixelSize(), to_.whole};
    Image<T> to(to_.size());
    for (int y = 0; y < to.height(); ++y)
      for (int x = 0; x < to.width(); ++x) {
        const Point source = to_.sourceOf({x, y});
        const bool isThere = boundsOf(to_.whole).contains(source);
        to.at(x, y) = isThere ? pixels.at(map.sourceX(source.x), map.sourceY(source.y)) : T{0};
      }
    return to;
  }

 private:
  FrameMap map_;
  Placement to_;
};

/// How many pixels have each value.
template <class T>
std::vector<uint32_t> countOf(const Image<T>& image) {
  std::vector<uint32_t> counts(size_t{std::numeric_limits<T>::max()} + 1);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) ++counts[image.at(x, y)];
  return counts;
}

void fill(const background::Foreground& from, const Way& way, const Placement&,
          background::Foreground& to) {
  Image<uint8_t> mask = way.plane(from.mask);
  to.scene = from.scene;
  to.scene.foregroundPx = mask.size().isEmpty() ? way.area(from.scene.foregroundPx)
                                                : countOf(mask)[background::kForegroundPixel];
  way.moveVector(to.scene.shift.x, to.scene.shift.y);
  to.mask.takePacked(std::move(mask));
  to.extent = way.shown(from.extent);
  for (const Box& area : from.areas)
    if (const Box box = way.shown(area); !box.isEmpty()) to.areas.push_back(box);
  std::sort(to.areas.begin(), to.areas.end(),
            [](const Box& a, const Box& b) { return std::pair(a.y, a.x) < std::pair(b.y, b.x); });
}

void fill(const segmentation::Labels& from, const Way& way, const Placement& placement,
          segmentation::Labels& to) {
  to.scope = from.scope;
  to.foreground = place(from.foreground, placement);
  to.ids.takePacked(way.plane(from.ids));
  to.hue.takePacked(way.plane(from.hue));
  to.count = from.count;
}

/// Area, box and centroid of each region that a plane of labels shows.
class RegionSums {
 public:
  RegionSums(const segmentation::Labels& labels, size_t count) : sums_(count) {
    std::vector<uint16_t> scratch;
    const Size size = labels.ids.pixelSize();
    for (int y = 0; y < size.height; ++y) {
      const uint16_t* row = labels.ids.unpackedRow(y, scratch);
      for (int x = 0; x < size.width; ++x)
        if (row[x] != segmentation::kNoRegion && row[x] <= count) add(sums_[row[x] - 1u], {x, y});
    }
  }
  void fill(size_t index, graph::Region& region) const {
    const Sum& sum = sums_[index];
    region.areaPx = sum.areaPx;
    region.box = sum.box;
    if (sum.areaPx == 0) return;
    region.centroidX = narrowed(divideRounded(sum.x * kCentroidUnit, sum.areaPx));
    region.centroidY = narrowed(divideRounded(sum.y * kCentroidUnit, sum.areaPx));
  }

 private:
  struct Sum {
    uint32_t areaPx = 0;
    int64_t x = 0, y = 0;
    Box box;
  };
  static void add(Sum& sum, Point p) {
    ++sum.areaPx;
    sum.x += p.x;
    sum.y += p.y;
    sum.box = unite(sum.box, {p.x, p.y, 1, 1});
  }
  std::vector<Sum> sums_;
};

void fill(const graph::Graph& from, const Way& way, const Placement& placement, graph::Graph& to) {
  to.labels = place(from.labels, placement);
  to.regions = from.regions;
  to.arcs = from.arcs;
  const bool isShown = to.labels && !to.labels->ids.pixelSize().isEmpty();
  const segmentation::Labels none;
  const RegionSums sums(isShown ? *to.labels : none, to.regions.size());
  for (size_t i = 0; i < to.regions.size(); ++i) {
    graph::Region& region = to.regions[i];
    way.moveCentre(region.centroidX, region.centroidY, kCentroidUnit);
    region.box = way.shown(region.box);
    region.areaPx = region.box.isEmpty() ? 0 : way.area(region.areaPx);
    if (isShown) sums.fill(i, region);
  }
}

void fill(const motion::Motion& from, const Way& way, const Placement& placement,
          motion::Motion& to) {
  to.graph = place(from.graph, placement);
  to.regions = from.regions;
  to.matchedBlocks = from.matchedBlocks;
  to.stillBlocks = from.stillBlocks;
  for (motion::RegionMotion& region : to.regions) way.moveVector(region.dx, region.dy);
}

/// The objects in view, and for the number of each slot the one that it has now.
std::vector<uint16_t> placeObjects(const Way& way, std::vector<Object>& objects) {
  std::vector<uint16_t> numbers(size_t{UINT16_MAX} + 1);
  std::vector<Object> inView;
  for (size_t i = 0; i < objects.size(); ++i) {
    Object& object = objects[i];
    object.box = way.box(object.box);
    if (intersect(object.box, way.bounds()).isEmpty()) continue;
    object.areaPx = way.area(object.areaPx);
    way.moveCentre(object.centroidX, object.centroidY, kPositionUnit);
    way.moveVector(object.speedX, object.speedY);
    way.moveContour(object.contour);
    inView.push_back(std::move(object));
    numbers[Slot::ofIndex(i).number()] = Slot::ofIndex(inView.size() - 1).number();
  }
  objects = std::move(inView);
  return numbers;
}

void fill(const Objects& from, const Way& way, const Placement& placement, Objects& to) {
  to.copyTables(from);
  to.motion = place(from.motion, placement);
  to.camera = way.camera(from.camera);
  way.moveVector(to.cameraDx, to.cameraDy);
  if (!to.camera.isUniform()) {  // The middle is another one.
    const Point by = to.camera.at(way.bounds().width / 2, way.bounds().height / 2);
    to.cameraDx = by.x;
    to.cameraDy = by.y;
  }
  const std::vector<uint16_t> numbers = placeObjects(way, to.objects);
  Image<uint16_t> slots = way.plane(from.slots);
  for (int y = 0; y < slots.height(); ++y)
    for (int x = 0; x < slots.width(); ++x) slots.at(x, y) = numbers[slots.at(x, y)];
  if (!slots.size().isEmpty()) {
    const std::vector<uint32_t> counts = countOf(slots);
    for (size_t i = 0; i < to.objects.size(); ++i)
      to.objects[i].areaPx = counts[Slot::ofIndex(i).number()];
  }
  to.slots.takePacked(std::move(slots));
}

}  // namespace

template <class Payload>
std::shared_ptr<const Payload> place(const std::shared_ptr<const Payload>& result,
                                     const Placement& placement) {
  if (!result) return nullptr;
  auto placed = std::make_shared<Payload>();
  fill(*result, Way(result->size, placement), placement, *placed);
  placed->size = placement.size();
  placed->status = result->status;
  return placed;
}

#define RG_PLACE(Payload)                                                              \
  template std::shared_ptr<const Payload> place(const std::shared_ptr<const Payload>&, \
                                                const Placement&);
RG_PLACE(background::Foreground)
RG_PLACE(segmentation::Labels)
RG_PLACE(graph::Graph)
RG_PLACE(motion::Motion)
RG_PLACE(Objects)

}  // namespace rg::objects
