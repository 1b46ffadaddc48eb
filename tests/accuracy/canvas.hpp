// SPDX-License-Identifier: LGPL-2.1-or-later
// What a scene is painted on: a made-up yard with walls, windows and uneven ground, or the frames
// of a clip.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/result.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace rg::truth {

using Rgb = std::array<float, 3>;

struct Canvas {
  Size size;
  std::vector<Rgb> pixels;

  [[nodiscard]] const Rgb& at(int x, int y) const {
    return pixels[static_cast<size_t>(y) * static_cast<size_t>(size.width) +
                  static_cast<size_t>(x)];
  }
  /// Between pixels, linearly; beyond the border what is at it.
  [[nodiscard]] Rgb sample(double x, double y) const;
};

class CanvasSource {
 public:
  virtual ~CanvasSource() = default;
  /// The canvas of the next frame; valid until the next call.
  virtual const Canvas& next() = 0;
};

/// The same picture for every frame. Scale: of the size, by that for which the yard is laid out.
[[nodiscard]] std::unique_ptr<CanvasSource> makeYard(uint32_t seed, Size size, double scale = 1);

/// Frames of a .y4m file, scaled to `size`, over and over again.
[[nodiscard]] Result<std::unique_ptr<CanvasSource>> openClip(const std::string& path, Size size);

}  // namespace rg::truth
