// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/reduced_frame.hpp"

#include "core/base/pixel.hpp"
#include "core/simd/base/conversion.hpp"
#include "core/simd/base/mean_rows.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace rg {
namespace {

constexpr int kMostRatio = 128;   // Twice as much where chroma has all rows: sums fit 16 bits.
constexpr int kBlockSums = 4096;  // Of each row, at a time.

int beginOf(int i, int from, int to) {
  return static_cast<int>(int64_t{i} * from / to);
}

int roundedUpShift(int value, int shift) {
  return (value + (1 << shift) - 1) >> shift;
}

/// Division by a number that stays the same along a row: exact for means of up to 2^19 bytes.
class Mean {
 public:
  explicit Mean(int count)
      : half_(static_cast<uint64_t>(count) / 2),
        factor_((uint64_t{1} << kShift) / static_cast<uint64_t>(count) + 1) {}
  [[nodiscard]] uint8_t operator()(uint32_t sum) const {
    return static_cast<uint8_t>((sum + half_) * factor_ >> kShift);
  }

 private:
  static constexpr int kShift = 47;
  uint64_t half_, factor_;
};

}  // namespace

Size reducedSize(Size frame, int rows) {
  if (rows <= 0 || rows >= frame.height) return frame;
  const int height = std::max(rows, (frame.height + kMostRatio - 1) / kMostRatio);
  const auto width = divideRounded(int64_t{frame.width} * height, frame.height);
  return {static_cast<int>(std::max<int64_t>(width, 1)), height};
}

void ReducedFrame::load(const Frame& frame, Size size, const Executor& executor) {
  const Frame whole = frame.ofOneTime();
  layout_ = whole.layout();
  layout_.size = size;
  if (layout_.format == PixelFormat::Gray8)
    return reduce({whole.plane(0), 1, whole.size(), size}, std::array{planeOf(0, size, 0)},
                  executor);
  if (const auto order = yuvOrderOf(layout_.format)) return loadYuv(whole, *order, executor);
  loadColours(whole, executor);
}

/// Makes room for a plane, and tells how it is filled.
ReducedFrame::Channel ReducedFrame::planeOf(size_t plane, Size size, int offsetBytes) {
  Image<uint8_t>& image = planes_[plane];
  image.resize(size);
  return {offsetBytes, image.row(0), image.view().strideBytes, 1};
}

void ReducedFrame::loadYuv(const Frame& frame, const YuvOrder& order, const Executor& executor) {
  layout_.format = PixelFormat::I420;
  const Size whole = frame.size(), size = layout_.size;
  const Size chroma{(whole.width + 1) / 2, roundedUpShift(whole.height, order.chromaRowShift)};
  const Size toChroma{(size.width + 1) / 2, (size.height + 1) / 2};
  const auto samples = [&](const SamplePlace& place, Size from, Size to) {
    const int step = order.hasTenBits ? 1 : place.stepBytes;
    return Samples{frame.plane(place.plane), step, from, to, order.hasTenBits};
  };
  reduce(samples(order.luma, whole, size), std::array{planeOf(0, size, order.luma.offsetBytes)},
         executor);
  const std::array both{planeOf(1, toChroma, order.cb.offsetBytes),
                        planeOf(2, toChroma, order.cr.offsetBytes)};
  if (!order.isPlanar()) return reduce(samples(order.cb, chroma, toChroma), both, executor);
  reduce(samples(order.cb, chroma, toChroma), std::span(both).first(1), executor);
  reduce(samples(order.cr, chroma, toChroma), std::span(both).last(1), executor);
}

void ReducedFrame::loadColours(const Frame& frame, const Executor& executor) {
  const PixelFormat format = frame.layout().format;
  const Size whole = frame.size(), size = layout_.size;
  layout_.format = PixelFormat::Rgb;
  Image<uint8_t>& rgb = planes_[0];
  rgb.resize({3 * size.width, size.height});
  const auto channel = [&](int offset, int place) {
    return Channel{offset, rgb.row(0) + place, rgb.view().strideBytes, 3};
  };
  if (format == PixelFormat::Gbr) {
    for (const auto& [plane, place] : {std::pair{0, 1}, {1, 2}, {2, 0}})
      reduce({frame.plane(plane), 1, whole, size}, std::array{channel(0, place)}, executor);
    return;
  }
  const PackedOrder order = orderOf(format);
  reduce({frame.plane(0), order.bytesPerPixel, whole, size},
         std::array{channel(order.red, 0), channel(order.green, 1), channel(order.blue, 2)},
         executor);
}

Frame ReducedFrame::view() const {
  std::array<PlaneMemory, Frame::kMaxPlanes> memory;
  for (size_t i = 0; i < memory.size(); ++i) {
    const ImageView<const uint8_t> plane = planes_[i].view();
    memory[i] = {plane.data,
                 static_cast<uint64_t>(plane.strideBytes) * static_cast<uint64_t>(plane.height()),
                 plane.strideBytes};
  }
  auto frame = Frame::make(layout_, memory);
  assert(frame);
  return *std::move(frame);
}

void ReducedFrame::reduce(const Samples& from, std::span<const Channel> channels,
                          const Executor& executor) {
  columns_.resize(static_cast<size_t>(from.to.width) + 1);
  for (int x = 0; x <= from.to.width; ++x)
    columns_[static_cast<size_t>(x)] = beginOf(x, from.size.width, from.to.width);
  executor.forRows(from.to.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) reduceRow(from, channels, y);
  });
}

/// First down, then across: the sums of a block of columns stay in the nearest cache.
void ReducedFrame::reduceRow(const Samples& from, std::span<const Channel> channels, int y) const {
  const int firstRow = beginOf(y, from.size.height, from.to.height);
  const int rows = std::max(beginOf(y + 1, from.size.height, from.to.height) - firstRow, 1);
  const int narrow = from.size.width / from.to.width;  // Boxes have as many columns or one more.
  const std::array means{Mean(rows * narrow), Mean(rows * (narrow + 1))};
  const int block = kBlockSums / ((narrow + 1) * from.step);
  assert(block > 0 && rows <= 2 * kMostRatio);
  const int rowSums = from.bytes.width() / (from.hasTenBits ? 2 : 1);
  std::array<uint16_t, kBlockSums> sums;
  for (int begin = 0; begin < from.to.width; begin += block) {
    const int end = std::min(begin + block, from.to.width);
    const int left = columns_[static_cast<size_t>(begin)] * from.step;
    const int count = std::min(columns_[static_cast<size_t>(end)] * from.step, rowSums) - left;
    std::fill_n(sums.data(), count, uint16_t{0});
    for (int row = firstRow; row < firstRow + rows; ++row)
      if (from.hasTenBits)
        simd::addRowOfTen(from.bytes.row(row) + 2 * left, count, sums.data());
      else
        simd::addRow(from.bytes.row(row) + left, count, sums.data());
    for (const Channel& channel : channels) {
      const uint16_t* next = sums.data() + channel.offsetBytes;
      uint8_t* to = channel.to + y * channel.strideBytes + begin * channel.stepBytes;
      for (int x = begin; x < end; ++x, to += channel.stepBytes) {
        const int columns = columns_[static_cast<size_t>(x) + 1] - columns_[static_cast<size_t>(x)];
        uint32_t sum = 0;
        for (int i = 0; i < columns; ++i, next += from.step) sum += *next;
        *to = means[static_cast<size_t>(columns - narrow)](sum);
      }
    }
  }
}

}  // namespace rg
