// SPDX-License-Identifier: LGPL-2.1-or-later
// The row functions of core/simd against their plain references: every target of this machine, odd
// widths, padded strides, guard bytes, fills that provoke overflows.
#include "core/consensus_background.hpp"
#include "core/image.hpp"
#include "core/pixel.hpp"
#include "core/simd/bit_rows.hpp"
#include "core/simd/consensus_rows.hpp"
#include "core/simd/difference_rows.hpp"
#include "core/simd/majority_rows.hpp"
#include "core/simd/picture_rows.hpp"
#include "core/simd/still_rows.hpp"
#include "tests/core/simd_targets.hpp"

#include <functional>
#include <random>

namespace rg {
namespace {

constexpr uint8_t kGuard = 0xA5;
constexpr int kMostColumns = 257;
constexpr int kSamples = 16;

using Fill = std::function<uint8_t(int x, int row)>;

/// What goes wrong in bytes goes wrong at the ends of their range and at steps between these.
std::vector<Fill> fills() {
  const auto noise = [](uint32_t mask) {
    return [mask](int x, int row) {
      return static_cast<uint8_t>(
          mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(row), mask) & mask);
    };
  };
  return {[](int, int) { return uint8_t{0}; },
          [](int, int) { return uint8_t{255}; },
          [](int x, int row) { return static_cast<uint8_t>((x + row) % 2 == 0 ? 0 : 255); },
          [](int x, int row) { return static_cast<uint8_t>(x % 3 == 0 ? 254 : row % 2); },
          [](int x, int row) { return static_cast<uint8_t>(120 + (x * 7 + row * 5) % 24); },
          noise(255),
          noise(15)};
}

/// Rows of bytes with guards behind what the functions may touch: whole words of columns.
Image<uint8_t> filled(int rows, const Fill& fill) {
  Image<uint8_t> image({kMostColumns + 100, rows});
  image.fill(kGuard);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < kMostColumns; ++x) image.at(x, y) = fill(x, y);
  return image;
}

int padded(int width) {
  return (width + 63) / 64 * 64;
}

void expectSame(const Image<uint8_t>& a, const Image<uint8_t>& b, int width) {
  for (int x = 0; x < width; ++x) ASSERT_EQ(int{a.at(x, 0)}, int{b.at(x, 0)}) << "column " << x;
}

void expectGuarded(const Image<uint8_t>& a, const Image<uint8_t>& before, int from) {
  for (int x = from; x < a.width(); ++x) ASSERT_EQ(int{a.at(x, 0)}, int{before.at(x, 0)}) << x;
}

template <class Check>
void forAll(const Check& check) {
  test::forEachTarget([&] {
    int index = 0;
    for (const Fill& fill : fills()) {
      SCOPED_TRACE("fill " + std::to_string(index++));
      for (int width = 1; width <= kMostColumns && !testing::Test::HasFailure(); ++width) {
        SCOPED_TRACE("width " + std::to_string(width));
        check(fill, width);
      }
    }
  });
}

TEST(SimdRows, PackingIsThePlainOne) {
  forAll([](const Fill& fill, int width) {
    const Image<uint8_t> bytes = filled(1, fill);
    constexpr uint64_t kUntouched = 0xA5A5A5A5A5A5A5A5;
    for (const int value : {0, 1, 254, 255}) {
      std::vector<uint64_t> expected(8, kUntouched), words(8, kUntouched);
      plain::packEqualRow(bytes.row(0), width, static_cast<uint8_t>(value), expected.data());
      simd::packEqualRow(bytes.row(0), width, static_cast<uint8_t>(value), words.data());
      ASSERT_EQ(words, expected) << "value " << value;
      ASSERT_EQ(words.at(static_cast<size_t>(padded(width) / 64)), kUntouched);
    }
  });
}

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
          counts.emplace_back(kCountDigits * words + 1, kGuard);
          expected.emplace_back(kCountDigits * words + 1, kGuard);
          plain::countAlongRow(row.data() + 1, words, radius, expected.back().data());
          simd::countAlongRow(row.data() + 1, words, radius, counts.back().data());
          ASSERT_EQ(counts.back(), expected.back()) << "radius " << radius;
        }
        for (const std::vector<uint64_t>& row : counts) rows.push_back(row.data());
        const auto area = static_cast<int>(side * side);
        for (const int limit : {0, area / 2, area * 4 / 5, area - 1, area}) {
          std::vector<uint64_t> wanted(words + 1, kGuard), out(words + 1, kGuard);
          plain::compareSums(rows, words, limit, wanted.data());
          simd::compareSums(rows, words, limit, out.data());
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
    const RowsAround in{rows.row(0), rows.row(1), rows.row(2), width};
    plain::smoothRow(in, expected.row(0));
    simd::smoothRow(in, out.row(0));
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
  RowPair pair;
};

