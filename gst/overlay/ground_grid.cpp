// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/ground_grid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rg::overlay {
namespace {

constexpr double kSquaresAcross = 6;  ///< Of the frame's shorter side, when laid out.
constexpr double kMostChange = 3;     ///< Of a square's size, anywhere in the frame.
constexpr int kMostLines = 64;        ///< Each way; more than any grid that is readable has.
constexpr graph::Colour kInk{225, 225, 225};

double squareOf(Size size) {
  return std::max(2.0, std::min(size.width, size.height) / kSquaresAcross);
}

bool isSceneNew(const objects::Objects& objects) {
  return std::any_of(objects.events.begin(), objects.events.end(), [](const objects::Event& event) {
    return event.kind == objects::EventKind::SceneChanged;
  });
}

/// What the rectangle (0, 0) to `far` has of the line a x + b y + c = 0.
std::optional<GroundGrid::Line> clip(double a, double b, double c, GroundGrid::Place far) {
  const bool isSteep = std::abs(a) > std::abs(b);  // Along y then, which it crosses for certain.
  if (isSteep) std::swap(a, b), std::swap(far.x, far.y);
  if (b == 0) return std::nullopt;
  const auto at = [&](double x) { return -(a * x + c) / b; };
  double first = 0, last = far.x;
  if (a == 0) {
    if (at(0) < 0 || at(0) > far.y) return std::nullopt;
  } else {
    const double top = -c / a, bottom = -(b * far.y + c) / a;
    first = std::max(first, std::min(top, bottom));
    last = std::min(last, std::max(top, bottom));
  }
  if (!(first < last)) return std::nullopt;
  if (isSteep) return GroundGrid::Line{{at(first), first}, {at(last), last}};
  return GroundGrid::Line{{first, at(first)}, {last, at(last)}};
}

}  // namespace

void GroundGrid::layOut(Size size) {
  size_ = size;
  anchor_ = {1, 0, 0, 0, 1, 0, 0, 0, 1};
}

void GroundGrid::advance(const objects::Objects& objects) {
  if (objects.size.isEmpty()) return;
  if (objects.size != size_ || isSceneNew(objects)) return layOut(objects.size);
  anchor_ = chained(anchor_, matrixOf(objects.camera));
  const double w = anchor_[8];
  for (double& number : anchor_) number /= w;
  if (!isReadable()) layOut(size_);
}

std::array<GroundGrid::Place, 4> GroundGrid::corners() const {
  const double right = size_.width - 1, bottom = size_.height - 1;
  return {Place{0, 0}, {right, 0}, {0, bottom}, {right, bottom}};
}

GroundGrid::Place GroundGrid::laidOutAt(Place now) const {
  const auto& m = anchor_;
  const double w = m[6] * now.x + m[7] * now.y + m[8];
  return {(m[0] * now.x + m[1] * now.y + m[2]) / w, (m[3] * now.x + m[4] * now.y + m[5]) / w};
}

/// By what a pixel's way to the right and its way down become at each corner.
bool GroundGrid::isReadable() const {
  const auto& m = anchor_;
  for (const Place& corner : corners()) {
    const double w = m[6] * corner.x + m[7] * corner.y + m[8];
    const Place was = laidOutAt(corner);
    const double xx = (m[0] - was.x * m[6]) / w, xy = (m[1] - was.x * m[7]) / w;
    const double yx = (m[3] - was.y * m[6]) / w, yy = (m[4] - was.y * m[7]) / w;
    const auto isNear = [](double ratio) {
      return ratio >= 1 / kMostChange && ratio <= kMostChange;
    };
    constexpr double kFarPx = 1e9;  // From there on doubles tell no pixels apart.
    if (!(w > 0) || !isNear(std::hypot(xx, yx)) || !isNear(std::hypot(xy, yy)) ||
        !isNear(std::sqrt(std::max(xx * yy - xy * yx, 0.0))) || std::abs(was.x) > kFarPx ||
        std::abs(was.y) > kFarPx)
      return false;
  }
  return true;
}

/// A line of the grid is where axis · laidOutAt(p) is a multiple of a square's side from the
/// middle.
void GroundGrid::addLines(size_t axis) {
  const double side = squareOf(size_);
  const double middle = ((axis == 0 ? size_.width : size_.height) - 1) / 2.0;
  double least = INFINITY, most = -INFINITY;
  for (const Place& corner : corners()) {
    const Place was = laidOutAt(corner);
    least = std::min(least, ((axis == 0 ? was.x : was.y) - middle) / side);
    most = std::max(most, ((axis == 0 ? was.x : was.y) - middle) / side);
  }
  const Place far{size_.width - 1.0, size_.height - 1.0};
  const double* const row = &anchor_[3 * axis];
  int count = 0;
  for (double k = std::ceil(least); k <= most && count < kMostLines; ++k, ++count) {
    const double at = middle + k * side;
    if (const auto line =
            clip(row[0] - at * anchor_[6], row[1] - at * anchor_[7], row[2] - at * anchor_[8], far))
      lines_.push_back(*line);
  }
}

std::span<const GroundGrid::Line> GroundGrid::lines() {
  lines_.clear();
  if (size_.isEmpty()) return lines_;
  addLines(0);
  addLines(1);
  return lines_;
}

void drawGrid(GroundGrid& grid, const FrameMap& map, Canvas& canvas) {
  const PixelWay way = wayAlong(map);
  const auto shown = [&](const GroundGrid::Place& place) {
    return Point{static_cast<int>(std::lround(way.xx * place.x + way.x0)),
                 static_cast<int>(std::lround(way.yy * place.y + way.y0))};
  };
  for (const GroundGrid::Line& line : grid.lines()) {
    const Point ends[] = {shown(line.from), shown(line.to)};
    canvas.path(ends, kInk, Ends::Open);
  }
}

}  // namespace rg::overlay
