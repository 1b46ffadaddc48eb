// SPDX-License-Identifier: LGPL-2.1-or-later
// searchShifts for every instruction set. The machine's SAD instructions compare four pixels at
// eight neighbouring places at once (mpsadbw; vdbpsadbw does so in four lanes). So a vector holds
// sums of shifts that follow each other along x: lanes of eight.
#include "core/motion/shift_search.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <tuple>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/motion/shift_search.cpp"
#include "core/simd/base/targets.hpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef REGIONGRAPH_SIMD_SHIFT_SEARCH_ONCE
#define REGIONGRAPH_SIMD_SHIFT_SEARCH_ONCE
namespace rg::motion::simd {

/// Shifts along x that are summed together.
constexpr int kGroup = 32;
/// Blocks whose sums fit 16 bits.
constexpr size_t kMostBlocks = 64;
static_assert(kMostBlocks * kBlockWidth * 255 <= 0xFFFF);
/// Rows of shifts whose bounds are taken together: there are so many rows beyond the last.
constexpr int kRowsAtOnce = 4;

inline void listBlocks(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                       const SearchedPicture& previous, int reach, SearchScratch& scratch) {
  scratch.blocks.clear();
  scratch.boxes.clear();
  const uint8_t* pixels = previous.luma.along(-reach, -reach);
  const uint16_t* boxes = previous.boxes.along(-reach, -reach);
  for (const MatchedPart& part : parts) {
    forBlocks(part, [&](int x, int y) {
      SearchedBlock block{previous.luma.along(x - reach, y - reach) - pixels, 0};
      std::memcpy(&block.pixels, luma.row(y) + x, kBlockWidth);
      scratch.blocks.push_back(block);
    });
    forBoxes(part, [&](int x, int y) {
      int sum = 0;
      for (int row = 0; row < kBoxSide; ++row)
        for (int i = 0; i < kBoxSide; ++i) sum += luma.row(y + row)[x + i];
      scratch.boxes.push_back(
          {previous.boxes.along(x - reach, y - reach) - boxes, static_cast<uint16_t>(sum)});
    });
  }
}

}  // namespace rg::motion::simd
#endif

HWY_BEFORE_NAMESPACE();
namespace rg::motion::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET <= HWY_AVX3
/// Four lanes: 32 shifts.
struct Lanes {
  using Vector = __m512i;
  static constexpr int kCount = 4;
  static Vector zero() { return _mm512_setzero_si512(); }
  static void store(Vector v, uint16_t* to) { _mm512_storeu_si512(to, v); }
  static Vector spread(const uint8_t* from) {
    return _mm512_permutexvar_epi64(_mm512_setr_epi64(0, 1, 1, 2, 2, 3, 3, 4),
                                    _mm512_loadu_si512(from));
  }
  static Vector repeat(uint32_t pixels) { return _mm512_set1_epi32(static_cast<int>(pixels)); }
  static Vector add(Vector a, Vector b) { return _mm512_add_epi16(a, b); }
  static Vector sad(Vector before, Vector block) {
    // Dwords of a lane that the two halves of the SADs are taken from: 0 1, 1 2.
    return _mm512_dbsad_epu8(block, before, 0 | 1 << 2 | 1 << 4 | 2 << 6);
  }
};
#elif HWY_TARGET <= HWY_AVX2
/// Two lanes.
struct Lanes {
  using Vector = __m256i;
  static constexpr int kCount = 2;
  static Vector zero() { return _mm256_setzero_si256(); }
  static void store(Vector v, uint16_t* to) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), v);
  }
  static Vector spread(const uint8_t* from) {
    return _mm256_permute4x64_epi64(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)),
                                    0 | 1 << 2 | 1 << 4 | 2 << 6);
  }
  static Vector repeat(uint32_t pixels) { return _mm256_set1_epi32(static_cast<int>(pixels)); }
  static Vector add(Vector a, Vector b) { return _mm256_add_epi16(a, b); }
  static Vector sad(Vector before, Vector block) { return _mm256_mpsadbw_epu8(before, block, 0); }
};
#elif HWY_TARGET != HWY_SCALAR
/// One lane of bytes; where there is no instruction for it, four differences are added up.
struct Lanes {
  using D8 = hn::Full128<uint8_t>;
  using D16 = hn::Full128<uint16_t>;
  using Vector = hn::Vec<D16>;
  static constexpr int kCount = 1;
  static Vector zero() { return hn::Zero(D16()); }
  static void store(Vector v, uint16_t* to) { hn::StoreU(v, D16(), to); }
  static Vector spread(const uint8_t* from) { return hn::BitCast(D16(), hn::LoadU(D8(), from)); }
  static Vector repeat(uint32_t pixels) {
    return hn::BitCast(D16(), hn::Set(hn::Full128<uint32_t>(), pixels));
  }
  static Vector add(Vector a, Vector b) { return hn::Add(a, b); }
#if HWY_TARGET == HWY_SSE4
  static Vector sad(Vector before, Vector block) {
    return Vector{_mm_mpsadbw_epu8(before.raw, block.raw, 0)};
  }
#else
  static Vector differences(Vector before, Vector block, int pixel) {
    const D8 d8;
    const auto a = hn::BitCast(d8, before);
    const auto b =
        hn::TableLookupBytes(hn::BitCast(d8, block), hn::Set(d8, static_cast<uint8_t>(pixel)));
    return hn::PromoteTo(D16(), hn::LowerHalf(hn::Sub(hn::Max(a, b), hn::Min(a, b))));
  }
  static Vector sad(Vector before, Vector block) {
    const D8 d8;
    const auto from = hn::BitCast(d8, before);
    Vector sum = differences(before, block, 0);
    sum = hn::Add(sum, differences(hn::BitCast(D16(), hn::ShiftRightBytes<1>(d8, from)), block, 1));
    sum = hn::Add(sum, differences(hn::BitCast(D16(), hn::ShiftRightBytes<2>(d8, from)), block, 2));
    return hn::Add(sum,
                   differences(hn::BitCast(D16(), hn::ShiftRightBytes<3>(d8, from)), block, 3));
  }
#endif
};
#endif