TEST(SimdRows, DistancesAndWhatIsFarAreThePlainOnes) {
  forAll([](const Fill& fill, int width) {
    const TwoRows rows(fill, width, width % 2 == 0 ? 1 : 3);
    const auto limit = static_cast<uint8_t>(width % 13 == 0 ? 255 : width % 13);
    std::vector<uint8_t> expected(static_cast<size_t>(width)), out = expected, where = expected;
    plain::measureDistances(rows.pair, expected.data());
    simd::measureDistances(rows.pair, out.data());
    ASSERT_EQ(out, expected);
    plain::markFar(rows.pair, limit, expected.data());
    simd::markFar(rows.pair, limit, out.data());
    ASSERT_EQ(out, expected);
    for (size_t x = 0; x < where.size(); ++x) {
      where[x] = static_cast<uint8_t>(x % 3 == 0 ? 0 : 255);
      expected[x] = out[x] = static_cast<uint8_t>(x % 5 == 0 ? 255 : 0);
    }
    plain::addFar(rows.pair, limit, where.data(), expected.data());
    simd::addFar(rows.pair, limit, where.data(), out.data());
    ASSERT_EQ(out, expected);
  });
}

TEST(SimdRows, DensePlacesAreThePlainOnes) {
  forAll([](const Fill& fill, int width) {
    std::array<std::vector<uint8_t>, 3> rows;
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < width + 2; ++x)
        rows[static_cast<size_t>(y)].push_back((fill(x, y) & 9) != 0 ? 255 : 0);
    const BinaryRows in{rows[0].data() + 1, rows[1].data() + 1, rows[2].data() + 1};
    std::vector<uint8_t> expected(static_cast<size_t>(width)), out = expected;
    plain::keepDense(in, width, expected.data());
    simd::keepDense(in, width, out.data());
    ASSERT_EQ(out, expected);
  });
}

/// Four rows of a picture with guards behind them.
struct Planes {
  std::array<Image<uint8_t>, 4> rows;
  Planes() {
    for (Image<uint8_t>& row : rows) row = filled(1, [](int, int) { return kGuard; });
  }
  [[nodiscard]] ColourRows to() {
    return {rows[0].row(0), rows[1].row(0), rows[2].row(0), rows[3].row(0)};
  }
};

void expectSamePlanes(const Planes& a, const Planes& b, int width) {
  for (size_t i = 0; i < a.rows.size(); ++i) {
    expectSame(a.rows[i], b.rows[i], width);
    expectGuarded(a.rows[i], b.rows[i], width);
  }
}

TEST(SimdRows, PackedPixelsAreLoadedAsByThePlainOne) {
  constexpr std::array<PackedOrder, 4> kOrders{
      {{0, 1, 2, 3}, {2, 1, 0, 3}, {0, 1, 2, 4}, {2, 1, 0, 4}}};
  forAll([&](const Fill& fill, int width) {
    const PackedOrder& order = kOrders[static_cast<size_t>(width % 4)];
    std::vector<uint8_t> pixels;  // Of the very length, so that the sanitizer sees a step too far.
    for (int i = 0; i < width * order.bytesPerPixel; ++i) pixels.push_back(fill(i, 0));
    Planes expected, out;
    plain::loadPackedRow(pixels.data(), width, order, expected.to());
    simd::loadPackedRow(pixels.data(), width, order, out.to());
    expectSamePlanes(out, expected, width);
  });
}

