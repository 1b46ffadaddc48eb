// SPDX-License-Identifier: LGPL-2.1-or-later
// What method paper does with pixels, step by step: by the functions of this room, or by a device's
// counterparts of them. Which of the two did a step can't be seen in its result.
#pragma once

#include "core/background/mask_cleaning.hpp"
#include "core/background/methods/paper_masks.hpp"
#include "core/background/models/gaussian_background.hpp"
#include "core/base/bit_mask.hpp"
#include "core/base/components.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace rg::background {

/// Each does what the function of its name does; this class does it on the CPU.
class PaperOperations {
 public:
  explicit PaperOperations(const Executor& executor) : executor_(executor) {}
  virtual ~PaperOperations() = default;
  PaperOperations(const PaperOperations&) = delete;
  PaperOperations& operator=(const PaperOperations&) = delete;

  virtual void train(const Picture& picture, GaussianBackground& model);
  virtual void finishTraining(GaussianBackground& model);
  /// testGaussian() and keepBoth(). The planes have the picture's size.
  virtual void testGaussian(const Picture& picture, const GaussianBackground& model, int threshold,
                            GaussianTests& tests);
  /// What differs by more than a threshold of at least `leastEdge`, from the histogram.
  virtual void findEdges(const Picture& picture, const Picture& previous, int leastEdge,
                         Image<uint8_t>& edges);
  /// fillLines() in the boxes of what is common, written anew.
  virtual void fillAreas(const Image<uint8_t>& common, const Image<uint8_t>& edges,
                         Image<uint8_t>& filled);
  virtual void joinFound(const GaussianTests& tests, const Image<uint8_t>& filled,
                         Image<uint8_t>& mask);
  /// findShadows() before the model's means; they become kShadowPixel.
  virtual void markShadows(const Picture& picture, const GaussianBackground& model,
                           Image<uint8_t>& mask);
  virtual void updateGaussian(const Picture& picture, const Image<uint8_t>& mask,
                              const UpdateRates& rates, GaussianBackground& model);
  /// Whoever reads the mask reads it on the host.
  virtual void publish(Image<uint8_t>&) {}

 private:
  const Executor& executor_;
  std::array<Image<uint8_t>, 3> mean_;
  BitMask found_, shadow_;
  Components areas_;
  std::vector<uint32_t> chosen_;
  CleaningScratch scratch_;
};

}  // namespace rg::background
