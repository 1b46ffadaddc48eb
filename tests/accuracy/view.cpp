// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/accuracy/view.hpp"

#include <algorithm>
#include <cmath>

namespace rg::truth {

Affine after(const Affine& outer, const Affine& inner) {
  const Place origin = outer(inner.x0, inner.y0);
  return {outer.xx * inner.xx + outer.xy * inner.yx,
          outer.xx * inner.xy + outer.xy * inner.yy,
          origin.x,
          outer.yx * inner.xx + outer.yy * inner.yx,
          outer.yx * inner.xy + outer.yy * inner.yy,
          origin.y};
}

Affine inverse(const Affine& there) {
  const double all = there.determinant();
  Affine back{there.yy / all, -there.xy / all, 0, -there.yx / all, there.xx / all, 0};
  const Place origin = back(there.x0, there.y0);
  back.x0 = -origin.x;
  back.y0 = -origin.y;
  return back;
}

Affine viewAt(const Plan& plan, double frame) {
  const Waypoint corner = *placeAt(plan.camera, frame);
  const double shrink = std::exp(-plan.zoom.at(frame)), turn = plan.roll.at(frame);
  const double along = std::cos(turn) * shrink, across = std::sin(turn) * shrink;
  const double middleX = plan.frame.width / 2.0, middleY = plan.frame.height / 2.0;
  // Of a camera that only pans exactly its corner.
  return {along,  -across, corner.x + (middleX - (along * middleX - across * middleY)),
          across, along,   corner.y + (middleY - (across * middleX + along * middleY))};
}

Affine groundBefore(const Plan& plan, int frame) {
  const Affine here = viewAt(plan, frame);
  Affine there = viewAt(plan, std::max(frame - 1, 0));
  Affine shifted = here;
  // Differences of places on the canvas are exact where the camera only pans.
  shifted.x0 -= there.x0;
  shifted.y0 -= there.y0;
  there.x0 = there.y0 = 0;
  return after(inverse(there), shifted);
}

}  // namespace rg::truth
