// SPDX-License-Identifier: LGPL-2.1-or-later
// The SIMD functions of stages 2 and 4 against plain ones, and the stages as a whole: every target
// of this machine, one to four threads, odd sizes, guard bytes, fills that provoke overflows.
#include "core/base/pixel.hpp"
#include "core/base/row_spans.hpp"
#include "core/objects/objects.hpp"
#include "core/simd/segmentation/cell_rows.hpp"
#include "core/simd/segmentation/link_rows.hpp"
#include "tests/core/fills.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <algorithm>

namespace rg {
namespace {

using namespace scenes;
using test::filled, test::hashOf, test::kFills, test::levelAt;

constexpr uint8_t kGuard = 0xA5;

/// Bytes of a row with guards behind them.
struct Row {
  static constexpr int kGuards = 64;
  explicit Row(int count, int fill = kFills, int y = 0)
      : bytes(static_cast<size_t>(count + kGuards), kGuard) {
    for (int x = 0; x < count; ++x)
      bytes[static_cast<size_t>(x)] = static_cast<uint8_t>(levelAt(fill, x, y));
  }
  uint8_t operator[](int x) const { return bytes[static_cast<size_t>(x)]; }
  std::vector<uint8_t> bytes;
};

constexpr int kWidths[] = {1, 2, 15, 16, 17, 63, 64, 65, 130, 257};

/// Runs write(to) on each target; expected(i) says what it writes into each of `count` bytes.
template <class Write, class Expected>
void expectWrites(int count, const Write& write, const Expected& expected) {
  Row right(count);
  for (int i = 0; i < count; ++i)
    right.bytes[static_cast<size_t>(i)] = static_cast<uint8_t>(expected(i));
  test::forEachTarget([&] {
    Row to(count);
    write(to.bytes.data());
    EXPECT_EQ(to.bytes, right.bytes) << count << " columns";
  });
}

TEST(SimdLinks, RowsAreSmoothedAndMeasuredByTheirWords) {
  for (const int count : kWidths)
    for (int fill = 0; fill < kFills; ++fill) {
      const Row a(count, fill), b(count, (fill + 2) % kFills, 3), c(count, 4, 7);
      expectWrites(
          count,
          [&](uint8_t* to) {
            segmentation::simd::smoothRow(a.bytes.data(), b.bytes.data(), c.bytes.data(), count,
                                          to);
          },
          [&](int i) { return ((a[i] + b[i] + 1) / 2 + c[i] + 1) / 2; });
      const uint8_t *p = a.bytes.data(), *q = b.bytes.data(), *r = c.bytes.data();
      expectWrites(
          count,
          [&](uint8_t* to) {
            segmentation::simd::measureRow({3, {p, q, r}, {q, r, r}}, count, 254, to);
          },
          [&](int i) { return std::min(std::max(absDiff(a[i], b[i]), absDiff(b[i], c[i])), 254); });
      expectWrites(
          count,
          [&](uint8_t* to) {
            segmentation::simd::measureRow({1, {p}, {q}}, count, 254, to);
          },
          [&](int i) { return std::min(absDiff(a[i], b[i]), 254); });
    }
}

TEST(SimdLinks, HuesAreThoseOfTheTable) {
  const segmentation::HueBand band{1400, 300};
  constexpr int kStep = 5, kCount = 256 / kStep + 1;
  std::vector<uint8_t> red, green, blue;
  for (int r = 0; r < kCount; ++r)
    for (int g = 0; g < 256; ++g) {
      red.push_back(static_cast<uint8_t>(r * kStep));
      green.push_back(static_cast<uint8_t>(g));
      blue.push_back(static_cast<uint8_t>(hashOf(r, g, 2)));
    }
  const auto count = static_cast<int>(red.size());
  test::forEachTarget([&] {
    std::vector<int16_t> hues(red.size());
    segmentation::simd::findHueRow(red.data(), green.data(), blue.data(), count, band, hues.data());
    for (size_t i = 0; i < hues.size(); ++i) {
      const int hue = segmentation::hueOf(red[i], green[i], blue[i]);
      const int mark = hue != segmentation::kAchromatic && band.contains(hue)
                           ? int{segmentation::simd::kInBand}
                           : 0;
      ASSERT_EQ(hues[i], hue == segmentation::kAchromatic ? hue : hue + mark)
          << int{red[i]} << ' ' << int{green[i]} << ' ' << int{blue[i]};
    }
  });
}

// The target without vectors is the plain version of these: the same source.
TEST(SimdLinks, ChoicesAndLinksAreThePlainOnes) {
  const auto run = [](int count, int fill) {
    const Row left(count + 1, fill), up(count, (fill + 3) % kFills, 5), down(count, 4, 2);
    Row nearest(count), links(count);
    segmentation::simd::chooseRow({left.bytes.data(), up.bytes.data(), down.bytes.data()}, count,
                                  255, nearest.bytes.data());
    segmentation::simd::linkRow(
        {left.bytes.data(), up.bytes.data(), nearest.bytes.data(), nearest.bytes.data(), 2, 255},
        count, {1, 2, 4}, links.bytes.data());
    std::vector<uint64_t> words(static_cast<size_t>(count / 64 + 2), kGuard);
    segmentation::simd::packRow(links.bytes.data(), count, 1, words.data());
    std::vector<int16_t> hues(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i)
      hues[static_cast<size_t>(i)] =
          static_cast<int16_t>(static_cast<int>(hashOf(i, fill, 1) % 3000) - 1);
    Row guarded = left;
    segmentation::simd::guardRow(hues.data(), hues.data() + 1, count - 1, {48, 254},
                                 guarded.bytes.data());
    return std::tuple(nearest.bytes, links.bytes, words, guarded.bytes);
  };
  for (const int count : kWidths)
    for (int fill = 0; fill < kFills; ++fill) {
      const auto plain = [&] {
        const test::TargetScope scope(HWY_SCALAR);
        return run(count, fill);
      }();
      test::forEachTarget(
          [&] { EXPECT_EQ(run(count, fill), plain) << count << " columns, fill " << fill; });
    }
}

/// 16-bit words with guards behind them; what `write` leaves there on each target.
template <class Write>
void expectWords(const std::vector<uint16_t>& before, const std::vector<uint16_t>& right,
                 const Write& write) {
  test::forEachTarget([&] {
    std::vector<uint16_t> to = before;
    write(to.data());
    EXPECT_EQ(to, right) << before.size() << " words";
  });
}

TEST(SimdCells, RowsAreSummedByTheirWords) {
  constexpr uint8_t kScopes[] = {kInScope, kInScopeApart, 253, 0, 128};
  for (const int count : kWidths)
    for (int fill = 0; fill < kFills; ++fill) {
      const Row from(count, fill);
      Row scope(count);
      std::vector<uint16_t> before(static_cast<size_t>(count) + 32, 60000);
      auto sums = before, scoped = before, counts = before;
      for (int i = 0; i < count; ++i) {
        const auto at = static_cast<size_t>(i);
        scope.bytes[at] = kScopes[hashOf(i, fill, 7) % 5];
        const uint8_t value = scope[i];
        sums[at] = static_cast<uint16_t>(sums[at] + from[i]);
        if (value >= kInScopeApart) scoped[at] = sums[at];
        if (value >= kInScopeApart)
          counts[at] = static_cast<uint16_t>(counts[at] + 256 + (value == kInScope));
      }
      const uint8_t *p = from.bytes.data(), *q = scope.bytes.data();
      expectWords(before, sums, [&](uint16_t* to) { segmentation::simd::addRow(p, count, to); });
      expectWords(before, scoped,
                  [&](uint16_t* to) { segmentation::simd::addScopedRow(p, q, count, to); });
      expectWords(before, counts,
                  [&](uint16_t* to) { segmentation::simd::countRow(q, count, to); });
      uint32_t sum = 0;
      for (int i = 0; i < count; ++i) sum += from[i];
      test::forEachTarget([&] { EXPECT_EQ(segmentation::simd::sumRow(p, count), sum); });
    }
}

TEST(SimdCells, RangesAreThoseOfWhatIsInScope) {
  for (const int count : kWidths)
    for (int fill = 0; fill < kFills; ++fill) {
      const Row a(2 * count, fill), b(2 * count, 4, 3);
      Row scope(2 * count);
      for (int i = 0; i < 2 * count; ++i)
        scope.bytes[static_cast<size_t>(i)] = hashOf(i, fill, 7) % 3 == 0 ? kInScope : uint8_t{0};
      const auto range = [&](int i, bool hasScope) {
        int least = 255, most = 0;
        for (const int x : {2 * i, 2 * i + 1})
          for (const Row* row : {&a, &b}) {
            if (hasScope && !isInScope(scope[x])) continue;
            least = std::min(least, int{(*row)[x]});
            most = std::max(most, int{(*row)[x]});
          }
        return std::max(most - least, 3);
      };
      for (const bool hasScope : {false, true})
        expectWrites(
            count,
            [&](uint8_t* to) {
              std::vector<uint8_t> least(static_cast<size_t>(2 * count), 255), most(least.size());
              for (const Row* row : {&a, &b})
                if (hasScope)
                  segmentation::simd::widenScopedRow(row->bytes.data(), scope.bytes.data(),
                                                     2 * count, least.data(), most.data());
                else
                  segmentation::simd::widenRow(row->bytes.data(), 2 * count, least.data(),
                                               most.data());
              segmentation::simd::widenPairs(count, least.data(), most.data());
              std::fill_n(to, count, uint8_t{3});
              segmentation::simd::raiseRanges(least.data(), most.data(), count, to);
            },
            [&](int i) { return range(i, hasScope); });
    }
}

// All sums that cells can have: up to 64 pixels of up to 255.
TEST(SimdCells, MeansAreRoundedQuotients) {
  for (int pixels = 0; pixels <= 64; ++pixels) {
    const int count = 255 * pixels + 1;
    std::vector<uint16_t> sums(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i) sums[static_cast<size_t>(i)] = static_cast<uint16_t>(i);
    const std::vector<uint8_t> counts(sums.size(), static_cast<uint8_t>(pixels));
    expectWrites(
        count,
        [&](uint8_t* to) { segmentation::simd::divideRow(sums.data(), counts.data(), count, to); },
        [&](int i) { return pixels == 0 ? 0 : (i + pixels / 2) / pixels; });
  }
}

TEST(SimdCells, PairsCountsAndEqualsAreThePlainOnes) {
  const auto run = [](int count) {
    std::vector<uint16_t> from(static_cast<size_t>(2 * count)), to(static_cast<size_t>(count) + 9);
    for (int i = 0; i < 2 * count; ++i)
      from[static_cast<size_t>(i)] = static_cast<uint16_t>(hashOf(i / 3, 2, 8) % 4 * 257);
    Row counts(count), scope(count);
    segmentation::simd::addPairs(from.data(), count, to.data());
    segmentation::simd::splitCounts(from.data(), count, counts.bytes.data(), scope.bytes.data());
    std::vector<uint64_t> words(static_cast<size_t>(count / 64 + 2), kGuard);
    segmentation::simd::packEqual(from.data() + 1, from.data(), count, words.data());
    return std::tuple(to, counts.bytes, scope.bytes, words);
  };
  for (const int count : kWidths) {
    const auto plain = [&] {
      const test::TargetScope scope(HWY_SCALAR);
      return run(count);
    }();
    EXPECT_EQ(std::get<0>(plain)[0], 2 * (hashOf(0, 2, 8) % 4 * 257));
    EXPECT_EQ(std::get<3>(plain)[0] & 1, 1u);
    test::forEachTarget([&] { EXPECT_EQ(run(count), plain) << count << " columns"; });
  }
}

TEST(SimdCells, PixelsGoToTheNearestColour) {
  for (const int side : {2, 4, 8})
    for (int fill = 0; fill < kFills; ++fill) {
      const Image<uint8_t> planes[] = {filled({16, 9}, fill), filled({16, 9}, 5),
                                       filled({16, 9}, 3)};
      segmentation::simd::CellColours cell;
      cell.side = side;
      cell.rows = side == 2 ? 1 : side;
      cell.count = 5;
      cell.margin = 6;
      for (int c = 0; c < 3; ++c) {
        cell.pixels[c] = planes[c].row(1) + 3;
        cell.strides[c] = planes[c].view().strideBytes;
        for (int k = 0; k < cell.count; ++k)
          cell.candidates[k][c] = static_cast<uint8_t>(hashOf(k, c, 4) & 255);
      }
      std::vector<int> right;
      for (int i = 0; i < cell.rows * side; ++i) {
        int best = 0, least = 256;
        for (int k = 0; k < cell.count; ++k) {
          int distance = k == 0 ? 0 : cell.margin;
          for (int c = 0; c < 3; ++c)
            distance += absDiff(planes[c].at(3 + i % side, 1 + i / side), cell.candidates[k][c]);
          distance = std::min(distance, 255);
          if (distance < least) best = k;
          least = std::min(distance, least);
        }
        right.push_back(best);
      }
      test::forEachTarget([&] {
        std::vector<uint8_t> choices(64 + 8, kGuard);
        const bool any = segmentation::simd::chooseColours(cell, choices.data());
        EXPECT_EQ(std::vector<int>(choices.begin(), choices.begin() + cell.rows * side), right);
        const bool expected = std::any_of(right.begin(), right.end(), [](int k) { return k != 0; });
        EXPECT_EQ(any, cell.rows == side ? expected : any);
        EXPECT_EQ(std::count(choices.end() - 8, choices.end(), kGuard), 8);
      });
    }
}

/// All that the four stages say of two frames, as numbers.
std::vector<int64_t> answersOf(const std::shared_ptr<const Picture>& first,
                               const std::shared_ptr<const Picture>& second, const Context& context,
                               const segmentation::Params& params) {
  const auto segmentation = segmentation::makeStage(context);
  const auto graphs = graph::makeStage(context);
  const auto motions = motion::makeStage(context);
  const auto objects = objects::makeStage(context);
  std::vector<int64_t> answers;
  int64_t ns = 0;
  for (const auto& picture : {first, second}) {
    const auto labels = *segmentation->process(picture, nullptr, params);
    const auto graph = *graphs->process(labels, {});
    const auto motion = *motions->process(graph, {9, true}, {});
    const auto result = *objects->process(motion, {}, {ns += 40'000'000, true});
    for (int y = 0; y < labels->size.height; ++y)
      for (int x = 0; x < labels->size.width; ++x)
        answers.insert(answers.end(), {labels->ids.at(x, y), result->slots.at(x, y)});
    for (const graph::Arc& arc : graph->arcs)
      answers.insert(answers.end(),
                     {arc.a.number(), arc.b.number(), arc.borderPx, int64_t{arc.contrast}});
    for (const motion::RegionMotion& m : motion->regions)
      answers.insert(answers.end(), {m.dx, m.dy, static_cast<int64_t>(m.sad), m.reliability});
    answers.insert(answers.end(), {result->cameraDx, result->cameraDy});
  }
  return answers;
}

TEST(SimdStages, EveryTargetAndNumberOfThreadsGivesTheSameAnswers) {
  const auto moved = [](Size size, int dx, int dy) {
    return paint(size, [=](int x, int y) {
      const uint32_t tile = hashOf((x - dx + 640) / 9, (y - dy + 640) / 11, 3);
      const auto level = [&](int shift) {
        return static_cast<uint8_t>((tile >> shift & 127) + (hashOf(x - dx, y - dy, 6) & 15));
      };
      return Rgb{level(0), level(7), level(14)};
    });
  };
  for (const Size size : {Size{1, 1}, Size{3, 70}, Size{131, 97}})
    for (const int minAreaPx : {0, 1, 64, 256, 1024}) {
      const segmentation::Params params{segmentation::Scope::Frame, 2, minAreaPx, 300};
      const auto first = moved(size, 0, 0), second = moved(size, 4, -3);
      const auto expected = [&] {
        const test::TargetScope scope(HWY_SCALAR);
        return answersOf(first, second, contextWith(1), params);
      }();
      test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
        EXPECT_EQ(answersOf(first, second, {executor, nullptr}, params), expected)
            << size.width << 'x' << size.height;
      });
    }
}

}  // namespace
}  // namespace rg