#if HWY_TARGET == HWY_SCALAR

void sumBlocks(std::span<const SearchedBlock> blocks, const uint8_t* at, uint16_t* sums) {
  std::fill_n(sums, kGroup, uint16_t{0});
  for (const SearchedBlock& block : blocks) {
    uint8_t pixels[kBlockWidth];
    std::memcpy(pixels, &block.pixels, kBlockWidth);
    for (int i = 0; i < kGroup; ++i)
      for (int k = 0; k < kBlockWidth; ++k) {
        const int d = pixels[k] - at[block.offset + i + k];
        sums[i] = static_cast<uint16_t>(sums[i] + (d < 0 ? -d : d));
      }
  }
}

#else

/// Of at most kMostBlocks blocks the sums of kGroup shifts, the first of which sees them from `at`.
void sumBlocks(std::span<const SearchedBlock> blocks, const uint8_t* at, uint16_t* sums) {
  constexpr int kShifts = 8 * Lanes::kCount, kVectors = kGroup / kShifts;
  typename Lanes::Vector totals[kVectors];
  for (auto& total : totals) total = Lanes::zero();
  for (const SearchedBlock& block : blocks) {
    const auto pixels = Lanes::repeat(block.pixels);
    for (int k = 0; k < kVectors; ++k)
      totals[k] =
          Lanes::add(totals[k], Lanes::sad(Lanes::spread(at + block.offset + k * kShifts), pixels));
  }
  for (int k = 0; k < kVectors; ++k) Lanes::store(totals[k], sums + k * kShifts);
}

#endif

// A loop of which the compiler makes vectors: std::min is one of selected references.
template <class T>
T leastOf(const T* values, int count) {
  T least = std::numeric_limits<T>::max();
  for (int i = 0; i < count; ++i) least = values[i] < least ? values[i] : least;
  return least;
}

class Search {
 public:
  Search(const SearchedPicture& previous, const ShiftRange& range, SearchScratch& scratch)
      : range_(range),
        side_(2 * range.reach + 1),
        groups_((side_ + kGroup - 1) / kGroup),
        pixels_(previous.luma.along(-range.reach, -range.reach)),
        pixelStride_(previous.luma.stride()),
        boxes_(previous.boxes.along(-range.reach, -range.reach)),
        boxStride_(previous.boxes.stride()),
        scratch_(scratch) {
    scratch.bounds.resize({groups_ * kGroup, side_ + kRowsAtOnce - 1});
    scratch.sums.resize({groups_ * kGroup, side_});
    scratch.leasts.resize(static_cast<size_t>(groups_ * side_));
    scratch.isSummed.assign(static_cast<size_t>(groups_ * side_), 0);
  }

