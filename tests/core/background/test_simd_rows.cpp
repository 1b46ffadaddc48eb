// SPDX-License-Identifier: LGPL-2.1-or-later
// The row functions of core/simd against their plain references: every target of this machine, odd
// widths, padded strides, guard bytes, fills that provoke overflows.
#include "core/background/models/consensus_background.hpp"
#include "core/base/memory/image.hpp"
#include "core/simd/background/consensus_rows.hpp"
#include "core/simd/background/difference_rows.hpp"
#include "core/simd/background/majority_rows.hpp"
#include "core/simd/background/still_rows.hpp"
#include "tests/core/row_fills.hpp"

#include <random>

namespace rg {
namespace {

using test::expectGuarded;
using test::expectSame;
using test::Fill;
using test::filled;
using test::fills;
using test::forAll;
using test::kGuard;
using test::kMostColumns;
using test::padded;

constexpr int kSamples = 16;

TEST(SimdRows, CountsAndTheirSumsAreThePlainOnes) {
  test::forEachTarget([] {
    std::mt19937_64 random(5);
    for (const size_t words : {8u, 16u, 40u})
      for (int radius = 1; radius <= 7; ++radius) {
        const auto side = static_cast<size_t>(2 * radius + 1);
        std::vector<std::vector<uint64_t>> expected, counts;
        std::vector<const uint64_t*> rows;
        for (size_t y = 0; y < side; ++y) {
          std::vector<uint64_t> row(words + 2);
          for (uint64_t& word : row) word = y % 3 == 0 ? ~uint64_t{0} : random() | random();
          counts.emplace_back(background::kCountDigits * words + 1, kGuard);
          expected.emplace_back(background::kCountDigits * words + 1, kGuard);
          background::plain::countAlongRow(row.data() + 1, words, radius, expected.back().data());
          background::simd::countAlongRow(row.data() + 1, words, radius, counts.back().data());
          ASSERT_EQ(counts.back(), expected.back()) << "radius " << radius;
        }
        for (const std::vector<uint64_t>& row : counts) rows.push_back(row.data());
        const auto area = static_cast<int>(side * side);
        for (const int limit : {0, area / 2, area * 4 / 5, area - 1, area}) {
          std::vector<uint64_t> wanted(words + 1, kGuard), out(words + 1, kGuard);
          background::plain::compareSums(rows, words, limit, wanted.data());
          background::simd::compareSums(rows, words, limit, out.data());
          ASSERT_EQ(out, wanted) << "limit " << limit;
        }
      }
  });
}

TEST(SimdRows, SmoothingIsThePlainOne) {
  forAll([](const Fill& fill, int width) {
    const Image<uint8_t> rows = filled(3, fill);
    Image<uint8_t> expected = filled(1, [](int, int) { return kGuard; });
    Image<uint8_t> out = filled(1, [](int, int) { return kGuard; });
    const background::RowsAround in{rows.row(0), rows.row(1), rows.row(2), width};
    background::plain::smoothRow(in, expected.row(0));
    background::simd::smoothRow(in, out.row(0));
    expectSame(out, expected, width);
    expectGuarded(out, expected, width);
  });
}

/// Pixels of two pictures in memory of the very length, so that the sanitizer sees a step too far.
struct TwoRows {
  TwoRows(const Fill& fill, int count, int channels) : pair{{}, {}, channels, count} {
    for (size_t c = 0; c < 3; ++c)
      for (int x = 0; x < count; ++x) {
        a[c].push_back(fill(x, static_cast<int>(c)));
        b[c].push_back(static_cast<uint8_t>(a[c].back() ^ (x % 11)));
      }
    for (size_t c = 0; c < 3; ++c) {
      pair.a[c] = a[c].data();
      pair.b[c] = b[c].data();
    }
  }

