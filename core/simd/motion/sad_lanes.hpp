// SPDX-License-Identifier: LGPL-2.1-or-later
// Sums of absolute differences at neighbouring places, for every instruction set; included once for
// each. The machine's SAD instructions compare four pixels at eight places at once (mpsadbw;
// vdbpsadbw does so in four lanes). So a vector holds sums of shifts that follow each other along
// x: lanes of eight.
#if defined(REGIONGRAPH_SIMD_SAD_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef REGIONGRAPH_SIMD_SAD_LANES
#undef REGIONGRAPH_SIMD_SAD_LANES
#else
#define REGIONGRAPH_SIMD_SAD_LANES
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::motion::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET <= HWY_AVX3
/// Dwords of a lane that the two halves of its SADs are taken from: 0 1, 1 2.
constexpr int kDwords = 0 | 1 << 2 | 1 << 4 | 2 << 6;

/// Four lanes: 32 shifts.
struct WideLanes {
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
    return _mm512_dbsad_epu8(block, before, kDwords);
  }
};
#endif

#if HWY_TARGET <= HWY_AVX2
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
  static Vector sad(Vector before, Vector block) {
#if HWY_TARGET <= HWY_AVX3
    return _mm256_dbsad_epu8(block, before, kDwords);
#else
    return _mm256_mpsadbw_epu8(before, block, 0);
#endif
  }
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

}  // namespace rg::motion::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
