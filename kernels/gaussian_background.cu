// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/models/gaussian_pixel.hpp"
#include "kernels/gaussian_background.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::GaussianPixel;

/// Layers of these kernels are channels.
__global__ void addFrame(const __grid_constant__ Planes picture,
                         const __grid_constant__ GaussianView model) {
  const Point p = pixelOfThread();
  const unsigned c = blockIdx.z;
  if (!isWithin(p, picture.size())) return;
  const uint32_t level = picture.planes[c].at(p.x, p.y);
  model.sums.planes[c].at(p.x, p.y) += level;
  model.squares.planes[c].at(p.x, p.y) += level * level;
}

__device__ void store(const GaussianView& model, unsigned c, Point p, GaussianPixel pixel) {
  model.means.planes[c].at(p.x, p.y) = pixel.mean;
  model.variances.planes[c].at(p.x, p.y) = pixel.variance;
}

__global__ void closeSums(const __grid_constant__ GaussianView model, uint64_t frames) {
  const Point p = pixelOfThread();
  const unsigned c = blockIdx.z;
  if (!isWithin(p, model.means.size())) return;
  store(model, c, p,
        rg::background::trainedPixel(model.sums.planes[c].at(p.x, p.y),
                                     model.squares.planes[c].at(p.x, p.y), frames));
}

__global__ void testPixels(const __grid_constant__ Planes picture,
                           const __grid_constant__ GaussianView model, int threshold,
                           GaussianTests out) {
  const Point p = pixelOfThread();
  if (!isWithin(p, picture.size())) return;
  int farthest = 0;
  uint32_t distance = 0;
  for (int c = 0; c < picture.channels; ++c) {
    const int off =
        rg::background::offMean(picture.planes[c].at(p.x, p.y), model.means.planes[c].at(p.x, p.y));
    farthest = std::max(farthest, off);
    distance += rg::background::distanceOf(off, model.variances.planes[c].at(p.x, p.y));
  }
  out.simple.at(p.x, p.y) = farthest > threshold << 8 ? 255 : 0;
  out.gaussian.at(p.x, p.y) = distance > rg::background::kFarDistance ? 255 : 0;
}

/// Shifts of 0: no turn in this frame.
struct Shifts {
  int usual, slow;
};

__global__ void updatePixels(const __grid_constant__ Planes picture,
                             ImageView<const uint8_t> foreground, Shifts shifts,
                             const __grid_constant__ GaussianView model) {
  const Point p = pixelOfThread();
  const unsigned c = blockIdx.z;
  if (!isWithin(p, picture.size())) return;
  const int shift = foreground.at(p.x, p.y) != 0 ? shifts.slow : shifts.usual;
  if (shift == 0) return;
  const GaussianPixel before{model.means.planes[c].at(p.x, p.y),
                             model.variances.planes[c].at(p.x, p.y)};
  store(model, c, p, rg::background::updatedPixel(before, picture.planes[c].at(p.x, p.y), shift));
}

__global__ void paintMeans(const __grid_constant__ GaussianView model,
                           const __grid_constant__ PlaneTargets out) {
  const Point p = pixelOfThread();
  const unsigned c = blockIdx.z;
  if (isWithin(p, out.size()))
    out.planes[c].at(p.x, p.y) = rg::background::meanLevel(model.means.planes[c].at(p.x, p.y));
}

/// A thread for each channel of each pixel.
Launch overChannels(const char* name, Size size, int channels, const Work& each) {
  const double values = static_cast<double>(size.area()) * channels;
  return launchOver(name, size, static_cast<unsigned>(channels),
                    {each.bytes * values, each.operations * values});
}

}  // namespace

void train(const Planes& picture, const GaussianView& model, Stream stream) {
  start(overChannels("train", picture.size(), picture.channels, {17, 3}), stream, addFrame, picture,
        model);
}

void finishTraining(int trainedFrames, const GaussianView& model, Stream stream) {
  start(overChannels("finishTraining", model.means.size(), model.means.channels, {12, 100}), stream,
        closeSums, model, static_cast<uint64_t>(trainedFrames));
}

void testGaussian(const Planes& picture, const GaussianView& model, int threshold,
                  const GaussianTests& out, Stream stream) {
  const auto pixels = static_cast<double>(picture.size().area());
  start(launchOver("testGaussian", picture.size(), 1,
                   {(5.0 * picture.channels + 2) * pixels, 25.0 * picture.channels * pixels}),
        stream, testPixels, picture, model, threshold, out);
}

void updateGaussian(const Planes& picture, ImageView<const uint8_t> foreground,
                    const rg::background::UpdateRates& rates, const GaussianView& model,
                    Stream stream) {
  const Shifts shifts{rg::background::shiftNow(rates.usual, rates.frame),
                      rg::background::shiftNow(rates.slow, rates.frame)};
  start(overChannels("updateGaussian", picture.size(), picture.channels, {10, 14}), stream,
        updatePixels, picture, foreground, shifts, model);
}

void paintMean(const GaussianView& model, const PlaneTargets& out, Stream stream) {
  start(overChannels("paintMean", out.size(), out.channels, {3, 3}), stream, paintMeans, model,
        out);
}

}  // namespace rg::gpu::background
