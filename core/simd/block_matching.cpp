// SPDX-License-Identifier: LGPL-2.1-or-later
// addParts for every instruction set. The machine's SAD instructions compare four pixels at eight
// neighbouring places at once (mpsadbw; vdbpsadbw does so in four lanes). So a vector holds sums of
// shifts that follow each other along x: lanes of eight. The rows of the previous picture are
// spread out once for a part, so that each vector of them is one load.
#include "core/block_matching.hpp"

#include <bit>
#include <cstring>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/block_matching.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef REGIONGRAPH_SIMD_BLOCK_MATCHING_ONCE
#define REGIONGRAPH_SIMD_BLOCK_MATCHING_ONCE
namespace rg::simd {

constexpr int kLaneShifts = 8;
constexpr int kMostBlocks = 64;
/// Rows of shifts that are summed together: the 16-bit sums have so many rows beyond the last.
constexpr int kRowsAtOnce = 9;
static_assert(kMostBlocks * kBlockWidth * 255 <= 0xFFFF);

/// The blocks of one part.
struct BlockList {
  const uint8_t* reference = nullptr;  ///< Where shift (−reach, −reach) sees the tile's first
                                       ///< column and the first row that has a block.
  ptrdiff_t stride = 0;
  int rows = 0;  ///< From the first to the last one that has a block.
  int count = 0;
  uint32_t pixels[kMostBlocks] = {};  ///< Of each block.
  int places[kMostBlocks] = {};       ///< Of each block: 2 · row + half.
};

inline BlockList listBlocks(const MatchedPart& part, ImageView<const uint8_t> luma,
                            const Search& search) {
  BlockList list;
  const int first = std::countr_zero(part.blocks) / 2;
  const int last = (63 - std::countl_zero(part.blocks)) / 2;
  list.rows = last - first + 1;
  list.stride = search.previous.stride();
  list.reference = search.previous.along(part.x() - search.reach, part.y() + first - search.reach);
  for (uint64_t left = part.blocks; left != 0; left &= left - 1) {
    const int bit = std::countr_zero(left);
    const int y = part.y() + bit / 2, x = part.x() + bit % 2 * kBlockWidth;
    std::memcpy(&list.pixels[list.count], luma.row(y) + x, kBlockWidth);
    list.places[list.count++] = bit - 2 * first;
  }
  return list;
}

}  // namespace rg::simd
#endif

HWY_BEFORE_NAMESPACE();
namespace rg::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET <= HWY_AVX3
/// Dwords of a lane that the two halves of the SADs are taken from: 0 1, 1 2.
constexpr int kOverlap = 0 | 1 << 2 | 1 << 4 | 2 << 6;

/// Four lanes: 32 shifts.
struct Wide {
  using Vector = __m512i;
  static constexpr int kLanes = 4;
  static Vector zero() { return _mm512_setzero_si512(); }
  static Vector load(const void* from) { return _mm512_load_si512(from); }
  static void store(Vector v, void* to) { _mm512_store_si512(to, v); }
  static Vector spread(const uint8_t* from) {
    return _mm512_permutexvar_epi64(_mm512_setr_epi64(0, 1, 1, 2, 2, 3, 3, 4),
                                    _mm512_loadu_si512(from));
  }
  static Vector repeat(uint32_t pixels) { return _mm512_set1_epi32(static_cast<int>(pixels)); }
  static Vector add(Vector a, Vector b) { return _mm512_add_epi16(a, b); }
  static Vector sad(Vector before, Vector block) {
    return _mm512_dbsad_epu8(block, before, kOverlap);
  }
};
#endif

