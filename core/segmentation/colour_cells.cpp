// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/colour_cells.hpp"

#include "core/simd/segmentation/cell_rows.hpp"
#include "core/simd/segmentation/link_rows.hpp"

#include <algorithm>

namespace rg::segmentation {
namespace {

ColourGrid planesOf(const std::array<Image<uint8_t>, 3>& images, int channels, Size size) {
  ColourGrid planes;
  planes.size = size;
  planes.channels = channels;
  for (size_t c = 0; c < 3; ++c)
    planes.colours[c] = images[c < static_cast<size_t>(channels) ? c : 0];
  return planes;
}

/// Whole rows of cells are compared, and the result out of scope is thrown away: the pixels there
/// are old ones, but never what nobody wrote.
void fillAtNewSize(Image<uint8_t>& plane, Size size) {
  if (plane.size() == size) return;
  plane.resize(size);
  plane.fill(0);
}

}  // namespace

void ColourCells::build(const Picture& picture, ImageView<const uint8_t> scope, int sidePx,
                        const Executor& executor) {
  side_ = sidePx;
  const Size size = picture.size();
  const int channels = picture.isGrey() ? 1 : 3;
  source_ = {picture.red(), picture.green(), picture.blue()};
  spans_.find(size, scope, executor);
  const Size cellSize{(size.width + side_ - 1) / side_, (size.height + side_ - 1) / side_};
  for (size_t c = 0; c < static_cast<size_t>(channels); ++c) {
    fillAtNewSize(smooth_[c], size);
    if (side_ > 1) means_[c].resize(cellSize);
  }
  pixels_ = planesOf(smooth_, channels, size);
  pixels_.scope = scope;
  cells_ = pixels_;
  if (side_ > 1) {
    for (Image<uint8_t>* plane : {&weights_, &cellScope_, &ranges_}) plane->resize(cellSize);
    cells_ = planesOf(means_, channels, cellSize);
    cells_.sidePx = side_;
    cells_.weights = weights_;
    cells_.ranges = ranges_;
    if (scope.data != nullptr) cells_.scope = cellScope_;
  }

  scratch_.resize(static_cast<size_t>(executor.threads()));
  const int bands = (size.height + kLargestSide - 1) / kLargestSide;
  executor.forEach(bands, [&](int band, int thread) {
    Scratch& scratch = scratch_[static_cast<size_t>(thread)];
    const int first = band * kLargestSide, last = std::min(first + kLargestSide, size.height);
    for (int c = 0; c < channels; ++c)
      for (int y = first; y < last; ++y) smoothRow(y, c, scratch);
    if (side_ > 1)
      for (int row = first / side_; row * side_ < last; ++row) averageRow(row, scratch);
  });
}

void ColourCells::smoothRow(int y, int channel, Scratch& scratch) {
  const Span span = spans_.of(y);
  if (span.count() == 0) return;
  const ImageView<const uint8_t> from = source_[static_cast<size_t>(channel)];
  uint8_t* to = smooth_[static_cast<size_t>(channel)].row(y);
  const int width = from.width();
  scratch.down.resize(static_cast<size_t>(width) + 2);
  uint8_t* down = scratch.down.data() + 1;  // A column more on either side.
  const int first = std::max(span.first - 1, 0), last = std::min(span.last + 1, width);
  simd::smoothRow(from.row(std::max(y - 1, 0)) + first,
                  from.row(std::min(y + 1, from.height() - 1)) + first, from.row(y) + first,
                  last - first, down + first);
  if (first == 0) down[-1] = down[0];
  if (last == width) down[width] = down[width - 1];
  simd::smoothRow(down + span.first - 1, down + span.first + 1, down + span.first, span.count(),
                  to + span.first);
}

void ColourCells::averageRow(int cellRow, Scratch& scratch) {
  const int top = cellRow * side_, bottom = std::min(top + side_, pixels_.size.height);
  const Span span = spans_.hull(top, bottom);
  if (cells_.scope.data != nullptr)
    std::fill_n(cellScope_.row(cellRow), cells_.size.width, uint8_t{0});
  if (span.count() == 0) return;
  const Span columns{span.first / side_, (span.last + side_ - 1) / side_};
  const int padded = columns.count() * side_;
  scratch.sums.resize(static_cast<size_t>(cells_.size.width) * static_cast<size_t>(side_));
  scratch.half.resize(scratch.sums.size());
  countRow(cellRow, columns, scratch);
  findRanges(cellRow, columns, scratch);
  const int first = columns.first * side_;
  const int count = std::min(first + padded, pixels_.size.width) - first;
  for (int c = 0; c < cells_.channels; ++c) {
    std::fill_n(scratch.sums.data(), padded, uint16_t{0});
    for (int y = top; y < bottom; ++y) {
      const uint8_t* row = smooth_[static_cast<size_t>(c)].row(y) + first;
      if (pixels_.scope.data == nullptr)
        simd::addRow(row, count, scratch.sums.data());
      else
        simd::addScopedRow(row, pixels_.scope.row(y) + first, count, scratch.sums.data());
    }
    simd::divideRow(reduce(columns.count(), scratch), weights_.row(cellRow) + columns.first,
                    columns.count(), means_[static_cast<size_t>(c)].row(cellRow) + columns.first);
  }
}

void ColourCells::findRanges(int cellRow, Span columns, Scratch& scratch) {
  const int top = cellRow * side_, bottom = std::min(top + side_, pixels_.size.height);
  const int first = columns.first * side_, padded = columns.count() * side_;
  const int count = std::min(first + padded, pixels_.size.width) - first;
  uint8_t* ranges = ranges_.row(cellRow) + columns.first;
  std::fill_n(ranges, columns.count(), uint8_t{0});
  for (auto* row : {&scratch.least, &scratch.most}) row->resize(static_cast<size_t>(padded));
  uint8_t *least = scratch.least.data(), *most = scratch.most.data();
  for (int c = 0; c < cells_.channels; ++c) {
    std::fill_n(least, padded, uint8_t{255});
    std::fill_n(most, padded, uint8_t{0});
    for (int y = top; y < bottom; ++y) {
      const uint8_t* row = smooth_[static_cast<size_t>(c)].row(y) + first;
      if (pixels_.scope.data == nullptr)
        simd::widenRow(row, count, least, most);
      else
        simd::widenScopedRow(row, pixels_.scope.row(y) + first, count, least, most);
    }
    for (int side = side_; side > 1; side /= 2)
      simd::widenPairs(columns.count() * side / 2, least, most);
    simd::raiseRanges(least, most, columns.count(), ranges);
  }
}

void ColourCells::countRow(int cellRow, Span columns, Scratch& scratch) {
  const int top = cellRow * side_, bottom = std::min(top + side_, pixels_.size.height);
  uint8_t* weights = weights_.row(cellRow);
  if (pixels_.scope.data == nullptr) {
    std::fill_n(weights, cells_.size.width, static_cast<uint8_t>(side_ * (bottom - top)));
    const int rest = pixels_.size.width - (cells_.size.width - 1) * side_;
    weights[cells_.size.width - 1] = static_cast<uint8_t>(rest * (bottom - top));
    return;
  }
  const int first = columns.first * side_, padded = columns.count() * side_;
  const int count = std::min(first + padded, pixels_.size.width) - first;
  std::fill_n(scratch.sums.data(), padded, uint16_t{0});
  for (int y = top; y < bottom; ++y)
    simd::countRow(pixels_.scope.row(y) + first, count, scratch.sums.data());
  simd::splitCounts(reduce(columns.count(), scratch), columns.count(), weights + columns.first,
                    cellScope_.row(cellRow) + columns.first);
}

/// Adds up the columns of each cell.
const uint16_t* ColourCells::reduce(int cells, Scratch& scratch) const {
  uint16_t *from = scratch.sums.data(), *to = scratch.half.data();
  for (int side = side_; side > 1; side /= 2) {
    simd::addPairs(from, cells * side / 2, to);
    std::swap(from, to);
  }
  return from;
}

}  // namespace rg::segmentation
