// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/memory/image.hpp"
#include "tests/support/failing_new.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <new>
#include <utility>

namespace rg {
namespace {

/// How many bytes between the rows' ends and the next rows' beginnings are not 0.
template <class T>
int dirtyPadding(const Image<T>& image) {
  const ImageView<const T> view = image;
  int dirty = 0;
  for (int y = 0; y < view.height(); ++y) {
    const auto* row = reinterpret_cast<const unsigned char*>(view.row(y));
    for (auto x = view.width() * static_cast<ptrdiff_t>(sizeof(T)); x < view.strideBytes; ++x)
      dirty += row[x] != 0;
  }
  return dirty;
}

/// Sets all bytes of the image's rows, padding included.
template <class T>
void soil(Image<T>& image) {
  const ImageView<T> view = image;
  for (int y = 0; y < view.height(); ++y)
    std::memset(view.row(y), 0xa5, static_cast<size_t>(view.strideBytes));
}

template <class T>
class ImageOf : public ::testing::Test {};
using Values = ::testing::Types<uint8_t, uint16_t, uint32_t, uint64_t>;
TYPED_TEST_SUITE(ImageOf, Values);

TYPED_TEST(ImageOf, RowsStartAtCacheLinesAndEndInZeros) {
  for (int width = 0; width <= 130; ++width) {
    Image<TypeParam> image({width, 5});
    ASSERT_EQ(image.size(), (Size{width, 5}));
    const ptrdiff_t stride = std::as_const(image).view().strideBytes;
    ASSERT_EQ(stride % 64, 0);
    ASSERT_GE(stride, width * static_cast<ptrdiff_t>(sizeof(TypeParam)));
    ASSERT_EQ(reinterpret_cast<uintptr_t>(image.view().data) % 64, 0U);
    ASSERT_EQ(dirtyPadding(image), 0) << width;
  }
}

TYPED_TEST(ImageOf, AnotherSizeInUsedMemoryHasZerosBehindItsRows) {
  for (int width = 1; width <= 130; ++width) {
    Image<TypeParam> image({130, 5});
    soil(image);
    image.resize({width, 4});
    ASSERT_EQ(dirtyPadding(image), 0) << width;
  }
}

TEST(Image, TheSameSizeKeepsWhatIsThere) {
  Image<uint8_t> image({70, 3});
  image.fill(7);
  const uint8_t* before = image.row(0);
  image.resize({70, 3});
  EXPECT_EQ(image.row(0), before);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 70; ++x) EXPECT_EQ(image.at(x, y), 7);
}

TEST(Image, AWarmImageKeepsItsMemory) {
  Image<uint16_t> image({200, 30});
  const uint16_t* before = image.row(0);
  testing::FailingNew none(0);
  image.resize({3, 2});
  image.resize({30, 200});
  image.resize({200, 30});
  EXPECT_EQ(image.row(0), before);
  EXPECT_FALSE(none.hasFailed());
}

TEST(Image, WhatWasMovedFromIsEmptyAndTakesASizeAgain) {
  Image<uint8_t> from({70, 3});
  from.fill(7);
  Image<uint8_t> to(std::move(from));
  EXPECT_EQ(to.at(69, 2), 7);
  EXPECT_EQ(from.size(), Size{});
  EXPECT_EQ(from.view().data, nullptr);
  from.resize({70, 3});
  from.fill(9);
  EXPECT_EQ(to.at(69, 2), 7);
  to = std::move(from);
  EXPECT_EQ(to.at(69, 2), 9);
  EXPECT_EQ(from.size(), Size{});
  from.resize({1, 1});
  from.fill(5);
  EXPECT_EQ(from.at(0, 0), 5);
}

TEST(Image, MovedToItselfStaysWhatItIs) {
  Image<uint8_t> image({5, 3});
  image.fill(7);
  Image<uint8_t>& same = image;
  image = std::move(same);
  ASSERT_EQ(image.size(), (Size{5, 3}));
  EXPECT_EQ(image.at(4, 2), 7);
}

TEST(Image, WithoutMemoryForASizeItIsEmptyAndTakesASmallerOne) {
  Image<uint8_t> image({70, 3});
  {
    testing::FailingNew failing(0);
    EXPECT_THROW(image.resize({700, 30}), std::bad_alloc);
  }
  EXPECT_EQ(image.size(), Size{});
  EXPECT_EQ(image.view().data, nullptr);
  image.resize({70, 3});
  image.fill(9);
  EXPECT_EQ(image.at(69, 2), 9);
  EXPECT_EQ(dirtyPadding(image), 0);
}

TEST(Image, NoPixelsNeedNoMemory) {
  testing::FailingNew failing(0);
  for (const Size size : {Size{0, 0}, Size{0, 9}, Size{9, 0}}) {
    Image<uint32_t> image(size);
    EXPECT_EQ(image.size(), size);
    image.fill(1);
  }
  EXPECT_FALSE(failing.hasFailed());
}

}  // namespace
}  // namespace rg
