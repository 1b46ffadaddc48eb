// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_place.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rg {
namespace {

constexpr double kOne = CameraMotion::kOne;
constexpr double kLeastW = .25;  ///< Of CameraMotion.

CameraMatrix numbersOf(const CameraMotion& camera) {
  CameraMatrix numbers{};
  for (size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = static_cast<double>(camera.matrix()[i]) / kOne;
  return numbers;
}

CameraMatrix wayBack(const CameraMatrix& there) {
  const double det = there[0] * there[4] - there[1] * there[3];
  const double xx = there[4] / det, xy = -there[1] / det;
  const double yx = -there[3] / det, yy = there[0] / det;
  return {xx, xy, -(xx * there[2] + xy * there[5]), yx, yy, -(yx * there[2] + yy * there[5]), 0,
          0,  1};
}

/// Of what is beyond the range it is enough that it stays beyond.
int64_t fixed(double value) {
  constexpr double kBeyond = 1 << 18;
  return std::llround(std::clamp(value, -kBeyond, kBeyond) * kOne);
}

int wholePx(double place) {
  constexpr double kFarthest = 1 << 14;  // Of CameraMotion.
  return static_cast<int>(std::lround(std::clamp(place, -kFarthest, kFarthest)));
}

/// Not safe where it can't be computed with.
CameraMotion motionOf(const CameraMatrix& numbers, Point origin) {
  CameraMotion::Matrix matrix{};
  if (numbers[8] > kLeastW)
    for (size_t i = 0; i < matrix.size(); ++i) matrix[i] = fixed(numbers[i] / numbers[8]);
  return {matrix, origin};
}

CameraMotion shiftAtOrigin(const CameraMotion& camera, const PixelWay& way) {
  constexpr double kFarthest = 1 << 18;  // 2^14 px.
  const Point by = camera.at(camera.origin().x, camera.origin().y);
  const auto along = [&](double x, double y) {
    return static_cast<int>(std::lround(std::clamp(x * by.x + y * by.y, -kFarthest, kFarthest)));
  };
  return CameraMotion(Point{along(way.xx, way.xy), along(way.yx, way.yy)});
}

}  // namespace

CameraMatrix chained(const CameraMatrix& a, const CameraMatrix& b) {
  CameraMatrix c{};
  for (size_t row = 0; row < 9; row += 3)
    for (size_t column = 0; column < 3; ++column)
      c[row + column] =
          a[row] * b[column] + a[row + 1] * b[column + 3] + a[row + 2] * b[column + 6];
  return c;
}

CameraMotion followed(const CameraMotion& since, const CameraMotion& before) {
  if (!since.isSafe() || !before.isSafe()) return {};
  const Point origin = since.origin();
  // Between places as seen from the two origins.
  const double x = before.origin().x - origin.x, y = before.origin().y - origin.y;
  const CameraMatrix there{1, 0, -x, 0, 1, -y, 0, 0, 1};
  const CameraMatrix after = chained(chained(wayBack(there), numbersOf(before)), there);
  const CameraMatrix all = chained(after, numbersOf(since));
  const CameraMotion result = motionOf(all, origin);
  if (result.isSafe()) return result;
  const Point step = since.at(origin.x, origin.y);
  constexpr int kUnit = 1 << CameraMotion::kMotionBits;
  const Point rest = before.at(origin.x - step.x / kUnit, origin.y - step.y / kUnit);
  return CameraMotion(Point{step.x + rest.x, step.y + rest.y});
}

CameraMotion moved(const CameraMotion& camera, const PixelWay& way) {
  if (!camera.isSafe()) return {};
  const Point from = camera.origin();
  const double x = way.xx * from.x + way.xy * from.y + way.x0;
  const double y = way.yx * from.x + way.yy * from.y + way.y0;
  const Point to{wholePx(x), wholePx(y)};
  // Between places as seen from the two origins.
  const CameraMatrix there{way.xx, way.xy, x - to.x, way.yx, way.yy, y - to.y, 0, 0, 1};
  const CameraMatrix all = chained(chained(there, numbersOf(camera)), wayBack(there));
  const CameraMotion result = motionOf(all, to);
  return result.isSafe() ? result : shiftAtOrigin(camera, way);
}

CameraMatrix matrixOf(const CameraMotion& camera) {
  if (!camera.isSafe()) return {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double x = camera.origin().x, y = camera.origin().y;
  CameraMatrix m = numbersOf(camera);
  const double w = m[8] - m[6] * x - m[7] * y;
  if (!(w > kLeastW)) return matrixOf(shiftAtOrigin(camera, {}));
  for (size_t column = 0; column < 3; ++column) {
    m[column] += x * m[6 + column];
    m[3 + column] += y * m[6 + column];
  }
  m[2] -= m[0] * x + m[1] * y;
  m[5] -= m[3] * x + m[4] * y;
  m[8] = w;
  for (double& value : m) value /= w;
  return m;
}

}  // namespace rg
