// SPDX-License-Identifier: LGPL-2.1-or-later
// Where the pixels of a frame lie on the canvas.
#pragma once

#include "tests/accuracy/plan.hpp"

namespace rg::truth {

struct Place {
  double x = 0, y = 0;
};

/// From places to places: x' = xx x + xy y + x0, y' = yx x + yy y + y0. Pixel 0 is sampled at 0.
struct Affine {
  double xx = 1, xy = 0, x0 = 0;
  double yx = 0, yy = 1, y0 = 0;

  [[nodiscard]] Place operator()(double x, double y) const {
    return {xx * x + xy * y + x0, yx * x + yy * y + y0};
  }
  [[nodiscard]] double determinant() const { return xx * yy - xy * yx; }
  [[nodiscard]] bool isShift() const { return xx == 1 && xy == 0 && yx == 0 && yy == 1; }
};

/// First `inner`, then `outer`.
[[nodiscard]] Affine after(const Affine& outer, const Affine& inner);
/// Back from where `there` leads to.
[[nodiscard]] Affine inverse(const Affine& there);

/// From the pixels of a frame to the canvas. The camera turns and zooms about the frame's middle.
[[nodiscard]] Affine viewAt(const Plan& plan, double frame);

/// From the pixels of a frame to where the same part of the ground was in the frame before it.
[[nodiscard]] Affine groundBefore(const Plan& plan, int frame);

}  // namespace rg::truth
