// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/which.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <type_traits>
#include <vector>

namespace rg {
namespace {

using Seat = Which<struct SeatKind, uint16_t>;
using Guest = Which<struct GuestKind, uint16_t>;

static_assert(!std::is_convertible_v<int, Seat> && !std::is_constructible_v<Seat, int>);
static_assert(!std::is_convertible_v<Seat, int> && !std::is_convertible_v<Seat, bool>);
static_assert(!std::is_constructible_v<Seat, Guest> && !std::is_assignable_v<Seat&, Guest>);
static_assert(!std::equality_comparable_with<Seat, Guest>);
static_assert(std::is_trivially_copyable_v<Seat> && sizeof(Seat) == sizeof(uint16_t));

TEST(Which, IsNoneUnlessTold) {
  EXPECT_FALSE(Seat());
  EXPECT_EQ(Seat(), Seat::ofNumber(0));
  EXPECT_TRUE(Seat::ofIndex(0));
  EXPECT_NE(Seat::ofIndex(0), Seat());
}

TEST(Which, NumbersAreOneMoreThanIndices) {
  for (const uint32_t index : {0u, 1u, 255u, 65534u}) {
    EXPECT_EQ(Seat::ofIndex(index).index(), index);
    EXPECT_EQ(Seat::ofIndex(index).number(), index + 1);
    EXPECT_EQ(Seat::ofNumber(static_cast<uint16_t>(index + 1)).index(), index);
  }
}

TEST(Which, NoneComesFirst) {
  EXPECT_LT(Seat(), Seat::ofIndex(0));
  EXPECT_LT(Seat::ofIndex(0), Seat::ofIndex(1));
  EXPECT_LT(Seat::ofIndex(255), Seat::ofIndex(256));
}

TEST(Which, ListsHoldTheNumbersOfPlanes) {
  const std::vector<Seat> seats{Seat::ofIndex(6), Seat(), Seat::ofIndex(0)};
  const std::vector<uint16_t> row{7, 0, 1};
  EXPECT_EQ(std::memcmp(seats.data(), row.data(), sizeof(uint16_t) * row.size()), 0);
}

}  // namespace
}  // namespace rg
