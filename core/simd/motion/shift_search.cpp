// SPDX-License-Identifier: LGPL-2.1-or-later
// searchShifts for every instruction set.
#include "core/motion/shift_search.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <tuple>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/motion/shift_search.cpp"
#include "core/simd/base/targets.hpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After foreach_target, once for each.
#include "core/simd/motion/sad_lanes.hpp"

#ifndef REGIONGRAPH_SIMD_SHIFT_SEARCH_ONCE
#define REGIONGRAPH_SIMD_SHIFT_SEARCH_ONCE
namespace rg::motion::simd {

/// Shifts along x that are summed together.
constexpr int kGroup = 32;
/// Of a row's last group the first half, where that is enough.
constexpr int kHalfGroup = kGroup / 2;
/// Blocks whose sums fit 16 bits.
constexpr size_t kMostBlocks = 64;
static_assert(kMostBlocks * kBlockWidth * 255 <= 0xFFFF);
/// Boxes whose differences fit 16 bits.
constexpr size_t kMostBoxes = 16;
static_assert(kMostBoxes * kBoxSide * kBoxSide * 255 <= 0xFFFF);
/// Rows of shifts whose bounds are taken together: there are so many rows beyond the last.
constexpr int kRowsAtOnce = 4;

/// Of the pixels whose first is `at`: bytes are added in lanes of 16 bits.
inline uint16_t sumBox(const uint8_t* at, ptrdiff_t stride) {
  constexpr uint64_t kEven = 0x00FF00FF00FF00FF, kOnes = 0x0001000100010001;
  uint64_t lanes = 0;
  for (int pair = 0; pair < kBoxSide; pair += 2) {
    uint32_t rows[2];
    std::memcpy(&rows[0], at + pair * stride, kBoxSide);
    std::memcpy(&rows[1], at + (pair + 1) * stride, kBoxSide);
    const uint64_t bytes = uint64_t{rows[1]} << 32 | rows[0];
    lanes += (bytes & kEven) + (bytes >> 8 & kEven);
  }
  return static_cast<uint16_t>(lanes * kOnes >> 48);
}
static_assert(kBoxSide == sizeof(uint32_t));

inline void listBlocks(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                       const SearchedPicture& previous, SearchScratch& scratch) {
  size_t most = 0;
  for (const MatchedPart& part : parts) most += part.pixels() / kBlockWidth;
  scratch.blocks.resize(most);
  scratch.boxes.resize(most / kBoxSide);
  SearchedBlock* block = scratch.blocks.data();
  SearchedBox* box = scratch.boxes.data();
  const ptrdiff_t pixelStride = previous.luma.stride(), boxStride = previous.boxes.stride();
  for (const MatchedPart& part : parts) {
    forBlocks(part, [&](int x, int y) {
      block->offset = y * pixelStride + x;
      std::memcpy(&block->pixels, luma.row(y) + x, kBlockWidth);
      ++block;
    });
    forBoxes(part, [&](int x, int y) {
      *box++ = {y * boxStride + x, sumBox(luma.row(y) + x, luma.strideBytes)};
    });
  }
  scratch.boxes.resize(static_cast<size_t>(box - scratch.boxes.data()));
}

}  // namespace rg::motion::simd
#endif

HWY_BEFORE_NAMESPACE();
namespace rg::motion::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Of at most kMostBlocks blocks the sums of `kShifts` shifts, the first of which sees them from
/// `at`.
template <int kShifts>
void sumBlocks(std::span<const SearchedBlock> blocks, const uint8_t* at, uint16_t* sums) {
#if HWY_TARGET == HWY_SCALAR
  std::fill_n(sums, kShifts, uint16_t{0});
  for (const SearchedBlock& block : blocks) {
    uint8_t pixels[kBlockWidth];
    std::memcpy(pixels, &block.pixels, kBlockWidth);
    for (int i = 0; i < kShifts; ++i)
      for (int k = 0; k < kBlockWidth; ++k) {
        const int d = pixels[k] - at[block.offset + i + k];
        sums[i] = static_cast<uint16_t>(sums[i] + (d < 0 ? -d : d));
      }
  }
#else
#if HWY_TARGET <= HWY_AVX3
  using Lanes = std::conditional_t<kShifts == kGroup, WideLanes, Lanes>;
#endif
  constexpr int kInVector = 8 * Lanes::kCount, kVectors = kShifts / kInVector;
  typename Lanes::Vector totals[kVectors];
  for (auto& total : totals) total = Lanes::zero();
  for (const SearchedBlock& block : blocks) {
    const auto pixels = Lanes::repeat(block.pixels);
    for (int k = 0; k < kVectors; ++k)
      totals[k] = Lanes::add(totals[k],
                             Lanes::sad(Lanes::spread(at + block.offset + k * kInVector), pixels));
  }
  for (int k = 0; k < kVectors; ++k) Lanes::store(totals[k], sums + k * kInVector);
#endif
}

