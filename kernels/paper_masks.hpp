// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/methods/paper_masks.hpp (paper, section 2.2.1), and of fillLines()
// in core/background/mask_cleaning.hpp.
#pragma once

#include "core/base/geometry.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

#include <cstdint>
#include <vector>

namespace rg::gpu::background {

void keepAbove(const int* threshold, ImageView<uint8_t> plane, Stream stream);
void keepBoth(ImageView<const uint8_t> a, ImageView<const uint8_t> b, ImageView<uint8_t> out,
              Stream stream);

/// Fs, Fg and Fc.
struct PaperTests {
  ImageView<const uint8_t> simple, gaussian, common;
};
void joinFound(const PaperTests& tests, ImageView<const uint8_t> filled, ImageView<uint8_t> out,
               Stream stream);

/// A box whose lines are filled, and where its numbers begin in LineBoxes::reaches: two of each of
/// its columns, then two of each of its rows.
struct LineBox {
  Box box;
  uint32_t reaches = 0;
};
/// Rows of a box that a block has.
struct LineStrip {
  uint32_t box = 0;
  int32_t top = 0;
};
inline constexpr int kStripRows = 32;

/// What fillLines() is told of boxes, on the host.
struct LineList {
  std::vector<LineBox> boxes;
  std::vector<LineStrip> strips;
  uint32_t reaches = 0;

  void clear();
  void add(const Box& box);
};

/// The same in device memory.
struct LineBoxes {
  const LineBox* boxes;
  const LineStrip* strips;
  int stripCount;
  uint32_t* reaches;  ///< Scratch.
  uint32_t reachCount;
  double pixels;  ///< Of all boxes, for the model.
};
/// rg::background::fillLines in each of the boxes, which may overlap. Only sets pixels.
void fillLines(ImageView<const uint8_t> edges, const LineBoxes& boxes, ImageView<uint8_t> out,
               Stream stream);

}  // namespace rg::gpu::background
