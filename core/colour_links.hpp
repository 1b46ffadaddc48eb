// SPDX-License-Identifier: LGPL-2.1-or-later
// Which neighbouring pixels grow into one region (part of stage 2).
//
// Pixels are compared after a 3x3 binomial smoothing. Their distance is the largest difference of a
// channel. Two 4-neighbours are linked when it is at most `similarity`, and when it is the smallest
// that one of the two has to any neighbour (of equal ones: up, left, right, down), so that no
// pixel stands alone. Hue guard: chromatic neighbours on both sides of the background band's limit
// whose hues differ by more than kHueGuard count as unlike as can be.
// Determinism: each link depends on its neighbourhood only.
#pragma once

#include "core/executor.hpp"
#include "core/hue.hpp"
#include "core/image.hpp"
#include "core/picture.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace rg {

inline constexpr uint8_t kNoPair = 255;    ///< Distance to what is no pixel of a region.
inline constexpr uint8_t kFarthest = 254;  ///< Largest distance of two pixels.
inline constexpr int kHueGuard = 48;

enum LinkBit : uint8_t {
  kLinkedLeft = 1,
  kLinkedUp = 2,
  kInScope = 4,
};

struct LinkParams {
  int similarity = 0;
  bool joinsSingles = true;  ///< Link each pixel at least to the neighbour most like it.
  HueBand band{};            ///< Of the background, for the hue guard; none: no guard.
};

/// Columns first … last − 1 of a row.
struct Span {
  int first = 0;
  int last = 0;
};

class ColourLinks {
 public:
  /// mask: only pixels of kForegroundPixel are in scope; empty = all are.
  void build(const Picture& picture, ImageView<const uint8_t> mask, const LinkParams& params,
             const Executor& executor);

  [[nodiscard]] Size size() const { return size_; }
  /// Of row y, the columns outside which no pixel is in scope.
  [[nodiscard]] Span span(int y) const { return spans_[static_cast<size_t>(y)]; }
  [[nodiscard]] const uint8_t* links(int y) const { return links_.row(y); }
  /// Distance of pixel x to its left neighbour; 0 … width.
  [[nodiscard]] const uint8_t* leftDistances(int y) const { return left_.row(y); }
  /// Distance of pixel x to its upper neighbour; y = 0 … height.
  [[nodiscard]] const uint8_t* upDistances(int y) const { return up_.row(y); }

 private:
  using Planes = std::array<ImageView<const uint8_t>, 3>;

  void findSpans(ImageView<const uint8_t> mask, const Executor& executor);
  void smooth(const Planes& planes, const Executor& executor);
  void measure(int y, ImageView<const uint8_t> mask);
  void guardHues(int y);
  void chooseNearest(int y);
  void link(int y, ImageView<const uint8_t> mask, const LinkParams& params);
  [[nodiscard]] Span hull(int y, int above, int below) const;

  Size size_;
  int channels_ = 0;
  HueBand band_;
  std::vector<Span> spans_;
  std::array<Image<uint8_t>, 3> across_, smooth_;
  Image<int16_t> hues_;
  Image<uint8_t> left_, up_, nearest_, links_;
};

}  // namespace rg
