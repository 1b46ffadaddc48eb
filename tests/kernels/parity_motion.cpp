// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/literal_search.hpp"
#include "core/motion/shift_search.hpp"
#include "kernels/literal_search.hpp"
#include "kernels/motion_estimate.hpp"
#include "kernels/shift_search.hpp"
#include "tests/kernels/matched_regions.hpp"
#include "tests/kernels/parity.hpp"

#include <array>
#include <span>
#include <tuple>
#include <vector>

namespace rg::test {
namespace {

using motion::FoundShift;
using motion::MatchedPart;
using motion::ShiftRange;

template <class Check>
void forPadded(const Check& check) {
  forSizesAndFills([&](Size size, int fill) {
    const Image<uint8_t> luma = filled(size, fill);
    for (const int reach : {1, 6}) {
      motion::PaddedLuma padded;
      padded.build(luma, reach, oneThread());
      check(luma, padded);
    }
  });
}

void expectSame(const FoundShift& found, const FoundShift& expected) {
  ASSERT_EQ(found.d, expected.d);
  ASSERT_EQ(found.sums, expected.sums);
  ASSERT_EQ(found.rival, expected.rival);
  ASSERT_EQ(found.mean, expected.mean);
  ASSERT_EQ(found.isBeaten, expected.isBeaten);
}

/// Moves just outside of a range of up to 3 px: along x, y and both.
constexpr std::array kOutside{Point{-4, 1}, Point{4, -2}, Point{1, -4},
                              Point{-3, 4}, Point{4, 4},  Point{-4, -4}};

/// Returns of how many regions a shift that is not allowed is the best.
int checkSearch(const MovedPicture& moved, const ShiftRange& range) {
  const Size size = moved.now.size();
  const Image<uint8_t>&before = moved.before, &now = moved.now;
  motion::SearchedPicture searched;
  searched.build(before, range.reach + 1, oneThread());
  Plane<uint8_t> luma(now.view());
  DeviceLuma previous(searched.luma, size);
  Plane<uint16_t> sums(searched.luma.rows().size);
  gpu::motion::padLuma(Plane<uint8_t>(before.view()), previous.view, nullptr);
  gpu::motion::sumBoxes(previous.view, {sums}, nullptr);

  const Regions regions(size);
  constexpr int kTogether = 2;  // More than one turn.
  const auto room = static_cast<size_t>(kTogether * gpu::motion::shiftsOf(range));
  std::vector<uint32_t> scratch(2 * room, 0xA5A5A5A5);
  std::vector<FoundShift> found(static_cast<size_t>(regions.count()));
  const std::vector<uint8_t> still = regions.unchanged(now, before);
  gpu::motion::searchShifts(
      {regions.parts.data(), regions.starts.data(), regions.count(), still.data()},
      {luma, previous.view, {sums}}, range, {scratch.data(), scratch.data() + room, kTogether},
      found.data(), nullptr);
  motion::SearchScratch coreScratch;
  int beaten = 0;
  for (int i = 0; i < regions.count(); ++i) {
    const auto at = static_cast<size_t>(i);
    const ShiftRange& own = still[at] != 0 ? motion::kStillRange : range;
    const FoundShift expected =
        motion::searchShifts(regions.of(i), now, searched, own, coreScratch);
    expectSame(found[at], expected);
    beaten += expected.isBeaten;
  }
  return beaten;
}

/// The same, of pictures of several sizes.
int searchIn(Point by, const ShiftRange& range) {
  int beaten = 0;
  for (const Size size : {Size{4, 1}, Size{13, 9}, Size{47, 40}, Size{64, 33}})
    for (int fill = 0; fill < kFills && !::testing::Test::HasFailure(); ++fill) {
      SCOPED_TRACE(::testing::Message() << size.width << ", fill " << fill);
      beaten += checkSearch(MovedPicture(size, fill, by), range);
    }
  return beaten;
}

}  // namespace

void parity_padLuma() {
  forPadded([](const Image<uint8_t>& luma, const motion::PaddedLuma& padded) {
    DeviceLuma there(padded, luma.size());
    gpu::motion::padLuma(Plane<uint8_t>(luma.view()), there.view, nullptr);
    there.rows.expect(padded.rows(), "padded");
  });
}

void parity_padSmooth() {
  forPadded([](const Image<uint8_t>& luma, const motion::PaddedLuma& padded) {
    motion::PaddedLuma smooth;
    smooth.buildSmooth(luma, padded.reach(), oneThread());
    DeviceLuma there(smooth, luma.size());
    gpu::motion::padSmooth(Plane<uint8_t>(luma.view()), there.view, nullptr);
    there.rows.expect(smooth.rows(), "smoothed");
  });
}

void parity_sumBoxes() {
  forPadded([](const Image<uint8_t>& luma, const motion::PaddedLuma& padded) {
    motion::BoxSums boxes;
    boxes.build(padded, oneThread());
    DeviceLuma there(padded, luma.size());
    Plane<uint16_t> out(padded.rows().size);
    gpu::motion::padLuma(Plane<uint8_t>(luma.view()), there.view, nullptr);
    gpu::motion::sumBoxes(there.view, {out}, nullptr);
    const int reach = padded.reach();
    const ImageView<const uint16_t> expected{boxes.along(-reach, -reach), padded.rows().size,
                                             boxes.stride() * 2};
    out.expect(expected, "boxes");
  });
}

void parity_searchShifts() {
  for (const ShiftRange& range : {ShiftRange{2, 3}, ShiftRange{8, 9}, ShiftRange{20, 21}})
    searchIn({-2, -1}, range);
  for (const Point by : kOutside) EXPECT_GT(searchIn(by, {3, 4}), 0) << by.x << ", " << by.y;
}

void parity_findStill() {
  int stills = 0;
  forMoved([&](const MovedPicture& moved, const Regions& regions) {
    std::vector<uint8_t> still(static_cast<size_t>(regions.count()), 7);
    gpu::motion::findStill(regions.view(), Plane<uint8_t>(moved.now.view()),
                           Plane<uint8_t>(moved.before.view()), still.data(), nullptr);
    ASSERT_EQ(still, regions.unchanged(moved.now, moved.before));
    for (const uint8_t is : still) stills += is;
  });
  EXPECT_GT(stills, 0);
}

void parity_sumGradients() {
  forMoved([](const MovedPicture& moved, const Regions& regions) {
    std::vector<motion::GradientProducts> sums(static_cast<size_t>(regions.count()));
    gpu::motion::sumGradients(regions.view(), Plane<uint8_t>(moved.now.view()), sums.data(),
                              nullptr);
    for (int i = 0; i < regions.count(); ++i)
      ASSERT_EQ(sums[static_cast<size_t>(i)], motion::sumGradients(regions.of(i), moved.now)) << i;
  });
}

void parity_estimateMotion() {
  forMoved([](const MovedPicture& moved, Regions regions) {
    regions.starts.push_back(regions.starts.back());  // One without parts.
    const auto count = static_cast<size_t>(regions.count());
    std::vector<FoundShift> found(count);
    std::vector<motion::GradientProducts> gradients(count);
    std::vector<motion::RegionMotion> estimates(count, {7, 7, 7, 7});
    for (size_t i = 0; i < count; ++i) {
      const auto draw = [&](uint32_t what) {
        return hashOf(static_cast<int>(i), moved.now.width(), what);
      };
      found[i].d = {static_cast<int>(draw(1) % 41) - 20, static_cast<int>(draw(2) % 3) - 1};
      for (uint32_t k = 0; k < 9; ++k) found[i].sums[k] = (k == 4 ? 100 : 300) + draw(k) % 4000;
      found[i].rival = i % 4 == 0 ? UINT32_MAX : 200 + draw(11) % 5000;
      found[i].mean = draw(12) % 90000;
      found[i].isBeaten = i % 5 == 4;
      gradients[i] = motion::sumGradients(regions.of(static_cast<int>(i)), moved.now);
    }
    gpu::motion::estimateMotion(regions.view(), found.data(), gradients.data(), estimates.data(),
                                nullptr);
    for (size_t i = 0; i < count; ++i) {
      uint64_t pixels = 0;
      for (const MatchedPart& part : regions.of(static_cast<int>(i))) pixels += part.pixels();
      const motion::GradientProducts& g = gradients[i];
      const motion::RegionMotion expected =
          pixels == 0 ? motion::RegionMotion{}
                      : motion::estimateMotion(found[i], {g.xx, g.xy, g.yy, pixels});
      ASSERT_EQ(
          std::tuple(estimates[i].dx, estimates[i].dy, estimates[i].sad, estimates[i].reliability),
          std::tuple(expected.dx, expected.dy, expected.sad, expected.reliability))
          << i;
    }
  });
}

namespace {

/// Regions of a picture as runs: stripes, single pixels, a region of most of the picture.
struct RunsOfRegions {
  std::vector<Run> list;
  std::vector<uint32_t> starts{0};

