// SPDX-License-Identifier: LGPL-2.1-or-later
// Starting kernels: shapes of grids, streams, checked calls.
//
// No kernel's function allocates, waits or copies back: what comes in is device memory that the
// caller owns, what is asked for has happened when the stream has come so far. A launch that is
// refused throws DeviceError.
#pragma once

#include "core/base/geometry.hpp"

#include <cstdint>

struct CUstream_st;

namespace rg::gpu {

class LaunchQueue;

/// A stream of CUDA's, and the queue by which it gets its launches, if any.
struct Stream {
  CUstream_st* handle = nullptr;
  LaunchQueue* queue = nullptr;

  constexpr Stream(CUstream_st* stream = nullptr,  // NOLINT(google-explicit-constructor)
                   LaunchQueue* by = nullptr)
      : handle(stream), queue(by) {}
};

struct Extent {
  unsigned x = 1, y = 1, z = 1;
};

/// What a launch has to move and to do at least, for the model (tests/kernels/model.cpp): bytes
/// that device memory must deliver or take once, integer operations of the arithmetic.
struct Work {
  double bytes = 0;
  double operations = 0;
};

struct Launch {
  const char* name;
  Extent grid, block;
  Work work;
};

[[nodiscard]] constexpr unsigned blocksFor(int64_t count, unsigned perBlock) {
  return static_cast<unsigned>((count + perBlock - 1) / perBlock);
}
static_assert(blocksFor(257, 32) == 9 && blocksFor(256, 32) == 8);

/// Blocks of 32x8 threads: a warp reads 32 neighbours of a row, and eight rows share what they read
/// of each other.
inline constexpr Extent kTile{32, 8, 1};

/// A thread for each pixel, in `layers` layers.
[[nodiscard]] constexpr Launch launchOver(const char* name, Size size, unsigned layers,
                                          const Work& work) {
  return {
      name, {blocksFor(size.width, kTile.x), blocksFor(size.height, kTile.y), layers}, kTile, work};
}

/// A warp for each word of 64 columns: a lane has columns `lane` and `lane` + 32.
[[nodiscard]] constexpr Launch launchOverWords(const char* name, Size size, const Work& work) {
  return {name, {blocksFor(size.width, 64), blocksFor(size.height, kTile.y), 1}, kTile, work};
}

/// A thread for each of `count` things in a row.
[[nodiscard]] constexpr Launch launchOverList(const char* name, int64_t count, const Work& work) {
  return {name, {blocksFor(count, 256), 1, 1}, {256, 1, 1}, work};
}

/// Two blocks for each multiprocessor of a large device: more would wait.
inline constexpr unsigned kMostBlocks = 264;

/// Threads that take up to `count` things in turns: how many there are, the device knows only.
[[nodiscard]] constexpr Launch launchInTurns(const char* name, int64_t count, const Work& work) {
  const unsigned blocks = blocksFor(count, 256);
  return {name, {blocks < kMostBlocks ? blocks : kMostBlocks, 1, 1}, {256, 1, 1}, work};
}

}  // namespace rg::gpu
