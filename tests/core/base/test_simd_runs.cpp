// SPDX-License-Identifier: LGPL-2.1-or-later
// The row functions of stages 3 and 5 against plain ones: every target of this machine, odd widths
// and offsets, guards, fills that provoke overflows.
#include "core/base/pixel.hpp"
#include "core/simd/base/motion_rows.hpp"
#include "core/simd/base/run_rows.hpp"
#include "tests/core/simd_targets.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace rg {
namespace {

constexpr int kMostColumns = 257;
constexpr int kFills = 4;

uint32_t hashOf(int x, int what) {
  return mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(what), 3);
}

/// `count` bytes and no more: reading beyond them is seen by the address sanitizer.
std::vector<uint8_t> bytesOf(int count, int fill, int row) {
  std::vector<uint8_t> bytes(static_cast<size_t>(count));
  for (int x = 0; x < count; ++x) {
    const auto level = [&]() -> uint32_t {
      if (fill == 0) return 255;
      if (fill == 1) return (x + row) % 2 == 0 ? 0 : 255;
      return fill == 2 ? (row % 2 == 0 ? 0 : 255) : hashOf(x, row);
    };
    bytes[static_cast<size_t>(x)] = static_cast<uint8_t>(level());
  }
  return bytes;
}

/// Labels of runs of up to `longest` pixels.
std::vector<uint16_t> labelsOf(int count, int longest) {
  std::vector<uint16_t> labels;
  for (int i = 0; static_cast<int>(labels.size()) < count; ++i)
    labels.insert(labels.end(), 1 + hashOf(i, longest) % static_cast<uint32_t>(longest),
                  static_cast<uint16_t>(i % 2 == 0 ? 65535 - i : i));
  labels.resize(static_cast<size_t>(count));
  return labels;
}

TEST(SimdRuns, AreWhereLabelsChange) {
  for (const int longest : {1, 2, 9, 100, 1000})
    for (int count = 1; count <= kMostColumns; ++count) {
      const auto labels = labelsOf(count, longest);
      std::vector<uint16_t> expected;
      for (int x = 0; x <= count; ++x)
        if (const auto i = static_cast<size_t>(x);
            x == 0 || x == count || labels[i] != labels[i - 1])
          expected.push_back(static_cast<uint16_t>(x));
      test::forEachTarget([&] {
        std::vector<uint16_t> begins(static_cast<size_t>(count) + 1, 0xA5A5);
        const int runs = simd::findRuns(labels.data(), count, begins.data());
        EXPECT_EQ(begins[static_cast<size_t>(count)], runs == count ? count : 0xA5A5);
        begins.resize(static_cast<size_t>(runs) + 1);
        EXPECT_EQ(begins, expected) << count << " columns, runs of " << longest;
      });
    }
}

TEST(SimdRuns, LabelsAreComparedBitByBit) {
  for (int count = 1; count <= kMostColumns; ++count) {
    const auto a = labelsOf(count, 5), b = labelsOf(count, 7);
    std::vector<uint64_t> expected(static_cast<size_t>((count + 63) / 64) + 1, 0);
    expected.back() = 0xA5A5;
    for (size_t i = 0; i < a.size(); ++i)
      expected[i / 64] |= uint64_t{a[i] % 2 == b[i] % 2} << (i % 64);
    auto odd = a, even = b;
    for (uint16_t& label : odd) label %= 2;
    for (uint16_t& label : even) label %= 2;
    test::forEachTarget([&] {
      std::vector<uint64_t> words(expected.size(), 0xA5A5);
      simd::compareLabels(odd.data(), even.data(), count, words.data());
      EXPECT_EQ(words, expected) << count << " columns";
    });
  }
}

TEST(SimdRuns, AreSummedChannelByChannel) {
  for (const int longest : {1, 9, 40, 1000})
    for (int count = 1; count <= kMostColumns; count += count < 130 ? 1 : 63) {
      const auto labels = labelsOf(count, longest);
      std::vector<uint16_t> begins(static_cast<size_t>(count) + 1);
      const int runs = simd::findRuns(labels.data(), count, begins.data());
      for (int fill = 0; fill < kFills; ++fill) {
        const auto a = bytesOf(count, fill, 0), b = bytesOf(count, fill, 1),
                   c = bytesOf(count, fill, 2);
        test::forEachTarget([&] {
          std::vector<simd::ChannelSums> sums(static_cast<size_t>(runs));
          simd::sumRuns({{a.data(), b.data(), c.data()}}, begins.data(), runs, sums.data());
          for (size_t i = 0; i < sums.size(); ++i) {
            const auto total = [&](const std::vector<uint8_t>& row) {
              return std::accumulate(row.begin() + begins[i], row.begin() + begins[i + 1], 0u);
            };
            ASSERT_EQ(sums[i].sums[0], total(a)) << count << " columns, run " << i;
            ASSERT_EQ(sums[i].sums[1], total(b));
            ASSERT_EQ(sums[i].sums[2], total(c));
          }
        });
      }
    }
}