  explicit RunsOfRegions(Size size) {
    for (int region = 0; region < 4; ++region) {
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width;) {
          const int begin = x;
          while (x < size.width && regionOf(x, y) == region) ++x;
          if (x > begin) list.push_back(runOf(y, begin, x));
          while (x < size.width && regionOf(x, y) != region) ++x;
        }
      if (list.size() > starts.back()) starts.push_back(static_cast<uint32_t>(list.size()));
    }
  }
  static int regionOf(int x, int y) {
    if (hashOf(x, y, 5) % 50 == 0) return 3;
    return y % 9 == 4 && hashOf(x / 7, y, 6) % 2 == 0 ? static_cast<int>(hashOf(0, y, 7) % 2) + 1
                                                      : 0;
  }
  [[nodiscard]] std::span<const Run> of(size_t region) const {
    return {list.data() + starts[region], starts[region + 1] - starts[region]};
  }
  [[nodiscard]] size_t count() const { return starts.size() - 1; }
};

/// Calls check(moved, padded, runs, list).
template <class Check>
void forLiteral(Point by, int reach, const Check& check) {
  const auto checkMoved = [&](const MovedPicture& moved, const Regions&) {
    motion::PaddedLuma padded;
    padded.build(moved.before, reach, oneThread());
    const RunsOfRegions runs(moved.now.size());
    gpu::motion::LiteralList list;
    list.build(runs.list, runs.starts);
    check(moved, padded, runs, list);
  };
  forMoved(checkMoved, by);
}

}  // namespace

