// SPDX-License-Identifier: LGPL-2.1-or-later
// Memory as a device has it, for kernels on the host: rows farther apart than they are long, guards
// round them, nothing in them that a kernel could mistake for its result.
#pragma once

#include "core/base/bit_mask.hpp"
#include "core/base/memory/image.hpp"
#include "kernels/views.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace rg::test {

/// A plane of `size`, of which kernels may touch whole words of 64 columns.
template <class T>
class Plane {
 public:
  static constexpr std::byte kGuard{0xA5};
  explicit Plane(Size size) : size_(size) {
    touchable_ = static_cast<size_t>(gpu::wordsOf(size.width)) * kWordColumns * sizeof(T);
    stride_ = (touchable_ + 2 * kAlign) / kAlign * kAlign;
    bytes_.assign(stride_ * (static_cast<size_t>(size.height) + 2) + kAlign, kGuard);
  }
  explicit Plane(ImageView<const T> from) : Plane(from.size) {
    for (int y = 0; y < size_.height; ++y)
      std::memcpy(view().row(y), from.row(y), static_cast<size_t>(size_.width) * sizeof(T));
  }

  [[nodiscard]] ImageView<T> view() {
    return {reinterpret_cast<T*>(first()), size_, static_cast<ptrdiff_t>(stride_)};
  }
  operator ImageView<T>() { return view(); }        // NOLINT(google-explicit-constructor)
  operator ImageView<const T>() { return view(); }  // NOLINT(google-explicit-constructor)

  /// The columns of each row are `expected`, and nothing else was written.
  void expect(ImageView<const T> expected, const char* what) {
    ASSERT_EQ(expected.size, size_) << what;
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x)
        ASSERT_EQ(+view().at(x, y), +expected.at(x, y)) << what << " at " << x << ", " << y;
    expectGuarded(what);
  }
  void expectGuarded(const char* what) {
    const std::byte* const begin = bytes_.data();
    const auto rows = static_cast<size_t>(size_.height);
    for (size_t i = 0; i < bytes_.size(); ++i) {
      const auto offset = static_cast<size_t>(begin + i - first());
      const bool isOurs =
          begin + i >= first() && offset / stride_ < rows && offset % stride_ < touchable_;
      ASSERT_TRUE(isOurs || bytes_[i] == kGuard) << what << ": a write outside";
    }
  }

 private:
  static constexpr size_t kAlign = 64;
  /// The second row begins on a boundary: before it are guards.
  std::byte* first() {
    const auto address = reinterpret_cast<uintptr_t>(bytes_.data() + stride_);
    return bytes_.data() + stride_ + (kAlign - address % kAlign) % kAlign;
  }

  Size size_;
  size_t touchable_ = 0, stride_ = 0;
  std::vector<std::byte> bytes_;
};

/// A mask in such memory.
class Bits {
 public:
  explicit Bits(Size size) : size_(size), words_({gpu::wordsOf(size.width), size.height}) {}
  explicit Bits(const BitMask& mask) : Bits(mask.size()) {
    for (int y = 0; y < size_.height; ++y)
      std::copy_n(mask.row(y), mask.wordsPerRow(), words_.view().row(y));
  }
  operator gpu::BitTarget() { return {words_.view(), size_}; }  // NOLINT(*-explicit-constructor)
  operator gpu::BitView() { return {words_.view(), size_}; }    // NOLINT(*-explicit-constructor)

  void expect(const BitMask& expected, const char* what) {
    for (int y = 0; y < size_.height; ++y)
      for (int word = 0; word < expected.wordsPerRow(); ++word)
        ASSERT_EQ(words_.view().at(word, y), expected.row(y)[word])
            << what << ": word " << word << " of row " << y;
    words_.expectGuarded(what);
  }

 private:
  Size size_;
  Plane<uint64_t> words_;
};

/// A list. Beside those on both sides nothing is written.
template <class T>
class Guarded {
 public:
  Guarded(const std::vector<T>& values, const T& guard) : values_(values), guard_(guard) {
    values_.push_back(guard);
    values_.insert(values_.begin(), guard);
  }
  T* data() { return values_.data() + 1; }
  template <class Same>
  void expect(const std::vector<T>& expected, const Same& isSame) {
    ASSERT_EQ(expected.size() + 2, values_.size());
    for (size_t i = 0; i < expected.size(); ++i)
      ASSERT_TRUE(isSame(values_[i + 1], expected[i])) << "number " << i;
    ASSERT_TRUE(isSame(values_.front(), guard_) && isSame(values_.back(), guard_));
  }
  void expectGuarded() {
    ASSERT_TRUE(values_.front() == guard_ && values_.back() == guard_) << "a write outside";
  }

 private:
  std::vector<T> values_;
  T guard_;
};

}  // namespace rg::test