TEST(SimdMotion, RowsAreSmoothedByTheirNeighbours) {
  for (int count = 1; count <= kMostColumns; count += count < 70 ? 1 : 37)
    for (int fill = 0; fill < kFills; ++fill) {
      const auto above = bytesOf(count, fill, 0), at = bytesOf(count, fill, 1),
                 below = bytesOf(count, fill, 2);
      const auto expected = [&](int x) {
        const auto mean = [](int a, int b, int c) { return (a + 2 * b + c + 2) / 4; };
        const auto across = [&](const std::vector<uint8_t>& row) {
          return mean(row[static_cast<size_t>(std::max(x - 1, 0))], row[static_cast<size_t>(x)],
                      row[static_cast<size_t>(std::min(x + 1, count - 1))]);
        };
        return mean(across(above), across(at), across(below));
      };
      test::forEachTarget([&] {
        std::vector<uint8_t> to(static_cast<size_t>(count) + 1, 0xA5);
        simd::smoothRow({above.data(), at.data(), below.data()}, count, to.data());
        for (int x = 0; x < count; ++x)
          ASSERT_EQ(to[static_cast<size_t>(x)], expected(x)) << x << " of " << count;
        ASSERT_EQ(to.back(), 0xA5);
      });
    }
}

TEST(SimdMotion, RowsAreWarpedBetweenFourPixels) {
  for (int count = 1; count <= kMostColumns; count += count < 70 ? 1 : 37)
    for (int fill = 0; fill < kFills; ++fill)
      for (const auto& weights : {std::pair{0, 0}, {15, 1}, {8, 8}, {3, 15}, {0, 9}}) {
        const int right = weights.first, low = weights.second;
        const auto upper = bytesOf(count + 1, fill, 0), lower = bytesOf(count + 1, fill, 1);
        test::forEachTarget([&] {
          std::vector<uint8_t> to(static_cast<size_t>(count) + 1, 0xA5);
          simd::warpRow({upper.data(), lower.data(), right, low}, count, to.data());
          for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
            const int top = upper[i] * (16 - right) + upper[i + 1] * right;
            const int bottom = lower[i] * (16 - right) + lower[i + 1] * right;
            ASSERT_EQ(to[i], roundShift(top * (16 - low) + bottom * low, 8))
                << i << " of " << count;
          }
          ASSERT_EQ(to.back(), 0xA5);
        });
      }
}

TEST(SimdMotion, DifferencesAreSummedWithAndWithoutTheShift) {
  for (int count = 0; count <= kMostColumns; ++count)
    for (int fill = 0; fill < kFills; ++fill) {
      const auto now = bytesOf(count, fill, 0), still = bytesOf(count, fill, 1),
                 moved = bytesOf(count, (fill + 1) % kFills, 2);
      const auto most = static_cast<uint8_t>(255 - 40 * (count % 7));
      simd::DifferenceSums expected;
      for (size_t i = 0; i < now.size(); ++i) {
        expected.still += static_cast<uint32_t>(std::min<int>(absDiff(now[i], still[i]), most));
        expected.moved += static_cast<uint32_t>(std::min<int>(absDiff(now[i], moved[i]), most));
      }
      test::forEachTarget([&] {
        const auto sums =
            simd::sumDifferences({now.data(), still.data(), moved.data()}, count, most);
        ASSERT_EQ(sums.still, expected.still) << count;
        ASSERT_EQ(sums.moved, expected.moved) << count;
      });
    }
}

TEST(SimdMotion, LabelsAreRaisedAndFound) {
  for (int count = 0; count <= 130; ++count)
    test::forEachTarget([&] {
      std::vector<uint16_t> values(static_cast<size_t>(count) + 1, 0);
      values.back() = 7;
      EXPECT_FALSE(simd::isAnySet(values.data(), count));
      for (int i = 0; i < count; i += 5) values[static_cast<size_t>(i)] = 40000;
      EXPECT_EQ(simd::isAnySet(values.data(), count), count > 0);
      simd::raiseRow(values.data(), count, 300);
      for (int i = 0; i < count; ++i)
        ASSERT_EQ(values[static_cast<size_t>(i)], i % 5 == 0 ? 40000 : 300);
      EXPECT_EQ(values.back(), 7);
    });
}

}  // namespace
}  // namespace rg
