// SPDX-License-Identifier: LGPL-2.1-or-later
// A frame as the stages look at it: separate planes of red, green, blue and luma.
#pragma once

#include "core/base/frame.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>

namespace rg {

/// Where a picture's pixels go; a grey one has luma only.
struct PicturePlanes {
  ImageView<uint8_t> red, green, blue, luma;
};

/// Converts a frame. Y'CbCr by the layout's matrix and range, a chroma sample serves the pixels
/// that it lies over; of ten bits the upper 8 count. In an interlaced frame a row of the field with
/// the top line serves the row below it, too: things that move would be combs. Each pixel depends
/// on its own samples only: the same bits for any number of threads.
void loadPlanes(const Frame& frame, const Executor& executor, const PicturePlanes& to);

/// Full-range R'G'B' of 8 bits. The first stage makes it, later stages find it in the results, so
/// that all of them see the same pixels. A grey picture holds luma only: all its colour planes are
/// that one plane.
class Picture {
 public:
  [[nodiscard]] Size size() const { return luma_.size(); }
  [[nodiscard]] bool isGrey() const { return isGrey_; }
  [[nodiscard]] ImageView<const uint8_t> red() const { return isGrey_ ? luma_ : red_; }
  [[nodiscard]] ImageView<const uint8_t> green() const { return isGrey_ ? luma_ : green_; }
  [[nodiscard]] ImageView<const uint8_t> blue() const { return isGrey_ ? luma_ : blue_; }
  /// (77 R + 150 G + 29 B + 128) / 256; of Y'CbCr and grey frames Y' as it is stored.
  [[nodiscard]] ImageView<const uint8_t> luma() const { return luma_; }

  /// The planes on a device, which only reads them. Throws DeviceError.
  struct Planes {
    ImageView<const uint8_t> red, green, blue, luma;
  };
  [[nodiscard]] Planes readOn(Device& device) const;

  /// Planes of a size, all of whose pixels will be written on the device; a grey picture's are luma
  /// alone. Throws DeviceError.
  [[nodiscard]] PicturePlanes writeOn(Device& device, Size size, bool isGrey);
  /// Fetches them. Throws DeviceError.
  void readOnHost() const;

  /// Takes the frame's size and pixels (loadPlanes).
  void load(const Frame& frame, const Executor& executor);
  /// Takes those of another picture with twice as many columns and rows: what lies a quarter of a
  /// pixel off each centre, by cubic convolution. The same bits for any number of threads.
  void loadDoubled(const Picture& from, const Executor& executor);
  /// A grey picture of which all pixels will be written here.
  [[nodiscard]] Image<uint8_t>& writeGrey(Size size);

 private:
  void resize(Size size, bool isGrey);

  bool isGrey_ = true;
  Image<uint8_t> red_, green_, blue_, luma_;
};

}  // namespace rg
