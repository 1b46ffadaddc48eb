// SPDX-License-Identifier: LGPL-2.1-or-later
// The pixels of a result: a plane while stages work on them, runs along the rows once only readers
// are left. A frame that waits in a queue then holds a tenth of the memory.
#pragma once

#include "core/base/mapping.hpp"
#include "core/base/memory/image.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace rg {

/// Of each square of four pixels in two rows the second smallest, which is what three of them are:
/// a plane of twice the size as readers are shown it. `count` squares.
template <class T>
void halveRows(const T* upper, const T* lower, int count, T* to) {
  for (int x = 0; x < count; ++x) {
    const auto [a, b] = std::minmax(upper[2 * x], upper[2 * x + 1]);
    const auto [c, d] = std::minmax(lower[2 * x], lower[2 * x + 1]);
    to[x] = std::min(std::max(a, c), std::min(b, d));
  }
}

template <class T>
class ResultPlane : public Image<T> {
 public:
  using Image<T>::Image;
  using Image<T>::copyFrom;

  /// Packed pixels are read by unpacked() and unpackedRow() only: row() and view() show nothing.
  [[nodiscard]] bool isPacked() const { return isPacked_; }
  [[nodiscard]] Size pixelSize() const { return isPacked_ ? size_ : this->size(); }

  /// The pixels, in `scratch` where they must be unpacked. Throws std::bad_alloc.
  [[nodiscard]] ImageView<const T> unpacked(Image<T>& scratch) const {
    if (!isPacked_) return this->view();
    if (whole_.size() == size_) return whole_.view();
    scratch.resize(size_);
    for (int y = 0; y < size_.height; ++y) unpackRow(y, scratch.row(y));
    return scratch.view();
  }

  /// One row of them, in `scratch` where it must be unpacked.
  [[nodiscard]] const T* unpackedRow(int y, std::vector<T>& scratch) const {
    if (!isPacked_) return this->row(y);
    if (whole_.size() == size_) return whole_.row(y);
    scratch.resize(static_cast<size_t>(size_.width));
    unpackRow(y, scratch.data());
    return scratch.data();
  }

  /// What came from elsewhere, for readers only. Takes the pixels.
  void takePacked(Image<T> pixels) {
    *this = {};
    isPacked_ = true;
    size_ = pixels.size();
    whole_ = std::move(pixels);
  }

  void copyFrom(const ResultPlane& other) {
    isPacked_ = other.isPacked_;
    size_ = other.size_;
    starts_ = other.starts_;
    begins_ = other.begins_;
    values_ = other.values_;
    whole_.copyFrom(other.whole_);
    Image<T>::copyFrom(other.view());
  }

 private:
  friend class PlanePacker;

  void unpackRow(int y, T* row) const {
    if (starts_.empty()) return scaleRow(y, row);
    const int height = static_cast<int>(starts_.size()) - 1;
    const auto at = static_cast<size_t>(FrameMap{{1, height}, {1, size_.height}}.sourceY(y));
    const auto first = starts_[at], last = starts_[at + 1];
    for (size_t i = first; i < last; ++i) {
      const int end = i + 1 < last ? begins_[i + 1] : size_.width;
      std::fill(row + begins_[i], row + end, values_[i]);
    }
  }

  void scaleRow(int y, T* row) const {
    const FrameMap map{whole_.size(), size_};
    const T* from = whole_.row(map.sourceY(y));
    for (int x = 0; x < size_.width; ++x) row[x] = from[map.sourceX(x)];
  }

  bool isPacked_ = false;
  Size size_;                     ///< When packed, as it is shown: rows may be those of another.
  std::vector<uint32_t> starts_;  ///< Runs of packed row y: starts_[y] … starts_[y + 1] − 1.
  std::vector<uint16_t> begins_;  ///< First column of each run, which ends where the next begins.
  std::vector<T> values_;
  Image<T> whole_;  ///< Instead of runs, where those would take more.
};

/// Fills packed planes. Its memory serves one frame after the other.
class PlanePacker {
 public:
  /// Shown at half the size, each pixel is as halveRows() says; at another one, it is that of
  /// `from` that lies under its centre; what is empty stays so. Columns are 16 bits wide: pictures
  /// are narrower than 65536. Throws std::bad_alloc; `to` is to be filled anew then.
  template <class T>
  void pack(const ResultPlane<T>& from, ResultPlane<T>& to, Size shown);

 private:
  template <class T>
  void packView(ImageView<const T> from, ResultPlane<T>& to);
  template <class T>
  bool packRows(ImageView<const T> from, ResultPlane<T>& to);
  std::vector<uint16_t> row_, begins_;
  std::tuple<Image<uint8_t>, Image<uint16_t>> halves_;
};

}  // namespace rg
