// SPDX-License-Identifier: LGPL-2.1-or-later
// What kernels are given: views of device memory, trivially copyable, laid out as core lays out the
// same thing on the host.
//
// Planes of bytes: rows start on 64-byte boundaries and can be read and written up to the next
// multiple of 64 columns, as an Image's are (core/base/memory/image.hpp).
#pragma once

#include "core/base/bit_mask.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>
#include <type_traits>

namespace rg::gpu {

/// A mask of a bit a pixel (core/base/bit_mask.hpp). Bits beyond the width are 0.
struct BitView {
  ImageView<const uint64_t> words;
  Size size;
};
struct BitTarget {
  ImageView<uint64_t> words;
  Size size;
  constexpr operator BitView() const { return {words, size}; }  // NOLINT(*-explicit-constructor)
};

[[nodiscard]] constexpr int wordsOf(int columns) {
  return (columns + kWordColumns - 1) / kWordColumns;
}
/// The bits of a row's word that stand for columns.
[[nodiscard]] constexpr uint64_t columnsOf(int width, int word) {
  const int columns = width - word * kWordColumns;
  return columns >= kWordColumns ? ~uint64_t{0} : (uint64_t{1} << columns) - 1;
}
static_assert(columnsOf(65, 0) == ~uint64_t{0} && columnsOf(65, 1) == 1);
[[nodiscard]] constexpr bool isSet(const BitView& mask, int x, int y) {
  return (mask.words.row(y)[x / kWordColumns] >> (x % kWordColumns) & 1) != 0;
}

/// Up to three planes of one size: green, red, blue, as the models take them; a grey picture has
/// the first only.
template <class T>
struct PlanesOf {
  ImageView<T> planes[3];
  int channels = 0;
  [[nodiscard]] constexpr Size size() const { return planes[0].size; }
  constexpr operator PlanesOf<const T>() const  // NOLINT(google-explicit-constructor)
      requires(!std::is_const_v<T>) {
    return {{planes[0], planes[1], planes[2]}, channels};
  }
};
using Planes = PlanesOf<const uint8_t>;
using PlaneTargets = PlanesOf<uint8_t>;

}  // namespace rg::gpu
