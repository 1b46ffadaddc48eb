// SPDX-License-Identifier: LGPL-2.1-or-later
// Pictures that are to be divided into regions.
#pragma once

#include "core/base/row_spans.hpp"
#include "core/segmentation/colour_cells.hpp"
#include "tests/kernels/parity.hpp"
#include "tests/kernels/pictures.hpp"

namespace rg::test {

/// What is divided: all of a picture, or what is in scope and in scope apart.
struct Divided {
  Picture picture;
  Image<uint8_t> scope;
  bool hasScope;
  [[nodiscard]] ImageView<const uint8_t> scopeView() const {
    return hasScope ? scope.view() : ImageView<const uint8_t>{};
  }
};

template <class Check>
void forDivided(const Check& check) {
  forSizesAndFills([&](Size size, int fill) {
    for (const bool isGrey : {false, true})
      for (const bool hasScope : {false, true}) {
        Divided divided{{}, Image<uint8_t>(size), hasScope};
        loadScene(size, fill, 1, isGrey, divided.picture);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) {
            // Kinds follow blocks of 8x8, which no cell leaves.
            const uint8_t kind = hashOf(x / 8, y / 8, 4) % 3 == 0 ? kInScopeApart : kInScope;
            divided.scope.at(x, y) = hashOf(x / 3, y / 3, 5) % 3 == 0 ? uint8_t{128} : kind;
          }
        check(divided);
      }
  });
}

inline gpu::Planes inOrder(const Picture& picture) {
  return {{picture.red(), picture.green(), picture.blue()}, picture.isGrey() ? 1 : 3};
}

inline gpu::Planes planesOf(const segmentation::ColourGrid& grid) {
  return {{grid.colours[0], grid.colours[1], grid.colours[2]}, grid.channels};
}

}  // namespace rg::test
