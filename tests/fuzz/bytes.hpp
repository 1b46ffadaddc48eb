// SPDX-License-Identifier: LGPL-2.1-or-later
// A fuzzer's input as a source of numbers. Where it ends everything is 0, so that a shorter input
// says less, never something else.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

namespace rg::fuzz {

class Bytes {
 public:
  Bytes(const uint8_t* data, size_t size) : rest_(data, size) {}

  [[nodiscard]] bool isEmpty() const { return rest_.empty(); }

  template <class T = uint8_t>
  requires std::is_trivially_copyable_v<T> T take() {
    T value{};
    const size_t count = std::min(sizeof(T), rest_.size());
    if (count > 0) std::memcpy(&value, rest_.data(), count);
    rest_ = rest_.subspan(count);
    return value;
  }
  bool flip() { return (take() & 1) != 0; }
  /// One of least … most.
  template <class T>
  T between(T least, T most) {
    static_assert(std::is_integral_v<T>);
    const uint64_t range = static_cast<uint64_t>(most) - static_cast<uint64_t>(least);
    const uint64_t raw = range < 256 ? take<uint8_t>() : take<uint64_t>();
    return static_cast<T>(static_cast<uint64_t>(least) +
                          (range == UINT64_MAX ? raw : raw % (range + 1)));
  }
  template <class Choices>
  const auto& pick(const Choices& choices) {
    return choices[between<size_t>(0, std::size(choices) - 1)];
  }
  /// Up to `most` characters; none of them is 0.
  std::string text(size_t most) {
    const size_t length = std::min<size_t>(between<size_t>(0, most), rest_.size());
    std::string result;
    for (size_t i = 0; i < length; ++i) {
      const auto character = static_cast<char>(take());
      result += character == 0 ? ' ' : character;
    }
    return result;
  }
  [[nodiscard]] std::span<const uint8_t> rest() const { return rest_; }

 private:
  std::span<const uint8_t> rest_;
};

}  // namespace rg::fuzz
