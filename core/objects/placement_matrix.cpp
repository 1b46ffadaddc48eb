// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/placement_matrix.hpp"

#include <algorithm>
#include <cmath>

namespace rg::objects {
namespace {

constexpr double kFurthestPx = 1 << 20;  ///< Beyond this nobody draws.

bool isNought(double value, double among) {
  constexpr double kLeast = 1e-4;
  return std::abs(value) <= kLeast * std::abs(among);
}

/// The way back along one axis: value = (position − offset) / scale.
struct Axis {
  double scale, offset;
  [[nodiscard]] double back(double position) const { return (position - offset) / scale; }
};

/// What of a source's axis is seen in the frame's positions 0 … length. False where that is nothing
/// or far away.
bool findPart(const Axis& axis, int length, int begin, int& first, int& count) {
  const double a = axis.back(0) + begin, b = axis.back(length) + begin;
  const double least = std::floor(std::min(a, b) + 0.5), most = std::floor(std::max(a, b) + 0.5);
  if (!(least > -kFurthestPx && most < kFurthestPx && most > least)) return false;
  first = static_cast<int>(least);
  count = static_cast<int>(most - least);
  return true;
}

}  // namespace

std::optional<Placement> placementOf(const Drawn& drawn) {
  const auto& m = drawn.matrix;
  if (drawn.from.isEmpty() || drawn.to.isEmpty() || !std::isfinite(m[2][2]) || m[2][2] == 0)
    return std::nullopt;
  const auto at = [&](int row, int column) { return double{m[row][column]} / double{m[2][2]}; };
  const double largest =
      std::max({std::abs(at(0, 0)), std::abs(at(0, 1)), std::abs(at(1, 0)), std::abs(at(1, 1))});
  const bool isUpright = isNought(at(0, 1), largest) && isNought(at(1, 0), largest);
  const bool isTransposed = isNought(at(0, 0), largest) && isNought(at(1, 1), largest);
  const bool isFlat = isNought(at(2, 0), 1) && isNought(at(2, 1), 1);
  if (!isFlat || isUpright == isTransposed) return std::nullopt;
  const Axis x{isTransposed ? at(0, 1) : at(0, 0), at(0, 2) + drawn.toPart.x};
  const Axis y{isTransposed ? at(1, 0) : at(1, 1), at(1, 2) + drawn.toPart.y};
  if (x.scale == 0 || y.scale == 0) return std::nullopt;
  Placement placement{drawn.from, {}, isTransposed, x.scale < 0, y.scale < 0};
  Box& part = placement.part;
  // The frame's columns come from the source's rows where these changed places.
  const Box& begin = drawn.fromPart;
  const bool isSeen = isTransposed ? findPart(x, drawn.to.width, begin.y, part.y, part.height) &&
                                         findPart(y, drawn.to.height, begin.x, part.x, part.width)
                                   : findPart(x, drawn.to.width, begin.x, part.x, part.width) &&
                                         findPart(y, drawn.to.height, begin.y, part.y, part.height);
  const Box seen = intersect(part, boundsOf(drawn.from));
  const bool isWhole = begin == boundsOf(drawn.from);
  if (!isSeen || seen.isEmpty() || (!isWhole && intersect(part, begin) != part))
    return std::nullopt;          // Of a part alone nothing more may be shown than that.
  constexpr int kMostTimes = 16;  // Results of frames that are mere dots in others help nobody.
  if (part.area() > kMostTimes * drawn.from.area()) return std::nullopt;
  return placement;
}

}  // namespace rg::objects
