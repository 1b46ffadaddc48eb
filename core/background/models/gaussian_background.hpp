// SPDX-License-Identifier: LGPL-2.1-or-later
// The paper's background model: one Gaussian per pixel and channel, in fixed point (section 2.2.1).
//
// Determinism: per pixel only, integers with one rounding rule.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"

#include <array>
#include <cstdint>

namespace rg::background {

/// Means in 1/256 grey level, variances in 1/16 square grey level, 4 … 3600 grey levels squared.
struct GaussianBackground {
  std::array<Image<uint16_t>, 3> means, variances;
  std::array<Image<uint32_t>, 3> sums, squares;  ///< Of the training frames, at most 65535.
  int trainedFrames = 0;
  int channels = 0;  ///< 1 for grey pictures, else 3; 0 before the first frame.
};

/// Gives the model the picture's size and forgets everything.
void startTraining(const Picture& picture, GaussianBackground& model);
void train(const Picture& picture, const Executor& executor, GaussianBackground& model);
/// Means and variances from the sums. Needs one trained frame at least.
void finishTraining(const Executor& executor, GaussianBackground& model);

/// simple (Fs): a channel is off its mean by more than `threshold` grey levels.
/// gaussian (Fg): the Mahalanobis distance of the colour is above 3. Both 0 or 255.
void testGaussian(const Picture& picture, const GaussianBackground& model, int threshold,
                  const Executor& executor, Image<uint8_t>& simple, Image<uint8_t>& gaussian);

/// Rates of the running update as powers of two: 2^-shift of the new frame, every `period` frames.
struct UpdateRate {
  int shift = 8;  ///< 1 … 8: beyond that, rounding would stop the mean from moving.
  uint32_t period = 1;
};
/// The rate's shift in a frame, 0 where it has no turn.
[[nodiscard]] constexpr int shiftNow(const UpdateRate& rate, uint32_t frame) {
  return frame % rate.period == 0 ? rate.shift : 0;
}
/// Rate with a time constant of `frames` frames.
[[nodiscard]] UpdateRate updateRate(int64_t frames);

/// Running average; pixels set in `foreground` take the rate `slow`.
struct UpdateRates {
  UpdateRate usual, slow;
  uint32_t frame = 0;  ///< Counts the frames, for the periods.
};
void updateGaussian(const Picture& picture, ImageView<const uint8_t> foreground,
                    const UpdateRates& rates, const Executor& executor, GaussianBackground& model);

/// Writes the means, rounded to grey levels.
void paintMean(const GaussianBackground& model, const Executor& executor,
               std::array<Image<uint8_t>, 3>& planes);

}  // namespace rg::background