#if HWY_TARGET <= HWY_AVX2
/// Two lanes.
struct Half {
  using Vector = __m256i;
  static constexpr int kLanes = 2;
  static Vector zero() { return _mm256_setzero_si256(); }
  static Vector load(const void* from) {
    return _mm256_load_si256(static_cast<const __m256i*>(from));
  }
  static void store(Vector v, void* to) { _mm256_store_si256(static_cast<__m256i*>(to), v); }
  static Vector spread(const uint8_t* from) {
    return _mm256_permute4x64_epi64(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)),
                                    0 | 1 << 2 | 1 << 4 | 2 << 6);
  }
  static Vector repeat(uint32_t pixels) { return _mm256_set1_epi32(static_cast<int>(pixels)); }
  static Vector add(Vector a, Vector b) { return _mm256_add_epi16(a, b); }
  static Vector sad(Vector before, Vector block) {
#if HWY_TARGET <= HWY_AVX3
    return _mm256_dbsad_epu8(block, before, kOverlap);
#else
    return _mm256_mpsadbw_epu8(before, block, 0);
#endif
  }
};
#elif HWY_TARGET != HWY_SCALAR
/// One lane of bytes; where there is no instruction for it, four differences are added up.
struct Half {
  using D8 = hn::Full128<uint8_t>;
  using D16 = hn::Full128<uint16_t>;
  using Vector = hn::Vec<D16>;
  static constexpr int kLanes = 1;
  static Vector zero() { return hn::Zero(D16()); }
  static Vector load(const void* from) {
    return hn::Load(D16(), static_cast<const uint16_t*>(from));
  }
  static void store(Vector v, void* to) { hn::Store(v, D16(), static_cast<uint16_t*>(to)); }
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

#if HWY_TARGET != HWY_SCALAR

/// Adds the sums of the shifts from column firstShift on, Lanes of them, of all rows.
template <class Lanes>
void matchColumns(const BlockList& list, int reach, int firstShift, MatchScratch& scratch) {
  constexpr int kBytes = Lanes::kLanes * 16;
  const int side = 2 * reach + 1;
  uint8_t* spread = scratch.spread.row(0);
  const uint8_t* from = list.reference + firstShift;
  for (int row = 0; row < list.rows + 2 * reach; ++row, from += list.stride) {
    Lanes::store(Lanes::spread(from), spread + (2 * row) * kBytes);
    Lanes::store(Lanes::spread(from + kBlockWidth), spread + (2 * row + 1) * kBytes);
  }
  for (int ey = 0; ey < side; ey += kRowsAtOnce) {
    typename Lanes::Vector sums[kRowsAtOnce];
    for (auto& sum : sums) sum = Lanes::zero();
    for (int i = 0; i < list.count; ++i) {
      const auto block = Lanes::repeat(list.pixels[i]);
      const uint8_t* before = spread + (list.places[i] + 2 * ey) * kBytes;
      for (int k = 0; k < kRowsAtOnce; ++k)
        sums[k] = Lanes::add(sums[k], Lanes::sad(Lanes::load(before + 2 * k * kBytes), block));
    }
    for (int k = 0; k < kRowsAtOnce; ++k) {
      uint16_t* to = scratch.sums.row(ey + k) + firstShift;
      Lanes::store(Lanes::add(Lanes::load(to), sums[k]), to);
    }
  }
}

void matchPart(const BlockList& list, int reach, MatchScratch& scratch) {
  const int side = 2 * reach + 1;
  int first = 0;
#if HWY_TARGET <= HWY_AVX3
  constexpr int kShifts = Wide::kLanes * kLaneShifts;
  for (; side - first > Half::kLanes * kLaneShifts; first += kShifts)
    matchColumns<Wide>(list, reach, first, scratch);
#endif
  for (; first < side; first += Half::kLanes * kLaneShifts)
    matchColumns<Half>(list, reach, first, scratch);
}

/// Adds the 16-bit sums to the 32-bit ones, and clears them.
void moveSums(int reach, MatchScratch& scratch, uint32_t* sums) {
  const hn::ScalableTag<uint32_t> d32;
  const hn::Rebind<uint16_t, decltype(d32)> d16;
  const auto lanes = static_cast<int>(hn::Lanes(d32));
  const int side = 2 * reach + 1, whole = side / lanes * lanes;
#if HWY_TARGET <= HWY_AVX2
  const auto tail = hn::FirstN(d32, static_cast<size_t>(side - whole));
#endif
  for (int ey = 0; ey < side; ++ey, sums += side) {
    uint16_t* from = scratch.sums.row(ey);
    const auto take = [&](int ex) {
      const auto sum = hn::PromoteTo(d32, hn::Load(d16, from + ex));
      hn::Store(hn::Zero(d16), d16, from + ex);
      return sum;
    };
    for (int ex = 0; ex < whole; ex += lanes)
      hn::StoreU(hn::Add(hn::LoadU(d32, sums + ex), take(ex)), d32, sums + ex);
#if HWY_TARGET <= HWY_AVX2
    if (whole < side)
      hn::BlendedStore(hn::Add(hn::MaskedLoad(tail, d32, sums + whole), take(whole)), tail, d32,
                       sums + whole);
#else  // Masked access touches whole vectors, and aligned ones only.
    for (int ex = whole; ex < side; ++ex) sums[ex] += std::exchange(from[ex], uint16_t{0});
#endif
  }
}

void addAll(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma, const Search& search,
            MatchScratch& scratch, std::span<uint32_t> sums) {
  constexpr int kMostBytes = 64, kMostShifts = 32;
  const int reach = search.reach, side = 2 * reach + 1;
  scratch.spread.resize({kMostBytes * 2 * (kPartHeight + 2 * reach + kRowsAtOnce), 1});
  scratch.sums.resize(
      {(side + kMostShifts - 1) / kMostShifts * kMostShifts, side + kRowsAtOnce - 1});
  scratch.sums.fill(0);
  int blocks = 0;
  for (const MatchedPart& part : parts) {
    const BlockList list = listBlocks(part, luma, search);
    if (blocks + list.count > kMostBlocks) {
      moveSums(reach, scratch, sums.data());
      blocks = 0;
    }
    matchPart(list, reach, scratch);
    blocks += list.count;
  }
  if (blocks > 0) moveSums(reach, scratch, sums.data());
}

#else

void addAll(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma, const Search& search,
            MatchScratch&, std::span<uint32_t> sums) {
  addPartsPlainly(parts, luma, search, sums);
}

#endif

}  // namespace rg::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg {
namespace simd {
HWY_EXPORT(addAll);
}  // namespace simd

void addParts(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
              const Search& search, MatchScratch& scratch, std::span<uint32_t> sums) {
  HWY_DYNAMIC_DISPATCH(simd::addAll)(parts, luma, search, scratch, sums);
}

}  // namespace rg
#endif
