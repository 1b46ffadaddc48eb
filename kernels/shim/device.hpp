// SPDX-License-Identifier: LGPL-2.1-or-later
// CUDA's words for device code, for a host compiler. Each does what the programming guide says of
// it, for full warps; warps that are not whole are told (block.cpp).
#pragma once

#include "kernels/shim/faults.hpp"
#include "kernels/shim/shared.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#define __global__
#define __device__
#define __host__
#define __forceinline__ inline
#define __launch_bounds__(...)
#define __grid_constant__

inline void __syncthreads() {
  rg::gpu::shim::waitForBlock();
}

inline void expectFullWarp(unsigned mask) {
  if (mask != 0xFFFFFFFFu) rg::gpu::shim::report("a warp's mask that is not full");
}

/// Any number of up to eight bytes, given to the warp and taken from one of its lanes.
template <class T>
T takeFrom(unsigned mask, T value, unsigned lane) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= 8);
  expectFullWarp(mask);
  uint64_t given = 0;
  std::memcpy(&given, &value, sizeof value);
  const uint64_t taken = rg::gpu::shim::waitForWarp(given)[lane % 32];
  std::memcpy(&value, &taken, sizeof value);
  return value;
}

[[nodiscard]] inline unsigned laneOfThread() {
  return rg::gpu::shim::now().thread % 32;
}

inline void __syncwarp(unsigned mask = 0xFFFFFFFFu) {
  expectFullWarp(mask);
  (void)rg::gpu::shim::waitForWarp(0);
}
template <class T>
T __shfl_sync(unsigned mask, T value, int lane) {
  return takeFrom(mask, value, static_cast<unsigned>(lane));
}
template <class T>
T __shfl_xor_sync(unsigned mask, T value, int bits) {
  return takeFrom(mask, value, laneOfThread() ^ static_cast<unsigned>(bits));
}
template <class T>
T __shfl_up_sync(unsigned mask, T value, unsigned by) {
  const unsigned lane = laneOfThread();
  return takeFrom(mask, value, lane < by ? lane : lane - by);
}
inline unsigned __ballot_sync(unsigned mask, int predicate) {
  expectFullWarp(mask);
  const auto& given = rg::gpu::shim::waitForWarp(predicate != 0);
  unsigned bits = 0;
  for (unsigned lane = 0; lane < 32; ++lane) bits |= static_cast<unsigned>(given[lane]) << lane;
  return bits;
}
inline int __all_sync(unsigned mask, int predicate) {
  return __ballot_sync(mask, predicate) == 0xFFFFFFFFu;
}
inline int __any_sync(unsigned mask, int predicate) {
  return __ballot_sync(mask, predicate) != 0;
}

/// Atomics by what they make of the old value; they return the old one.
template <class T, class Change>
T changeAtomically(T* place, const Change& change) {
  const T old = *place;
  *place = change(old);
  return old;
}
template <class T, class Change>
T changeAtomically(const rg::gpu::shim::AtomicPlace<T>& place, const Change& change) {
  if (!place.trace->isWritten)
    rg::gpu::shim::report(std::string("an atomic on nothing: ") + place.name);
  place.trace->write(rg::gpu::shim::now(), true, place.name, place.index);
  return changeAtomically(place.value, change);
}
template <class Place, class T>
auto atomicAdd(const Place& place, T value) {
  return changeAtomically(place, [&](T old) { return static_cast<T>(old + value); });
}
template <class Place, class T>
auto atomicMin(const Place& place, T value) {
  return changeAtomically(place, [&](T old) { return std::min(old, value); });
}
template <class Place, class T>
auto atomicMax(const Place& place, T value) {
  return changeAtomically(place, [&](T old) { return std::max(old, value); });
}
template <class Place, class T>
auto atomicOr(const Place& place, T value) {
  return changeAtomically(place, [&](T old) { return old | value; });
}

template <class Place, class T>
auto atomicCAS(const Place& place, T expected, T value) {
  return changeAtomically(place, [&](T old) { return old == expected ? value : old; });
}

/// Zeros above the highest set bit.
inline int __clz(unsigned value) {
  return std::countl_zero(value);
}
inline int __popcll(unsigned long long value) {
  return std::popcount(value);
}
/// Place of the lowest set bit, counted from 1; 0 for none.
inline int __ffsll(long long value) {
  return value == 0 ? 0 : std::countr_zero(static_cast<unsigned long long>(value)) + 1;
}

/// Calls step(a, b) for each of the four bytes of two words.
template <class Step>
unsigned forBytes(unsigned a, unsigned b, const Step& step) {
  unsigned out = 0;
  for (int i = 0; i < 32; i += 8)
    out |=
        static_cast<unsigned>(step(static_cast<int>(a >> i & 255), static_cast<int>(b >> i & 255)))
        << i;
  return out;
}
inline unsigned __vabsdiffu4(unsigned a, unsigned b) {
  return forBytes(a, b, [](int x, int y) { return x > y ? x - y : y - x; });
}
inline unsigned __vmaxu4(unsigned a, unsigned b) {
  return forBytes(a, b, [](int x, int y) { return std::max(x, y); });
}
inline unsigned __vminu4(unsigned a, unsigned b) {
  return forBytes(a, b, [](int x, int y) { return std::min(x, y); });
}
/// The sum of the differences.
inline unsigned __vsadu4(unsigned a, unsigned b) {
  const unsigned apart = __vabsdiffu4(a, b);
  return (apart & 255) + (apart >> 8 & 255) + (apart >> 16 & 255) + (apart >> 24);
}
/// 255 where a is above b.
inline unsigned __vcmpgtu4(unsigned a, unsigned b) {
  return forBytes(a, b, [](int x, int y) { return x > y ? 255 : 0; });
}
/// The lower half of both, high before low, after a shift to the right.
inline unsigned __funnelshift_r(unsigned low, unsigned high, unsigned shift) {
  const uint64_t both = uint64_t{high} << 32 | low;
  return static_cast<unsigned>(both >> shift % 32);
}

namespace rg::gpu {
inline unsigned loadQuad(const uint8_t* bytes) {
  if (reinterpret_cast<uintptr_t>(bytes) % 4 != 0) shim::report("a quad at an odd address");
  unsigned quad = 0;
  std::memcpy(&quad, bytes, sizeof quad);
  return quad;
}
}  // namespace rg::gpu
