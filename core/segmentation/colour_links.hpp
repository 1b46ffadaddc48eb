// SPDX-License-Identifier: LGPL-2.1-or-later
// Which neighbouring pixels, or cells of pixels, grow into one region (part of stage 2).
//
// Their distance is the largest difference of a channel, of R'G'B' or of HSV (ColourSpace; of a
// grey picture always of its one channel), and none where one of them is out of scope or in scope
// apart from the other. Hues are compared where both pixels have one. Two 4-neighbours are linked
// when it is at most `similarity`, and when it is the smallest that one of the two has to any
// neighbour (of equal ones: up, left, right, down), so that no pixel stands alone. Hue guard:
// chromatic neighbours on both sides of the background band's limit whose hues differ by more than
// kHueGuard count as unlike as can be. Determinism: each link depends on its neighbourhood only.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/row_spans.hpp"
#include "core/segmentation/colour_cells.hpp"
#include "core/segmentation/hue.hpp"

#include <cstdint>

namespace rg::segmentation {

inline constexpr uint8_t kNoPair = 255;    ///< Distance to what is no pixel of a region.
inline constexpr uint8_t kFarthest = 254;  ///< Largest distance of two pixels.
inline constexpr int kHueGuard = 48;

enum LinkBit : uint8_t {
  kLinkedLeft = 1,
  kLinkedUp = 2,
  kIsPixel = 4,  ///< In scope.
};

struct LinkParams {
  int similarity = 0;
  bool joinsSingles = true;  ///< Link each pixel at least to the neighbour most like it.
  HueBand band{};            ///< Of the background, for the hue guard; none: no guard.
  ColourSpace space = ColourSpace::Rgb;
};

class ColourLinks {
 public:
  void build(const ColourGrid& planes, const LinkParams& params, const Executor& executor);

  [[nodiscard]] Size size() const { return planes_.size; }
  [[nodiscard]] ImageView<const uint8_t> scope() const { return planes_.scope; }
  [[nodiscard]] const uint8_t* links(int y) const { return links_.row(y); }

 private:
  void findHues(int y);
  void findHsv(int y);
  void measure(int y);
  void measureHues(int y);
  [[nodiscard]] bool isByHsv() const { return space_ == ColourSpace::Hsv && planes_.channels == 3; }
  void guardHues(int y);
  void chooseNearest(int y);
  void link(int y, const LinkParams& params);

  ColourGrid planes_;
  HueBand band_;
  ColourSpace space_ = ColourSpace::Rgb;
  RowSpans spans_;
  Image<int16_t> hues_;
  Image<uint8_t> saturations_, values_;  ///< Of ColourSpace::Hsv.
  /// Distances of pixel x to its left neighbour, x = 0 … width, and to its upper one, y = 0 …
  /// height.
  Image<uint8_t> left_, up_;
  Image<uint8_t> nearest_, links_;
};

}  // namespace rg::segmentation
