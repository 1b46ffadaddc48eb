// SPDX-License-Identifier: LGPL-2.1-or-later
// The one way into the pixels of a video frame: a view that was checked against its memory.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/result.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace rg {

/// Byte orders as GStreamer names them, without its _LE: words have their low byte first.
enum class PixelFormat : uint8_t {
  Bgrx,
  Rgbx,
  Bgra,
  Rgba,
  Bgr,
  Rgb,
  Gbr,  ///< A plane each of green, blue and red.
  Nv12,
  Nv21,
  I420,
  Y42b,
  Yuy2,
  Uyvy,
  I420Ten,  ///< Words, of which the lower ten bits count.
  P010,     ///< Words, of which the upper ten bits count.
  Gray8
};

/// Luma weights of Y'CbCr: ITU-R BT.601, BT.709, BT.2020, SMPTE 240M, FCC.
enum class YuvMatrix : uint8_t { Bt601, Bt709, Bt2020, Smpte240m, Fcc };

/// Full: 0…255. Limited: luma 16…235, chroma 16…240.
enum class YuvRange : uint8_t { Limited, Full };

struct FrameLayout {
  PixelFormat format = PixelFormat::Bgrx;
  Size size;
  YuvMatrix matrix = YuvMatrix::Bt601;
  YuvRange range = YuvRange::Limited;
  bool isInterlaced = false;  ///< Odd rows are of another time than even ones.
  friend bool operator==(const FrameLayout&, const FrameLayout&) = default;
};

/// What the caller knows of one plane: its first byte, how many bytes may be read from there on,
/// and the distance between rows.
struct PlaneMemory {
  const uint8_t* data = nullptr;
  uint64_t bytes = 0;
  int64_t strideBytes = 0;
};

class Frame {
 public:
  static constexpr int kMaxPlanes = 3;

  /// Checks that every row of every plane lies inside its memory. Errors: empty size, a missing
  /// plane, a negative or too small stride, memory that ends early.
  [[nodiscard]] static Result<Frame> make(const FrameLayout& layout,
                                          std::span<const PlaneMemory> planes);

  [[nodiscard]] const FrameLayout& layout() const { return layout_; }
  [[nodiscard]] Size size() const { return layout_.size; }
  /// Rows of bytes: a packed row has 2, 3 or 4 bytes a pixel, NV12's second plane Cb and Cr in
  /// turn.
  [[nodiscard]] ImageView<const uint8_t> plane(int i) const {
    return planes_[static_cast<size_t>(i)];
  }
  /// What may be looked at as one picture: the frame, or of an interlaced one the field that has
  /// the top line, which is every second row of each plane, as a frame of (height + 1) / 2 rows.
  [[nodiscard]] Frame ofOneTime() const;

 private:
  Frame() = default;
  FrameLayout layout_;
  std::array<ImageView<const uint8_t>, kMaxPlanes> planes_;
};

/// Number of planes, and the bytes by rows that each must hold.
[[nodiscard]] int planeCount(PixelFormat format);
[[nodiscard]] Size planeBytes(PixelFormat format, Size size, int plane);

}  // namespace rg