  std::array<std::vector<uint8_t>, 3> a, b;
  background::RowPair pair;
};

TEST(SimdRows, DistancesAndWhatIsFarAreThePlainOnes) {
  forAll([](const Fill& fill, int width) {
    const TwoRows rows(fill, width, width % 2 == 0 ? 1 : 3);
    const auto limit = static_cast<uint8_t>(width % 13 == 0 ? 255 : width % 13);
    std::vector<uint8_t> expected(static_cast<size_t>(width)), out = expected, where = expected;
    background::plain::measureDistances(rows.pair, expected.data());
    background::simd::measureDistances(rows.pair, out.data());
    ASSERT_EQ(out, expected);
    background::plain::markFar(rows.pair, limit, expected.data());
    background::simd::markFar(rows.pair, limit, out.data());
    ASSERT_EQ(out, expected);
    for (size_t x = 0; x < where.size(); ++x) {
      where[x] = static_cast<uint8_t>(x % 3 == 0 ? 0 : 255);
      expected[x] = out[x] = static_cast<uint8_t>(x % 5 == 0 ? 255 : 0);
    }
    background::plain::addFar(rows.pair, limit, where.data(), expected.data());
    background::simd::addFar(rows.pair, limit, where.data(), out.data());
    ASSERT_EQ(out, expected);
  });
}

TEST(SimdRows, DensePlacesAreThePlainOnes) {
  forAll([](const Fill& fill, int width) {
    std::array<std::vector<uint8_t>, 3> rows;
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < width + 2; ++x)
        rows[static_cast<size_t>(y)].push_back((fill(x, y) & 9) != 0 ? 255 : 0);
    const background::BinaryRows in{rows[0].data() + 1, rows[1].data() + 1, rows[2].data() + 1};
    std::vector<uint8_t> expected(static_cast<size_t>(width)), out = expected;
    background::plain::keepDense(in, width, expected.data());
    background::simd::keepDense(in, width, out.data());
    ASSERT_EQ(out, expected);
  });
}

/// A picture row, its model and everything that is computed from them.
struct Scene {
  Scene(const Fill& fill, int channels)
      : pixels(filled(3, fill)),
        samples({padded(kMostColumns) * kSamples * channels, 1}),
        noise(filled(1, [&](int x, int) { return fill(x + 1, 1); })),
        unrest(filled(1, [&](int x, int) { return fill(x, 2); })),
        row{{pixels.row(0), pixels.row(1), pixels.row(2)}, samples.row(0), channels, kSamples, 0} {
    samples.fill(kGuard);
    for (int y = 0; y < kSamples * channels; ++y) {
      for (int x = 0; x < kMostColumns; ++x) sample(x, y) = fill(x, y / 3);
      // Near samples in places that move, so that every count of them occurs.
      for (int x = y % 5; x < kMostColumns; x += 1 + y % 7)
        sample(x, y) = static_cast<uint8_t>(pixels.at(x, y % channels) ^ (y & 3));
    }
  }
  /// i: channel of a sample, all in turn.
  uint8_t& sample(int x, int i) {
    return samples.at(x / 64 * (64 * kSamples * row.channels) + 64 * i + x % 64, 0);
  }
  [[nodiscard]] background::RadiusRow radius(int least, int brightness) const {
    return {noise.row(0), unrest.row(0), static_cast<uint8_t>(least),
            static_cast<uint8_t>(brightness)};
  }
  [[nodiscard]] background::VerdictRow out() { return {raw.data(), strong.data(), faint.data()}; }

