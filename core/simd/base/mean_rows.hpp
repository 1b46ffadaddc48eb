// SPDX-License-Identifier: LGPL-2.1-or-later
// The inner loop of core/base/reduced_frame.cpp, compiled for every instruction set.
//
// It is written once, in plain integer arithmetic; the compiler makes the vectors. So all targets,
// the plain one among them, give the same bits.
#pragma once

#include <cstdint>

namespace rg::simd {

/// sums[i] += bytes[i]. The caller bounds how often.
void addRow(const uint8_t* bytes, int count, uint16_t* sums);
/// The same of words' lower ten bits (upperOfTen in conversion.hpp), low byte first.
void addRowOfTen(const uint8_t* bytes, int count, uint16_t* sums);

}  // namespace rg::simd
