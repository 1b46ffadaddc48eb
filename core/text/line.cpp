// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/line.hpp"

#include "core/base/pixel.hpp"

#include <array>
#include <cassert>
#include <charconv>
#include <chrono>

namespace rg::text {
namespace {

template <class Integer>
void appendDigits(std::string& out, Integer value) {
  std::array<char, 24> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

/// At least `width` digits, zeros in front.
void appendPadded(std::string& out, uint64_t value, size_t width) {
  std::array<char, 24> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  const auto length = static_cast<size_t>(end - digits.data());
  if (length < width) out.append(width - length, '0');
  out.append(digits.data(), end);
}

int64_t powerOfTen(int exponent) {
  int64_t power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

}  // namespace

void appendInteger(std::string& out, int64_t value) {
  appendDigits(out, value);
}

void appendUnsigned(std::string& out, uint64_t value) {
  appendDigits(out, value);
}

void appendFixed(std::string& out, int64_t numerator, int64_t denominator, int decimals) {
  assert(denominator > 0 && decimals >= 1 && decimals <= 6);
  appendDecimal(out, divideRounded(numerator * powerOfTen(decimals), denominator), decimals);
}

void appendDecimal(std::string& out, int64_t value, int decimals) {
  assert(decimals >= 1 && decimals <= 18);
  const auto unit = static_cast<uint64_t>(powerOfTen(decimals));
  const auto magnitude = static_cast<uint64_t>(value < 0 ? -value : value);
  if (value < 0) out += '-';
  appendDigits(out, magnitude / unit);
  out += '.';
  appendPadded(out, magnitude % unit, static_cast<size_t>(decimals));
}

void appendUtc(std::string& out, uint64_t nsSince1970) {
  constexpr uint64_t kNsPerSecond = 1'000'000'000;
  const uint64_t seconds = nsSince1970 / kNsPerSecond;
  const auto days = static_cast<int64_t>(seconds / 86400);
  const uint64_t second = seconds % 86400;
  const std::chrono::year_month_day date{std::chrono::sys_days{std::chrono::days{days}}};
  appendPadded(out, static_cast<uint64_t>(static_cast<int>(date.year())), 4);
  out += '-';
  appendPadded(out, static_cast<unsigned>(date.month()), 2);
  out += '-';
  appendPadded(out, static_cast<unsigned>(date.day()), 2);
  out += 'T';
  appendPadded(out, second / 3600, 2);
  out += ':';
  appendPadded(out, second / 60 % 60, 2);
  out += ':';
  appendPadded(out, second % 60, 2);
  out += '.';
  appendPadded(out, nsSince1970 % kNsPerSecond, 9);
  out += 'Z';
}

}  // namespace rg::text
