// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/picture.hpp"

#include "core/simd/base/conversion.hpp"
#include "core/simd/base/picture_rows.hpp"

#include <algorithm>

namespace rg {
void loadPlanes(const Frame& frame, const Executor& executor, const PicturePlanes& to) {
  const FrameLayout& layout = frame.layout();
  const Size size = layout.size;
  const YuvToRgb k = yuvToRgb(layout.matrix, layout.range);
  executor.forRows(size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const uint8_t* from = frame.plane(0).row(y);
      if (layout.format == PixelFormat::Gray8) {
        std::copy_n(from, size.width, to.luma.row(y));
        continue;
      }
      const ColourRows rows{to.red.row(y), to.green.row(y), to.blue.row(y), to.luma.row(y)};
      if (layout.format == PixelFormat::Nv12) {
        const uint8_t* chroma = frame.plane(1).row(y / 2);
        simd::loadYuvRow({from, chroma, chroma + 1, 2}, size.width, k, rows);
      } else if (layout.format == PixelFormat::I420) {
        simd::loadYuvRow({from, frame.plane(1).row(y / 2), frame.plane(2).row(y / 2), 1},
                         size.width, k, rows);
      } else {
        simd::loadPackedRow(from, size.width, orderOf(layout.format), rows);
      }
    }
  });
}

Picture::Planes Picture::readOn(Device& device) const {
  const ImageView<const uint8_t> luma = luma_.readOn(device);
  if (isGrey_) return {luma, luma, luma, luma};
  return {red_.readOn(device), green_.readOn(device), blue_.readOn(device), luma};
}

void Picture::load(const Frame& frame, const Executor& executor) {
  const Size size = frame.size();
  isGrey_ = frame.layout().format == PixelFormat::Gray8;
  luma_.resize(size);
  if (!isGrey_)
    for (Image<uint8_t>* plane : {&red_, &green_, &blue_}) plane->resize(size);
  for (Image<uint8_t>* plane : {&red_, &green_, &blue_, &luma_}) plane->writeOnHost();
  loadPlanes(frame, executor, {red_, green_, blue_, luma_});
}

}  // namespace rg
