// SPDX-License-Identifier: LGPL-2.1-or-later
// Two-dimensional arrays: a view that borrows and an image that owns.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/memory/device.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

namespace rg {

/// Borrowed rows of `width` elements, `strideBytes` apart. Trivially copyable, so that it can be
/// handed to a GPU kernel by value.
template <class T>
struct ImageView {
  T* data = nullptr;
  Size size;
  ptrdiff_t strideBytes = 0;

  [[nodiscard]] constexpr int width() const { return size.width; }
  [[nodiscard]] constexpr int height() const { return size.height; }
  [[nodiscard]] constexpr T* row(int y) const {
    assert(y >= 0 && y < size.height);
    using Byte = std::conditional_t<std::is_const_v<T>, const std::byte, std::byte>;
    return reinterpret_cast<T*>(reinterpret_cast<Byte*>(data) + y * strideBytes);
  }
  [[nodiscard]] constexpr T& at(int x, int y) const {
    assert(x >= 0 && x < size.width);
    return row(y)[x];
  }
  /// The part inside `box`, which must lie within the view.
  [[nodiscard]] ImageView crop(const Box& box) const {
    assert(intersect(box, boundsOf(size)) == box || box.isEmpty());
    return {box.isEmpty() ? data : row(box.y) + box.x, {box.width, box.height}, strideBytes};
  }
  constexpr operator ImageView<const T>() const  // NOLINT(google-explicit-constructor)
      requires(!std::is_const_v<T>) {
    return {data, size, strideBytes};
  }
};

/// Owns its pixels; rows start on 64-byte boundaries. Move-only: a copy would be a hidden cost.
///
/// A device may hold the same pixels (memory/device.hpp). Whoever looks at them here says so first,
/// with readOnHost() or changeOnHost(), wherever a device may have been at work.
template <class T>
class Image {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Image() = default;
  explicit Image(Size size) { resize(size); }

  Image(Image&& other) noexcept { swap(other); }
  Image& operator=(Image&& other) noexcept {
    Image taken(std::move(other));
    swap(taken);
    return *this;
  }

  /// Gives the image a size. Keeps its memory when that is large enough, so that a warm image never
  /// allocates; the contents are undefined. Throws std::bad_alloc, and is empty then.
  void resize(Size size) {
    assert(size.width >= 0 && size.height >= 0);
    if (size == size_) return;
    const size_t stride =
        (static_cast<size_t>(size.width) * sizeof(T) + kAlign - 1) / kAlign * kAlign;
    const size_t bytes = stride * static_cast<size_t>(size.height);
    if (bytes > capacity_) {
      *this = Image();
      memory_.reset(static_cast<std::byte*>(::operator new (bytes, std::align_val_t{kAlign})));
      capacity_ = bytes;
    }
    copies_.drop();
    size_ = size;
    strideBytes_ = static_cast<ptrdiff_t>(stride);
    clearPadding();
  }

  void fill(T value) {
    writeOnHost();
    for (int y = 0; y < size_.height; ++y) std::fill_n(row(y), size_.width, value);
  }
  void copyFrom(ImageView<const T> source) {
    resize(source.size);
    writeOnHost();
    for (int y = 0; y < size_.height; ++y)
      std::memcpy(row(y), source.row(y), static_cast<size_t>(size_.width) * sizeof(T));
  }

  [[nodiscard]] Size size() const { return size_; }
  [[nodiscard]] int width() const { return size_.width; }
  [[nodiscard]] int height() const { return size_.height; }
  [[nodiscard]] T* row(int y) { return view().row(y); }
  [[nodiscard]] const T* row(int y) const { return view().row(y); }
  [[nodiscard]] T& at(int x, int y) { return view().at(x, y); }
  [[nodiscard]] const T& at(int x, int y) const { return view().at(x, y); }
  [[nodiscard]] ImageView<T> view() {
    assert(!copies_ || copies_->isOnHostOnly());
    return {reinterpret_cast<T*>(memory_.get()), size_, strideBytes_};
  }
  [[nodiscard]] ImageView<const T> view() const {
    assert(!copies_ || copies_->isOnHost());
    return {reinterpret_cast<const T*>(memory_.get()), size_, strideBytes_};
  }
  operator ImageView<T>() { return view(); }              // NOLINT(google-explicit-constructor)
  operator ImageView<const T>() const { return view(); }  // NOLINT(google-explicit-constructor)

  /// The pixels are here then. Waits for the device, where it has changed them; throws DeviceError
  /// when it is lost.
  void readOnHost() const {
    if (copies_) copies_->readOnHost(memory_.get());
  }
  /// And what the device holds counts no more.
  void changeOnHost() {
    if (copies_) copies_->changeOnHost(memory_.get());
  }
  /// All of them will be written: nothing is fetched.
  void writeOnHost() {
    if (copies_) copies_->writeOnHost();
  }

  /// Where the device has the pixels, the same layout. They are sent when they are not there yet.
  /// Throws DeviceError.
  [[nodiscard]] ImageView<const T> readOn(Device& device) const {
    return {static_cast<const T*>(copies().read(device, memory_.get())), size_, strideBytes_};
  }
  /// And what is here counts no more.
  [[nodiscard]] ImageView<T> changeOn(Device& device) {
    return {static_cast<T*>(copies().change(device, memory_.get())), size_, strideBytes_};
  }
  /// All of them will be written: nothing is sent.
  [[nodiscard]] ImageView<T> writeOn(Device& device) {
    return {static_cast<T*>(copies().write(device)), size_, strideBytes_};
  }

 private:
  static constexpr size_t kAlign = 64;
  struct Free {
    void operator()(std::byte* memory) const {
      ::operator delete (memory, std::align_val_t{kAlign});
    }
  };

  [[nodiscard]] DeviceCopies& copies() const {
    return copies_.get(static_cast<size_t>(strideBytes_) * static_cast<size_t>(size_.height));
  }

  /// Zeros behind the rows: kernels load whole vectors, and what they make of bytes that nobody
  /// wrote would hide from valgrind what they make of pixels that nobody wrote.
  void clearPadding() {
    const size_t used = static_cast<size_t>(size_.width) * sizeof(T);
    const size_t stride = static_cast<size_t>(strideBytes_);
    if (used == stride) return;
    std::byte* row = memory_.get();
    for (int y = 0; y < size_.height; ++y, row += stride) std::memset(row + used, 0, stride - used);
  }
  /// What was moved from is empty: its size must not outlive its memory.
  void swap(Image& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(capacity_, other.capacity_);
    std::swap(size_, other.size_);
    std::swap(strideBytes_, other.strideBytes_);
    copies_.swap(other.copies_);
  }

  std::unique_ptr<std::byte, Free> memory_;
  size_t capacity_ = 0;
  Size size_;
  ptrdiff_t strideBytes_ = 0;
  mutable LazyCopies copies_;  ///< None: no device has ever seen it.
};

}  // namespace rg
