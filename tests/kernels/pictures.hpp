// SPDX-License-Identifier: LGPL-2.1-or-later
// Pictures of a scene, on the host and in memory as a device has it.
#pragma once

#include "core/base/picture.hpp"
#include "tests/core/fills.hpp"
#include "tests/kernels/device_memory.hpp"
#include "tests/kernels/parity.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace rg::test {

/// Grey pixels, or red, green and blue of each in turn.
inline void loadPacked(const Image<uint8_t>& packed, bool isGrey, Picture& picture) {
  const Size size{isGrey ? packed.width() : packed.width() / 3, packed.height()};
  const FrameLayout layout{isGrey ? PixelFormat::Gray8 : PixelFormat::Rgb, size};
  const ImageView<const uint8_t> view = packed;
  const PlaneMemory memory{view.data, static_cast<uint64_t>(view.strideBytes * view.size.height),
                           view.strideBytes};
  picture.load(*Frame::make(layout, std::span(&memory, 1)), oneThread());
}

/// The frames of a scene: a picture, and what moves and flickers over it.
inline void loadScene(Size size, int fill, int frame, bool isGrey, Picture& picture) {
  Image<uint8_t> packed({isGrey ? size.width : 3 * size.width, size.height});
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < packed.width(); ++x) {
      const auto flicker = static_cast<int>(hashOf(x, y, static_cast<uint32_t>(frame)) % 9);
      const bool isThing = (x / 3 + 4 * frame) % 23 < 5;
      packed.at(x, y) = static_cast<uint8_t>(
          isThing ? 255 - levelAt(fill, x, y) : std::min(255, levelAt(fill, x, y) + flicker));
    }
  loadPacked(packed, isGrey, picture);
}

struct DevicePlanes {
  std::array<Plane<uint8_t>, 3> planes;
  int channels;

  DevicePlanes(Size size, int count)
      : planes{Plane<uint8_t>(size), Plane<uint8_t>(size), Plane<uint8_t>(size)}, channels(count) {}
  DevicePlanes(const std::array<Image<uint8_t>, 3>& from, int count)
      : DevicePlanes(from[0].size(), count) {
    for (size_t c = 0; c < static_cast<size_t>(channels); ++c)
      planes[c] = Plane<uint8_t>(from[c].view());
  }
  operator gpu::PlaneTargets() {  // NOLINT(google-explicit-constructor)
    return {{planes[0], planes[1], planes[2]}, channels};
  }
  operator gpu::Planes() {  // NOLINT(google-explicit-constructor)
    return {{planes[0], planes[1], planes[2]}, channels};
  }
  void expect(const std::array<Image<uint8_t>, 3>& expected, const char* what) {
    for (size_t c = 0; c < static_cast<size_t>(channels); ++c)
      planes[c].expect(expected[c].view(), what);
  }
};

inline gpu::Planes planesOf(const Picture& picture) {
  return {{picture.green(), picture.red(), picture.blue()}, picture.isGrey() ? 1 : 3};
}

}  // namespace rg::test