  Image<uint8_t> pixels, samples, noise, unrest;
  background::ModelRow row;
  std::array<uint64_t, 8> raw{}, strong{}, faint{};
};

/// Calls check(expected, scene) with two scenes alike, of every width.
template <class Check>
void forAllScenes(const Check& check) {
  test::forEachTarget([&] {
    for (const Fill& fill : fills())
      for (const int channels : {1, 3}) {
        Scene expected(fill, channels), scene(fill, channels);
        for (int width = 1; width <= kMostColumns && !testing::Test::HasFailure(); ++width) {
          SCOPED_TRACE(std::to_string(channels) + " channels, width " + std::to_string(width));
          expected.row.width = scene.row.width = width;
          check(expected, scene);
        }
      }
  });
}

TEST(SimdRows, VerdictsAreThePlainOnes) {
  forAllScenes([](Scene& expected, Scene& scene) {
    constexpr std::array<background::Tolerance, 4> kTolerances{
        {{8, 18}, {0, 0}, {3, 255}, {255, 255}}};
    const int width = scene.row.width;
    const auto [least, brightness] = kTolerances[static_cast<size_t>(width % 4)];
    background::plain::judgeRow(expected.row, expected.radius(least, brightness), expected.out());
    background::simd::judgeRow(scene.row, scene.radius(least, brightness), scene.out());
    ASSERT_EQ(scene.raw, expected.raw) << "least " << least;
    ASSERT_EQ(scene.strong, expected.strong) << "least " << least;
    ASSERT_EQ(scene.faint, expected.faint) << "least " << least;
  });
}

TEST(SimdRows, MeansOfFourAreThePlainOnes) {
  test::forEachTarget([] {
    for (const Fill& fill : fills())
      for (const int step : {64, 768}) {
        Image<uint8_t> wide({4 * step, 1});
        for (int x = 0; x < wide.width(); ++x) wide.at(x, 0) = fill(x, x / step);
        Image<uint8_t> expected = filled(1, [](int, int) { return kGuard; });
        Image<uint8_t> out = filled(1, [](int, int) { return kGuard; });
        background::plain::meanOfFour(wide.row(0), step, expected.row(0));
        background::simd::meanOfFour(wide.row(0), step, out.row(0));
        expectSame(out, expected, out.width());
      }
  });
}

TEST(SimdRows, NoiseIsThePlainOne) {
  std::mt19937_64 random(3);
  forAllScenes([&](Scene& expected, Scene& scene) {
    const int width = scene.row.width;
    std::array<uint64_t, 8> kept{};
    for (uint64_t& word : kept) word = random() & random();
    scene.noise.copyFrom(expected.noise);  // What lies behind the row's end may differ.
    background::plain::followNoiseRow(expected.row, {expected.noise.row(0), kept.data()});
    background::simd::followNoiseRow(scene.row, {scene.noise.row(0), kept.data()});
    expectSame(scene.noise, expected.noise, width);
    expectGuarded(scene.noise, expected.noise, padded(width));
  });
}

/// What still foreground is, word by word, from a row of a scene.
struct Stillness {
  explicit Stillness(const Scene& scene)
      : kept(filled(3, [](int x, int row) { return static_cast<uint8_t>(x * 5 + row); })),
        ages({padded(kMostColumns), 1}) {
    constexpr std::array<uint16_t, 8> kAges{0, 1, 2, 32767, 32768, 32769, 65534, 65535};
    for (int x = 0; x < ages.width(); ++x) ages.at(x, 0) = kAges[static_cast<size_t>(x % 8)];
    for (int c = 0; c < 3; ++c)  // Half of the columns keep nearly the colour that they have.
      for (int x = 0; x < kMostColumns; ++x)
        if (x / 3 % 2 == 0) kept.at(x, c) = static_cast<uint8_t>(scene.pixels.at(x, c) ^ (x & 7));
  }
  background::StillWord word(const Scene& scene, int at, uint16_t mostAge, uint64_t foreground) {
    const int x = 64 * at;
    return {{scene.pixels.row(0) + x, scene.pixels.row(1) + x, scene.pixels.row(2) + x},
            {kept.row(0) + x, kept.row(1) + x, kept.row(2) + x},
            ages.row(0) + x,
            mostAge,
            scene.row.channels,
            foreground};
  }

  Image<uint8_t> kept;
  Image<uint16_t> ages;
};

TEST(SimdRows, StillPixelsAreThePlainOnes) {
  test::forEachTarget([] {
    std::mt19937_64 random(7);
    for (const Fill& fill : fills())
      for (const int channels : {1, 3}) {
        const Scene scene(fill, channels);
        Stillness expected(scene), out(scene);
        for (int frame = 0; frame < 4; ++frame)
          for (int at = 0; at < kMostColumns / 64; ++at) {
            const uint64_t foreground = random() | random();
            const uint16_t mostAge = frame % 2 == 0 ? 32768 : UINT16_MAX;
            background::RadiusRow radius = scene.radius(frame * 40, 30 * frame);
            radius.noise += 64 * at;
            radius.unrest += 64 * at;
            background::plain::followStillWord(expected.word(scene, at, mostAge, foreground),
                                               radius);
            background::simd::followStillWord(out.word(scene, at, mostAge, foreground), radius);
          }
        for (int at = 0; at < kMostColumns / 64; ++at)
          for (const uint16_t least : std::array<uint16_t, 5>{0, 1, 2, 32768, 65535})
            EXPECT_EQ(background::simd::agedColumns(out.ages.row(0) + 64 * at, least),
                      background::plain::agedColumns(out.ages.row(0) + 64 * at, least));
        for (int x = 0; x < out.ages.width(); ++x)
          ASSERT_EQ(out.ages.at(x, 0), expected.ages.at(x, 0)) << "column " << x;
        for (int c = 0; c < 3; ++c)
          for (int x = 0; x < out.kept.width(); ++x)
            ASSERT_EQ(int{out.kept.at(x, c)}, int{expected.kept.at(x, c)}) << "column " << x;
      }
  });
}

}  // namespace
}  // namespace rg
