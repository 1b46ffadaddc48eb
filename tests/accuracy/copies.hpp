// SPDX-License-Identifier: LGPL-2.1-or-later
// Copies of a video that differ from it by no more than another camera, decoder or rate makes: what
// tracking tells of one of them may be luck.
#pragma once

#include "tests/benchmarks/scene.hpp"

#include <cstdint>
#include <span>

namespace rg::truth {

struct Copy {
  const char* name = "same";
  int brighter = 0;  ///< Grey levels.
  int contrastPercent = 100;
  int saturationPercent = 100;
  double noise = 0;       ///< Grey levels, standard deviation.
  uint64_t every = 1;     ///< One frame in so many.
  bool isHalved = false;  ///< In width and height.
};

/// The first one is the video as it is.
[[nodiscard]] std::span<const Copy> copies();

/// Of a frame of packed BGR that frame of the copy; `number`: which one it is, so that noise
/// differs.
void change(const Copy& copy, uint64_t number, bench::RawFrame& frame);

}  // namespace rg::truth