TEST(SimdRows, YuvIsLoadedAsByThePlainOne) {
  constexpr std::array<YuvToRgb, 3> kMatrices{{{16, 19077, 26149, 6419, 13320, 33050},
                                               {0, 16384, 25802, 3069, 7670, 30402},
                                               {16, 19077, 32767, 3172, 11127, 35083}}};
  forAll([&](const Fill& fill, int width) {
    const YuvToRgb& k = kMatrices[static_cast<size_t>(width % 3)];
    const int step = 1 + width % 2;
    std::vector<uint8_t> luma, chroma;
    for (int i = 0; i < width; ++i) luma.push_back(fill(i, 0));
    for (int i = 0; i < (width + 1) / 2 * 2; ++i) chroma.push_back(fill(i, 1));
    const uint8_t* cr = chroma.data() + (step == 2 ? 1 : (width + 1) / 2);
    const YuvRows from{luma.data(), chroma.data(), cr, step};
    Planes expected, out;
    plain::loadYuvRow(from, width, k, expected.to());
    simd::loadYuvRow(from, width, k, out.to());
    expectSamePlanes(out, expected, width);
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
  [[nodiscard]] RadiusRow radius(int least, int brightness) const {
    return {noise.row(0), unrest.row(0), static_cast<uint8_t>(least),
            static_cast<uint8_t>(brightness)};
  }
  [[nodiscard]] VerdictRow out() { return {raw.data(), strong.data(), faint.data()}; }

  Image<uint8_t> pixels, samples, noise, unrest;
  ModelRow row;
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
    constexpr std::array<Tolerance, 4> kTolerances{{{8, 18}, {0, 0}, {3, 255}, {255, 255}}};
    const int width = scene.row.width;
    const auto [least, brightness] = kTolerances[static_cast<size_t>(width % 4)];
    plain::judgeRow(expected.row, expected.radius(least, brightness), expected.out());
    simd::judgeRow(scene.row, scene.radius(least, brightness), scene.out());
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
        plain::meanOfFour(wide.row(0), step, expected.row(0));
        simd::meanOfFour(wide.row(0), step, out.row(0));
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
    plain::followNoiseRow(expected.row, {expected.noise.row(0), kept.data()});
    simd::followNoiseRow(scene.row, {scene.noise.row(0), kept.data()});
    expectSame(scene.noise, expected.noise, width);
    expectGuarded(scene.noise, expected.noise, padded(width));
  });
}

/// What still foreground is, word by word, from a row of a scene.
struct Stillness {
  explicit Stillness(const Scene& scene)
      : kept(filled(3, [](int x, int row) { return static_cast<uint8_t>(x * 5 + row); })),
        ages({padded(kMostColumns), 1}) {
    constexpr std::array<uint16_t, 8> kAges{0, 1, 2, 3, 5, 300, 65534, 65535};
    for (int x = 0; x < ages.width(); ++x) ages.at(x, 0) = kAges[static_cast<size_t>(x % 8)];
    for (int c = 0; c < 3; ++c)  // Half of the columns keep nearly the colour that they have.
      for (int x = 0; x < kMostColumns; ++x)
        if (x / 3 % 2 == 0) kept.at(x, c) = static_cast<uint8_t>(scene.pixels.at(x, c) ^ (x & 7));
  }
  StillWord word(const Scene& scene, int at, uint64_t foreground) {
    const int x = 64 * at;
    return {{scene.pixels.row(0) + x, scene.pixels.row(1) + x, scene.pixels.row(2) + x},
            {kept.row(0) + x, kept.row(1) + x, kept.row(2) + x},
            ages.row(0) + x,
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
            RadiusRow radius = scene.radius(frame * 40, 30 * frame);
            radius.noise += 64 * at;
            radius.unrest += 64 * at;
            plain::followStillWord(expected.word(scene, at, foreground), radius);
            simd::followStillWord(out.word(scene, at, foreground), radius);
          }
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