void parity_sumAllShifts() {
  constexpr int kReach = 3, kShifts = 49;
  forLiteral(
      {-2, -1}, kReach,
      [](const MovedPicture& moved, const motion::PaddedLuma& padded, const RunsOfRegions& runs,
         const gpu::motion::LiteralList& list) {
        const gpu::motion::LiteralRegions regions{runs.list.data(), list.chunks.data(), list};
        Plane<uint8_t> rows(padded.rows());
        // All but the first region.
        const auto count = static_cast<int>(runs.count()) - 1;
        if (count == 0) return;
        Guarded<unsigned long long> sums(
            std::vector<unsigned long long>(static_cast<size_t>(count * kShifts), 7), 0xA5A5);
        gpu::motion::sumAllShifts(regions, {1, count}, Plane<uint8_t>(moved.now.view()),
                                  {moved.now.size(), padded.reach(), rows}, kReach, sums.data(),
                                  nullptr);
        std::vector<unsigned long long> expected;
        std::vector<uint64_t> of;
        for (size_t region = 1; region < runs.count(); ++region) {
          motion::sumAllShifts(runs.of(region), moved.now, padded, kReach, of);
          expected.insert(expected.end(), of.begin(), of.end());
        }
        sums.expect(expected, [](auto a, auto b) { return a == b; });
      });
}

void parity_matchAllPixels() {
  constexpr ShiftRange kRange{3, 4};
  int moving = 0;
  const auto check = [&](const MovedPicture& moved, const motion::PaddedLuma& padded,
                         const RunsOfRegions& runs, const gpu::motion::LiteralList& list) {
    const gpu::motion::LiteralRegions regions{runs.list.data(), list.chunks.data(), list};
    Plane<uint8_t> rows(padded.rows());
    constexpr int kAtOnce = 2;
    std::vector<unsigned long long> sums(
        static_cast<size_t>(kAtOnce * gpu::motion::shiftsOf(kRange)), 7);
    std::vector<motion::GradientSums> gradients(runs.count(), {7, 7, 7, 7});
    std::vector<motion::RegionMotion> found(runs.count(), {7, 7, 7, 7});
    gpu::motion::matchAllPixels(regions, Plane<uint8_t>(moved.now.view()),
                                {moved.now.size(), padded.reach(), rows}, kRange,
                                {sums.data(), kAtOnce, gradients.data()}, found.data(), nullptr);
    motion::LiteralScratch scratch;
    for (size_t region = 0; region < runs.count(); ++region) {
      const motion::RegionMotion expected =
          motion::matchAllPixels(runs.of(region), moved.now, padded, kRange, scratch);
      const motion::RegionMotion& is = found[region];
      ASSERT_EQ(std::tuple(is.dx, is.dy, is.sad, is.reliability),
                std::tuple(expected.dx, expected.dy, expected.sad, expected.reliability))
          << region;
      moving += expected.dx != 0 && expected.reliability > 0;
    }
  };
  forLiteral({-2, -1}, 5, check);
  EXPECT_GT(moving, 0);
  for (const Point by : kOutside) forLiteral(by, 5, check);
}

}  // namespace rg::test