  FoundShift run() {
    FoundShift found;
    found.mean = findBounds();
    sumGroup(groupOfLeastBound());
    sumGroup(groupAt(range_.reach, range_.reach));
    sumGroups([this] { return leastInside_; });
    const Point best = findBest();
    found.d = {range_.reach - best.x, range_.reach - best.y};
    found.isBeaten = least_ < leastInside_;
    sumAround(best);
    found.rival = findRival(best);
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x)
        found.sums[static_cast<size_t>(3 * y + x)] =
            scratch_.sums.row(best.y + 1 - y)[best.x + 1 - x];
    return found;
  }

 private:
  [[nodiscard]] int groupAt(int column, int row) const { return row * groups_ + column / kGroup; }

  /// Returns their mean.
  uint32_t findBounds() {
    for (int row = 0; row < side_; row += kRowsAtOnce)
      for (int group = 0; group < groups_; ++group) findBounds(row, group * kGroup);
    uint64_t sum = 0;
    for (int row = 0; row < side_; ++row) {
      uint16_t* bounds = scratch_.bounds.row(row);
      uint32_t rowSum = 0;
      for (int i = 0; i < side_; ++i) rowSum += bounds[i];
      sum += rowSum;
      std::fill_n(bounds + side_, groups_ * kGroup - side_, kMostBound);
      for (int group = 0; group < groups_; ++group)
        scratch_.leasts[static_cast<size_t>(row * groups_ + group)] =
            leastOf(bounds + group * kGroup, kGroup);
    }
    const auto side = static_cast<uint64_t>(std::max(side_, 1));
    return static_cast<uint32_t>(sum / (side * side));
  }

  void findBounds(int row, int column) {
    const hn::CappedTag<uint16_t, kGroup> d;
    const hn::RebindToSigned<decltype(d)> signedTag;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (int first = column; first < column + kGroup; first += lanes) {
      const uint16_t* at = boxes_ + row * boxStride_ + first;
      auto a = hn::Zero(d), b = a, c = a, e = a;
      for (const SearchedBox& box : scratch_.boxes) {
        const uint16_t* before = at + box.offset;
        const auto sum = hn::Set(d, box.sum);
        const auto apart = [&](int k) {
          const auto difference = hn::Sub(hn::LoadU(d, before + k * boxStride_), sum);
          return hn::BitCast(d, hn::Abs(hn::BitCast(signedTag, difference)));
        };
        a = hn::SaturatedAdd(a, apart(0));
        b = hn::SaturatedAdd(b, apart(1));
        c = hn::SaturatedAdd(c, apart(2));
        e = hn::SaturatedAdd(e, apart(3));
      }
      hn::StoreU(a, d, scratch_.bounds.row(row) + first);
      hn::StoreU(b, d, scratch_.bounds.row(row + 1) + first);
      hn::StoreU(c, d, scratch_.bounds.row(row + 2) + first);
      hn::StoreU(e, d, scratch_.bounds.row(row + 3) + first);
    }
  }

  [[nodiscard]] int groupOfLeastBound() const {
    int least = 0;
    for (int group = 1; group < groups_ * side_; ++group)
      if (scratch_.leasts[static_cast<size_t>(group)] < scratch_.leasts[static_cast<size_t>(least)])
        least = group;
    return least;
  }

  /// Shifts whose bound is not above what limit() says at the time; it never rises.
  template <class Limit>
  void sumGroups(const Limit& limit) {
    for (int group = 0; group < groups_ * side_; ++group)
      if (scratch_.leasts[static_cast<size_t>(group)] <= limit()) sumGroup(group);
  }

  void sumGroup(int group) {
    uint8_t& isSummed = scratch_.isSummed[static_cast<size_t>(group)];
    if (isSummed != 0) return;
    isSummed = 1;
    // The analyzer loses the constructor's values here.
    // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult)
    const int row = group / groups_, column = group % groups_ * kGroup;
    const uint8_t* at = pixels_ + row * pixelStride_ + column;
    uint32_t* to = scratch_.sums.row(row) + column;
    std::fill_n(to, kGroup, 0u);
    const std::span<const SearchedBlock> blocks = scratch_.blocks;
    for (size_t first = 0; first < blocks.size(); first += kMostBlocks) {
      uint16_t sums[kGroup];
      sumBlocks(blocks.subspan(first, std::min(kMostBlocks, blocks.size() - first)), at, sums);
      for (int i = 0; i < kGroup; ++i) to[i] += sums[i];
    }
    std::fill_n(to + std::min(kGroup, side_ - column), std::max(0, column + kGroup - side_),
                UINT32_MAX);
    noteLeasts(row, column);
  }

  void noteLeasts(int row, int column) {
    const uint32_t* sums = scratch_.sums.row(row) + column;
    least_ = std::min(least_, leastOf(sums, kGroup));
    const int margin = range_.reach - range_.maxShift;
    if (row < margin || row >= side_ - margin) return;
    const int first = std::max(margin - column, 0);
    const int last = std::min(side_ - margin - column, kGroup);
    leastInside_ = std::min(leastInside_, leastOf(sums + first, last - first));
  }

  /// Column and row.
  [[nodiscard]] Point findBest() const {
    const int margin = range_.reach - range_.maxShift;
    std::tuple<int, int, int> best{INT32_MAX, 0, 0};
    for (int group = 0; group < groups_ * side_; ++group) {
      const int y = group / groups_, column = group % groups_ * kGroup;
      if (scratch_.isSummed[static_cast<size_t>(group)] == 0) continue;
      if (y < margin || y >= side_ - margin) continue;
      const uint32_t* sums = scratch_.sums.row(y);
      const int last = std::min(column + kGroup, side_ - margin);
      for (int x = std::max(column, margin); x < last; ++x) {
        const int dx = range_.reach - x, dy = range_.reach - y;
        if (sums[x] == leastInside_) best = std::min(best, {dx * dx + dy * dy, dy, dx});
      }
    }
    return {range_.reach - std::get<2>(best), range_.reach - std::get<1>(best)};
  }

  /// The shifts beside the best one, and those among which there is a first rival.
  void sumAround(Point best) {
    for (int y = std::max(best.y - 2, 0); y <= std::min(best.y + 2, side_ - 1); ++y) {
      sumGroup(groupAt(std::max(best.x - 2, 0), y));
      sumGroup(groupAt(std::min(best.x + 2, side_ - 1), y));
    }
  }

  uint32_t findRival(Point best) {
    uint32_t rival = UINT32_MAX;
    for (int group = 0; group < groups_ * side_; ++group) {
      if (scratch_.isSummed[static_cast<size_t>(group)] == 0) continue;
      rival = std::min(rival, leastBeside(best, group));
    }
    for (int group = 0; group < groups_ * side_; ++group) {
      if (scratch_.isSummed[static_cast<size_t>(group)] != 0) continue;
      if (scratch_.leasts[static_cast<size_t>(group)] > rival) continue;
      sumGroup(group);
      rival = std::min(rival, leastBeside(best, group));
    }
    return rival;
  }

  /// Of the group's shifts without the 3x3 around the best one.
  [[nodiscard]] uint32_t leastBeside(Point best, int group) const {
    const int row = group / groups_, column = group % groups_ * kGroup;
    const uint32_t* sums = scratch_.sums.row(row) + column;
    if (row < best.y - 1 || row > best.y + 1) return leastOf(sums, kGroup);
    const int left = std::clamp(best.x - 1 - column, 0, kGroup);
    const int right = std::clamp(best.x + 2 - column, 0, kGroup);
    return std::min(leastOf(sums, left), leastOf(sums + right, kGroup - right));
  }

  const ShiftRange range_;
  const int side_, groups_;  ///< Of shifts in a row.
  const uint8_t* const pixels_;
  const ptrdiff_t pixelStride_;
  const uint16_t* const boxes_;
  const ptrdiff_t boxStride_;
  SearchScratch& scratch_;
  uint32_t least_ = UINT32_MAX, leastInside_ = UINT32_MAX;
};

FoundShift searchAll(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                     const SearchedPicture& previous, const ShiftRange& range,
                     SearchScratch& scratch) {
  listBlocks(parts, luma, previous, range.reach, scratch);
  return Search(previous, range, scratch).run();
}

}  // namespace rg::motion::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::motion {
namespace simd {
HWY_EXPORT(searchAll);
}  // namespace simd

FoundShift searchShifts(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                        const SearchedPicture& previous, const ShiftRange& range,
                        SearchScratch& scratch) {
  return HWY_DYNAMIC_DISPATCH(simd::searchAll)(parts, luma, previous, range, scratch);
}

}  // namespace rg::motion
#endif
