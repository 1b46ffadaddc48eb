// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/models/gaussian_background.hpp"

#include "core/background/models/gaussian_pixel.hpp"

#include <algorithm>
#include <bit>

namespace rg::background {
namespace {

std::array<ImageView<const uint8_t>, 3> planesOf(const Picture& picture) {
  return {picture.green(), picture.red(), picture.blue()};
}

/// Calls task(c, y) for every channel of every row.
template <class Task>
void forPlaneRows(const GaussianBackground& model, const Executor& executor, const Task& task) {
  executor.forRows(model.sums[0].height(), [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (size_t c = 0; c < static_cast<size_t>(model.channels); ++c) task(c, y);
  });
}

void updateRow(const uint8_t* pixels, const uint8_t* useShift, int width, uint16_t* means,
               uint16_t* variances) {
  for (int x = 0; x < width; ++x) {
    const int shift = useShift[x];
    if (shift == 0) continue;
    const GaussianPixel next = updatedPixel({means[x], variances[x]}, pixels[x], shift);
    means[x] = next.mean;
    variances[x] = next.variance;
  }
}

}  // namespace

void startTraining(const Picture& picture, GaussianBackground& model) {
  model.channels = picture.isGrey() ? 1 : 3;
  model.trainedFrames = 0;
  for (size_t c = 0; c < 3; ++c) {
    const Size size = c < static_cast<size_t>(model.channels) ? picture.size() : Size{};
    for (Image<uint32_t>* image : {&model.sums[c], &model.squares[c]}) {
      image->resize(size);
      image->fill(0);
    }
    for (Image<uint16_t>* image : {&model.means[c], &model.variances[c]}) {
      image->resize(size);
      image->fill(0);
    }
  }
}

void train(const Picture& picture, const Executor& executor, GaussianBackground& model) {
  const auto planes = planesOf(picture);
  const int width = picture.size().width;
  forPlaneRows(model, executor, [&](size_t c, int y) {
    const uint8_t* row = planes[c].row(y);
    uint32_t* sums = model.sums[c].row(y);
    uint32_t* squares = model.squares[c].row(y);
    for (int x = 0; x < width; ++x) {
      sums[x] += row[x];
      squares[x] += static_cast<uint32_t>(row[x] * row[x]);  // 65535 · 255² < 2³².
    }
  });
  ++model.trainedFrames;
}

void finishTraining(const Executor& executor, GaussianBackground& model) {
  const auto count = static_cast<uint64_t>(model.trainedFrames);
  const int width = model.sums[0].width();
  forPlaneRows(model, executor, [&](size_t c, int y) {
    const uint32_t* sums = model.sums[c].row(y);
    const uint32_t* squares = model.squares[c].row(y);
    for (int x = 0; x < width; ++x) {
      const GaussianPixel trained = trainedPixel(sums[x], squares[x], count);
      model.means[c].row(y)[x] = trained.mean;
      model.variances[c].row(y)[x] = trained.variance;
    }
  });
}

void testGaussian(const Picture& picture, const GaussianBackground& model, int threshold,
                  const Executor& executor, Image<uint8_t>& simple, Image<uint8_t>& gaussian) {
  const auto planes = planesOf(picture);
  const Size size = picture.size();
  simple.resize(size);
  gaussian.resize(size);
  executor.forRows(size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < size.width; ++x) {
        int farthest = 0;
        uint32_t distance = 0;
        for (size_t c = 0; c < static_cast<size_t>(model.channels); ++c) {
          const int off = offMean(planes[c].row(y)[x], model.means[c].row(y)[x]);
          farthest = std::max(farthest, off);
          distance += distanceOf(off, model.variances[c].row(y)[x]);
        }
        simple.row(y)[x] = farthest > threshold << 8 ? 255 : 0;
        gaussian.row(y)[x] = distance > kFarDistance ? 255 : 0;
      }
    }
  });
}

UpdateRate updateRate(int64_t frames) {
  const auto bounded = static_cast<uint64_t>(std::clamp<int64_t>(frames, 2, int64_t{1} << 24));
  // The power of two nearest from below to √2 times the frames.
  const int shift = std::max(1, static_cast<int>(std::bit_width(bounded + bounded * 2 / 5)) - 1);
  const int usable = std::min(shift, 8);
  return {usable, uint32_t{1} << (shift - usable)};
}

void updateGaussian(const Picture& picture, ImageView<const uint8_t> foreground,
                    const UpdateRates& rates, const Executor& executor, GaussianBackground& model) {
  const auto planes = planesOf(picture);
  const int width = picture.size().width;
  const auto usual = static_cast<uint8_t>(shiftNow(rates.usual, rates.frame));
  const auto slow = static_cast<uint8_t>(shiftNow(rates.slow, rates.frame));
  executor.forRows(picture.size().height, [&](int first, int last) {
    std::array<uint8_t, 256> shifts{};
    for (int y = first; y < last; ++y) {
      const uint8_t* mask = foreground.row(y);
      for (int x = 0; x < width; x += 256) {
        const int count = std::min(256, width - x);
        for (int i = 0; i < count; ++i) shifts[static_cast<size_t>(i)] = mask[x + i] ? slow : usual;
        for (size_t c = 0; c < static_cast<size_t>(model.channels); ++c)
          updateRow(planes[c].row(y) + x, shifts.data(), count, model.means[c].row(y) + x,
                    model.variances[c].row(y) + x);
      }
    }
  });
}

void paintMean(const GaussianBackground& model, const Executor& executor,
               std::array<Image<uint8_t>, 3>& planes) {
  for (size_t c = 0; c < static_cast<size_t>(model.channels); ++c)
    planes[c].resize(model.means[c].size());
  forPlaneRows(model, executor, [&](size_t c, int y) {
    const uint16_t* means = model.means[c].row(y);
    for (int x = 0; x < model.means[c].width(); ++x) planes[c].row(y)[x] = meanLevel(means[x]);
  });
}

}  // namespace rg::background
