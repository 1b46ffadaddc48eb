// SPDX-License-Identifier: LGPL-2.1-or-later
// At which size a frame is looked at, and a smaller frame of the same picture, for analysis at a
// lower resolution than the camera's.
//
// Determinism: rounded means of whole samples, each of a box of its own; the same bits for any
// number of threads.
#pragma once

#include "core/base/frame.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rg {

/// The size at which a frame is looked at where nothing is asked for: small ones, of 96 to 299
/// rows, twice as large (Picture::loadDoubled), unless they are wider than four times their height;
/// all others as they are. PETS09 S2L1 gains from 120 to 288 rows, and loses in 360.
[[nodiscard]] constexpr Size usualSize(Size frame) {
  const bool isSmall = frame.height >= 96 && frame.height < 300;
  return isSmall && frame.width <= 4 * frame.height ? doubled(frame) : frame;
}

/// The size of a frame that is to be looked at with so many rows: of the same shape, never larger
/// than the frame, 1/128 of its height at least. rows = 0: as it is.
[[nodiscard]] Size reducedSize(Size frame, int rows);

struct YuvOrder;

class ReducedFrame {
 public:
  /// Takes a frame's samples at a size that reducedSize() gave. Each is the rounded mean of those
  /// that it covers: of columns x · from / to … (x + 1) · from / to − 1, and of rows alike. Of an
  /// interlaced frame those of one field, which may have fewer rows; then some serve twice.
  /// Y'CbCr becomes I420 of 8 bits, colours RGB; matrix and range stay.
  void load(const Frame& frame, Size size, const Executor& executor);
  /// Points into this object, until it is loaded again.
  [[nodiscard]] Frame view() const;

 private:
  /// Samples of one kind in a plane's rows.
  struct Channel {
    int offsetBytes;                   ///< Of the first one.
    uint8_t* to;                       ///< Its mean in the first row,
    ptrdiff_t strideBytes, stepBytes;  ///< and the way to the next row's and column's.
  };
  /// A plane of samples that lie `step` bytes apart; or words of ten bits, one behind another.
  struct Samples {
    ImageView<const uint8_t> bytes;
    int step;
    Size size, to;
    bool hasTenBits = false;
  };
  void loadYuv(const Frame& frame, const YuvOrder& order, const Executor& executor);
  void loadColours(const Frame& frame, const Executor& executor);
  void reduce(const Samples& from, std::span<const Channel> channels, const Executor& executor);
  void reduceRow(const Samples& from, std::span<const Channel> channels, int y) const;
  [[nodiscard]] Channel planeOf(size_t plane, Size size, int offsetBytes);

  FrameLayout layout_;
  std::array<Image<uint8_t>, Frame::kMaxPlanes> planes_;
  std::vector<int> columns_;  ///< Where the columns that a sample covers begin, and all end.
};

}  // namespace rg
