// SPDX-License-Identifier: LGPL-2.1-or-later
// Which one of a list, or none: what is stored and handed on in place of an integer, so that
// neither two lists nor the conventions for "none" can be taken for one another.
//
// It holds a number, 1 + index and 0 for none, as planes of labels and public structures have it:
// a list of them may be filled with zeros, and takes no more room than its integers. Loops over all
// of a list go on counting with integers. Order: none first, then by index.
#pragma once

#include <cassert>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace rg {

/// Kind: a tag of the list, which need not be defined. Number: what is wide enough for its length.
template <class Kind, std::unsigned_integral Number>
class Which {
 public:
  constexpr Which() = default;

  [[nodiscard]] static constexpr Which ofIndex(size_t index) {
    assert(index < std::numeric_limits<Number>::max());
    return ofNumber(static_cast<Number>(index + 1));
  }
  /// Where raw numbers come in: from a plane, a file, a public structure.
  [[nodiscard]] static constexpr Which ofNumber(Number number) {
    Which which;
    which.number_ = number;
    return which;
  }

  [[nodiscard]] constexpr explicit operator bool() const { return number_ != 0; }
  /// Of one that is not none.
  [[nodiscard]] constexpr uint32_t index() const {
    assert(number_ != 0);
    return uint32_t{number_} - 1;
  }
  /// Where raw numbers go out.
  [[nodiscard]] constexpr Number number() const { return number_; }

  friend constexpr auto operator<=>(const Which&, const Which&) = default;

 private:
  Number number_ = 0;
};

}  // namespace rg
