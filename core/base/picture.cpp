// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/picture.hpp"

#include "core/simd/base/conversion.hpp"
#include "core/simd/base/double_rows.hpp"
#include "core/simd/base/picture_rows.hpp"

#include <algorithm>
#include <array>

namespace rg {
namespace {

constexpr int kBlock = 2048;  // Columns whose samples are put side by side at a time; even.

ColourRows rowsOf(const PicturePlanes& planes, int y) {
  return {planes.red.row(y), planes.green.row(y), planes.blue.row(y), planes.luma.row(y)};
}

/// Samples of a row, side by side: as they lie where they do, else put there in `room`.
const uint8_t* sideBySide(const SpacedRow& row, int count, uint8_t* room) {
  if (row.stepBytes == 1) return row.first;
  simd::gatherRow(row, count, room);
  return room;
}

/// A row of Y'CbCr that lies in another way than loadYuvRow takes it.
void loadSpacedRow(const SpacedRow& luma, const SpacedRow& cb, const SpacedRow& cr, int width,
                   const YuvToRgb& k, const ColourRows& to) {
  std::array<uint8_t, kBlock> lumaRoom;
  std::array<uint8_t, kBlock / 2> cbRoom, crRoom;
  const auto from = [](const SpacedRow& row, int at) {
    return SpacedRow{row.first + ptrdiff_t{at} * row.stepBytes, row.stepBytes, row.hasTenBits};
  };
  for (int x = 0; x < width; x += kBlock) {
    const int count = std::min(kBlock, width - x), chroma = (count + 1) / 2;
    simd::loadYuvRow({sideBySide(from(luma, x), count, lumaRoom.data()),
                      sideBySide(from(cb, x / 2), chroma, cbRoom.data()),
                      sideBySide(from(cr, x / 2), chroma, crRoom.data()), 1},
                     count, k, {to.red + x, to.green + x, to.blue + x, to.luma + x});
  }
}

void loadYuvRow(const Frame& frame, const YuvOrder& order, int y, const YuvToRgb& k,
                const ColourRows& to) {
  const auto rowOf = [&](const SamplePlace& place, int row) {
    return SpacedRow{frame.plane(place.plane).row(row) + place.offsetBytes, place.stepBytes,
                     order.hasTenBits};
  };
  const int chroma = y >> order.chromaRowShift;
  const SpacedRow luma = rowOf(order.luma, y), cb = rowOf(order.cb, chroma),
                  cr = rowOf(order.cr, chroma);
  const bool areCbCr = cb.stepBytes == 2 && cr.first == cb.first + 1;
  if (luma.stepBytes == 1 && (cb.stepBytes == 1 || areCbCr))
    simd::loadYuvRow({luma.first, cb.first, cr.first, cb.stepBytes}, frame.size().width, k, to);
  else
    loadSpacedRow(luma, cb, cr, frame.size().width, k, to);
}

/// Row y of a plane that becomes twice as large; beyond its border it goes on as at the border.
void doubleRow(ImageView<const uint8_t> from, int y, uint8_t* to) {
  constexpr int kBeside = 2;  // Columns that are read at either side.
  const Size size = from.size;
  const auto row = [&](int at) { return from.row(std::clamp(at, 0, size.height - 1)); };
  const int here = y / 2, way = y % 2 == 0 ? -1 : 1;
  const simd::QuarterRows rows{row(here), row(here + way), row(here - way), row(here + 2 * way)};
  std::array<int16_t, kBlock + 2 * kBeside> room;
  for (int begin = 0; begin < size.width; begin += kBlock) {
    const int end = std::min(begin + kBlock, size.width);
    const int first = std::max(begin - kBeside, 0), last = std::min(end + kBeside, size.width);
    int16_t* sums = room.data() + (first - begin + kBeside);
    simd::sumQuarter(
        {rows.here + first, rows.next + first, rows.behind + first, rows.afterNext + first},
        last - first, sums);
    std::fill(room.data(), sums, *sums);
    int16_t* behind = sums + (last - first);
    std::fill(behind, room.data() + (end - begin + 2 * kBeside), behind[-1]);
    simd::doubleSums(room.data() + kBeside, end - begin, to + 2 * ptrdiff_t{begin});
  }
}

}  // namespace

void loadPlanes(const Frame& given, const Executor& executor, const PicturePlanes& to) {
  const Frame frame = given.ofOneTime();
  const int rowsEach = given.layout().isInterlaced ? 2 : 1;
  const FrameLayout& layout = frame.layout();
  const int width = layout.size.width;
  const YuvToRgb k = yuvToRgb(layout.matrix, layout.range);
  const auto order = yuvOrderOf(layout.format);
  executor.forRows(given.size().height, [&](int first, int last) {
    for (int row = first; row < last; ++row) {
      const int y = row / rowsEach;
      const uint8_t* from = frame.plane(0).row(y);
      if (layout.format == PixelFormat::Gray8)
        std::copy_n(from, width, to.luma.row(row));
      else if (order)
        loadYuvRow(frame, *order, y, k, rowsOf(to, row));
      else if (layout.format == PixelFormat::Gbr)
        simd::loadPlanarRow(frame.plane(2).row(y), from, frame.plane(1).row(y), width,
                            rowsOf(to, row));
      else
        simd::loadPackedRow(from, width, orderOf(layout.format), rowsOf(to, row));
    }
  });
}

Picture::Planes Picture::readOn(Device& device) const {
  const ImageView<const uint8_t> luma = luma_.readOn(device);
  if (isGrey_) return {luma, luma, luma, luma};
  return {red_.readOn(device), green_.readOn(device), blue_.readOn(device), luma};
}

void Picture::resize(Size size, bool isGrey) {
  isGrey_ = isGrey;
  luma_.resize(size);
  if (!isGrey_)
    for (Image<uint8_t>* plane : {&red_, &green_, &blue_}) plane->resize(size);
}

PicturePlanes Picture::writeOn(Device& device, Size size, bool isGrey) {
  resize(size, isGrey);
  if (isGrey) return {{}, {}, {}, luma_.writeOn(device)};
  return {red_.writeOn(device), green_.writeOn(device), blue_.writeOn(device),
          luma_.writeOn(device)};
}

void Picture::readOnHost() const {
  luma_.readOnHost();
  if (!isGrey_)
    for (const Image<uint8_t>* plane : {&red_, &green_, &blue_}) plane->readOnHost();
}

void Picture::load(const Frame& frame, const Executor& executor) {
  resize(frame.size(), frame.layout().format == PixelFormat::Gray8);
  for (Image<uint8_t>* plane : {&red_, &green_, &blue_, &luma_}) plane->writeOnHost();
  loadPlanes(frame, executor, {red_, green_, blue_, luma_});
}

void Picture::loadDoubled(const Picture& from, const Executor& executor) {
  const Size size = doubled(from.size());
  resize(size, from.isGrey_);
  const auto planesOf = [](auto& picture) {
    return std::array{&picture.luma_, &picture.red_, &picture.green_, &picture.blue_};
  };
  const auto given = planesOf(from);
  const auto made = planesOf(*this);
  for (size_t i = 0; i < (isGrey_ ? 1 : made.size()); ++i) {
    made[i]->writeOnHost();
    const ImageView<const uint8_t> plane = given[i]->view();
    const ImageView<uint8_t> to = made[i]->view();
    executor.forRows(size.height, [&](int first, int last) {
      for (int y = first; y < last; ++y) doubleRow(plane, y, to.row(y));
    });
  }
}

Image<uint8_t>& Picture::writeGrey(Size size) {
  isGrey_ = true;
  luma_.resize(size);
  luma_.writeOnHost();
  return luma_;
}

}  // namespace rg