// A loop of which the compiler makes vectors: std::min is one of selected references.
template <class T>
T leastOf(const T* values, int count) {
  T least = std::numeric_limits<T>::max();
  for (int i = 0; i < count; ++i) least = values[i] < least ? values[i] : least;
  return least;
}

template <class T>
T greatestOf(const T* values, int count) {
  T greatest = 0;
  for (int i = 0; i < count; ++i) greatest = values[i] > greatest ? values[i] : greatest;
  return greatest;
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
    for (Image<uint16_t>* bounds : {&scratch.bounds, &scratch.someBounds})
      bounds->resize({groups_ * kGroup, side_ + kRowsAtOnce - 1});
    scratch.sums.resize({groups_ * kGroup, side_});
    scratch.leasts.resize(static_cast<size_t>(groups_ * side_));
    scratch.isSummed.assign(static_cast<size_t>(groups_ * side_), 0);
  }

  FoundShift run() {
    FoundShift found;
    const uint32_t mean = findBounds();
    sumGroup(groupOfLeastBound());
    sumGroup(groupAt(range_.reach, range_.reach));
    sumGroups([this] { return std::min(leastInside_, range_.mostSum); });
    found.isWithin = leastInside_ <= range_.mostSum;
    if (!found.isWithin) return found;
    found.mean = mean;
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

  /// Returns the mean of what they bound, which may be larger than any bound.
  uint32_t findBounds() {
    const std::span<const SearchedBox> boxes = scratch_.boxes;
    uint64_t sum = findBounds(boxes, scratch_.bounds);
    bool isExact = true;
    for (int row = 0; row < side_; ++row) {
      uint16_t* bounds = scratch_.bounds.row(row);
      isExact = isExact && greatestOf(bounds, side_) < kMostBound;
      std::fill_n(bounds + side_, groups_ * kGroup - side_, kMostBound);
      for (int group = 0; group < groups_; ++group)
        scratch_.leasts[static_cast<size_t>(row * groups_ + group)] =
            leastOf(bounds + group * kGroup, kGroup);
    }
    if (!isExact) {
      sum = 0;
      for (size_t first = 0; first < boxes.size(); first += kMostBoxes)
        sum += findBounds(boxes.subspan(first, std::min(kMostBoxes, boxes.size() - first)),
                          scratch_.someBounds);
    }
    const auto side = static_cast<uint64_t>(std::max(side_, 1));
    return static_cast<uint32_t>(sum / (side * side));
  }

  /// Returns their sum: of at most kMostBoxes they are exact.
  uint64_t findBounds(std::span<const SearchedBox> boxes, Image<uint16_t>& to) {
    for (int row = 0; row < side_; row += kRowsAtOnce)
      for (int column = 0; column < side_; column += kGroup) {
        if (side_ - column > kHalfGroup)
          findBounds<kGroup>(boxes, {column, row}, to);
        else
          findBounds<kHalfGroup>(boxes, {column, row}, to);
      }
    uint64_t sum = 0;
    for (int row = 0; row < side_; ++row) {
      const uint16_t* bounds = to.row(row);
      uint32_t rowSum = 0;
      for (int i = 0; i < side_; ++i) rowSum += bounds[i];
      sum += rowSum;
    }
    return sum;
  }

  template <int kShifts>
  void findBounds(std::span<const SearchedBox> boxes, Point shift, Image<uint16_t>& to) {
    const hn::CappedTag<uint16_t, kShifts> d;
    const hn::RebindToSigned<decltype(d)> signedTag;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (int first = shift.x; first < shift.x + kShifts; first += lanes) {
      const uint16_t* at = boxes_ + shift.y * boxStride_ + first;
      auto a = hn::Zero(d), b = a, c = a, e = a;
      for (const SearchedBox& box : boxes) {
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
      hn::StoreU(a, d, to.row(shift.y) + first);
      hn::StoreU(b, d, to.row(shift.y + 1) + first);
      hn::StoreU(c, d, to.row(shift.y + 2) + first);
      hn::StoreU(e, d, to.row(shift.y + 3) + first);
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
    if (side_ - column > kHalfGroup)
      sumShifts<kGroup>(at, to);
    else
      sumShifts<kHalfGroup>(at, to);
    std::fill_n(to + std::min(kGroup, side_ - column), std::max(0, column + kGroup - side_),
                UINT32_MAX);
    noteLeasts(row, column);
  }

  template <int kShifts>
  void sumShifts(const uint8_t* at, uint32_t* to) const {
    std::fill_n(to, kShifts, 0u);
    const std::span<const SearchedBlock> blocks = scratch_.blocks;
    for (size_t first = 0; first < blocks.size(); first += kMostBlocks) {
      uint16_t sums[kShifts];
      sumBlocks<kShifts>(blocks.subspan(first, std::min(kMostBlocks, blocks.size() - first)), at,
                         sums);
      for (int i = 0; i < kShifts; ++i) to[i] += sums[i];
    }
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
  listBlocks(parts, luma, previous, scratch);
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
