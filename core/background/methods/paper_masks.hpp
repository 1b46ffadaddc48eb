// SPDX-License-Identifier: LGPL-2.1-or-later
// The masks of method paper (section 2.2.1): bytes of 0 or 255. Determinism: per pixel.
#pragma once

#include "core/base/components.hpp"
#include "core/base/geometry.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::background {

/// What the model says of a picture's pixels, 0 or 255: Fs, Fg, and both of them (Fc).
struct GaussianTests {
  Image<uint8_t> simple, gaussian, common;
};

/// 255 where `plane` is above the threshold, else 0, in place. threshold 0 … 255.
void keepAbove(int threshold, const Executor& executor, ImageView<uint8_t> plane);

/// 255 where both are, else 0. All of one size.
void keepBoth(ImageView<const uint8_t> a, ImageView<const uint8_t> b, const Executor& executor,
              ImageView<uint8_t> out);

/// Fc ∨ (filled ∧ (Fs ∨ Fg)).
void joinFound(const GaussianTests& tests, ImageView<const uint8_t> filled,
               const Executor& executor, ImageView<uint8_t> out);

/// The numbers of the parts in whose boxes fillLines() looks: those of the largest boxes first, of
/// equal ones the first part's. Boxes may overlap; no more is looked at than four times the frame.
void choosePartsToFill(std::span<const Component> parts, Size frame, std::vector<uint32_t>& chosen);

}  // namespace rg::background
