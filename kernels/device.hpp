// SPDX-License-Identifier: LGPL-2.1-or-later
// What a .cu file is written in: CUDA's own words for nvcc, and the same words for a host compiler,
// where fibers are the threads (kernels/shim).
//
// RG_SHARED(type, name, count) declares a block's array; the host version tells reads of what
// nobody wrote and accesses that no barrier parts. `name[i]` is an element, `&name[i]` an atomic's
// place. Rules that keep both alike: full warp masks, blocks of whole warps, integer atomics, no
// inline PTX, nothing that asks for __CUDA_ARCH__.
#pragma once

#if defined(__CUDACC__)
#include <cuda_runtime.h>
#define RG_SHARED(type, name, count) __shared__ type name[count]

namespace rg::gpu {
/// Four bytes at once; their address is a multiple of four.
__device__ inline unsigned loadQuad(const unsigned char* bytes) {
  return *reinterpret_cast<const unsigned*>(bytes);
}
}  // namespace rg::gpu
#else
#include "kernels/shim/device.hpp"
#endif

#include <cstdint>

namespace rg::gpu {

/// Four bytes from any address; up to seven behind it must be readable.
__device__ inline unsigned loadQuadAnywhere(const uint8_t* bytes) {
  const auto offset = static_cast<unsigned>(reinterpret_cast<uintptr_t>(bytes) % 4);
  const unsigned low = loadQuad(bytes - offset), high = loadQuad(bytes - offset + 4);
  return __funnelshift_r(low, high, 8 * offset);
}

inline constexpr int kWarp = 32;
inline constexpr unsigned kFullWarp = 0xFFFFFFFFu;

/// Errors that the tests of the tests put into kernels; they exist on the host only.
enum class Mutant {
  None,
  MissingBarrier,
  StaleHalo,
  OddWidth,
  WrongTieBreak,
  LostAtomic,
};

#ifndef __CUDACC__
inline Mutant activeMutant = Mutant::None;
[[nodiscard]] inline bool isMutated(Mutant mutant) {
  return activeMutant == mutant;
}
#else
[[nodiscard]] constexpr bool isMutated(Mutant) {
  return false;
}
#endif

}  // namespace rg::gpu
