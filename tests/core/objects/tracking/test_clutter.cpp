// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/clutter.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

constexpr int64_t kStepNs = 40'000'000;

TEST(Clutter, AFewThingsThatVanishAreNoClutter) {
  objects::Clutter clutter;
  for (int i = 0; i < 8; ++i) clutter.learn(100);
  EXPECT_EQ(clutter.leastPx(), 0);
}

TEST(Clutter, ObjectsAreLargerThanWhatComesAndGoesAllTheTime) {
  objects::Clutter clutter;
  for (int i = 0; i < 200; ++i) {
    clutter.learn(100);
    if (i % 100 == 0) clutter.learn(5000);  // A large thing now and then is no rule.
    clutter.age(kStepNs);
  }
  EXPECT_EQ(clutter.leastPx(), 128);
}

TEST(Clutter, IsForgotten) {
  objects::Clutter clutter;
  for (int i = 0; i < 1000; ++i) clutter.learn(100);
  clutter.age(INT64_MAX);
  EXPECT_EQ(clutter.leastPx(), 0);
}

TEST(Clutter, TakesAnyArea) {
  objects::Clutter clutter;
  for (int i = 0; i < 20; ++i) {
    clutter.learn(-1);
    clutter.learn(0);
  }
  EXPECT_EQ(clutter.leastPx(), 0);
  for (int i = 0; i < 20; ++i) clutter.learn(INT64_MAX);
  EXPECT_EQ(clutter.leastPx(), int64_t{1} << 31);
}

TEST(Clutter, NoStepIsTooLongOrTooShort) {
  objects::Clutter clutter;
  for (int i = 0; i < 20; ++i) clutter.learn(100);
  for (const int64_t step : {INT64_MIN, int64_t{-1}, int64_t{249'999'999}}) clutter.age(step);
  EXPECT_EQ(clutter.leastPx(), 128);
  for (int i = 0; i < 3; ++i) clutter.age(INT64_MAX);
  EXPECT_EQ(clutter.leastPx(), 0);
}

}  // namespace
}  // namespace rg
