// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/simd/background/still_rows.hpp"
#include "kernels/bit_mask.hpp"
#include "kernels/ghosts.hpp"
#include "kernels/model_pixels.hpp"
#include "kernels/start.hpp"
#include "kernels/warp_runs.hpp"
#include "kernels/word_runs.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::ContourSums;

/// What is followed: a frame's foreground, and how old its pixels may become.
struct Followed {
  BitView foreground;
  rg::background::Tolerance tolerance;
  int mostAge;
};

__device__ void followPixel(const Planes& picture, const ModelView& model, const Followed& followed,
                            const StillView& still, Point p, bool isForeground) {
  uint16_t& age = still.ages.at(p.x, p.y);
  int off = 0;
  for (int c = 0; c < picture.channels; ++c)
    off = std::max(off,
                   absDiff(picture.planes[c].at(p.x, p.y), still.colours.planes[c].at(p.x, p.y)));
  const int brightness = picture.planes[0].at(p.x, p.y);
  const bool isSame = off <= radiusAt(model, followed.tolerance, brightness, p);
  const int next = rg::background::nextAge(age, isSame, followed.mostAge);
  age = static_cast<uint16_t>(isForeground ? std::max(next, 1) : 0);
  if (!isForeground || next != 0) return;
  for (int c = 0; c < picture.channels; ++c)
    still.colours.planes[c].at(p.x, p.y) = picture.planes[c].at(p.x, p.y);
}

/// A warp for each word: most words are background and were, and only what is fresh fades there.
__global__ void followWords(const __grid_constant__ Planes picture,
                            const __grid_constant__ ModelView model, Followed followed,
                            const __grid_constant__ StillView still) {
  const Point at = wordOfWarp();
  const Size size = picture.size();
  if (at.y >= size.height) return;
  const uint64_t now = followed.foreground.words.at(at.x, at.y);
  const bool isLookedAt = (now | still.aged.words.at(at.x, at.y)) != 0;
  for (int column = static_cast<int>(threadIdx.x); column < kWordColumns; column += kWarp) {
    const Point p{at.x * kWordColumns + column, at.y};
    if (p.x >= size.width) break;
    uint8_t& fresh = still.fresh.at(p.x, p.y);
    if (fresh != 0) --fresh;
    if (isLookedAt) followPixel(picture, model, followed, still, p, (now >> column & 1) != 0);
  }
  __syncwarp();
  if (threadIdx.x == 0) still.aged.words.at(at.x, at.y) = now;
}

/// Sets what is old enough, and leaves what is set unless isAlone.
__global__ void markAged(BitView foreground, ImageView<const uint16_t> ages, int leastAge,
                         bool isAlone, BitTarget places) {
  const Point at = wordOfWarp();
  if (at.y >= foreground.size.height) return;
  const uint64_t bits = foreground.words.at(at.x, at.y);
  const auto isOld = [&](int column) {
    return (bits >> column & 1) != 0 && ages.at(at.x * kWordColumns + column, at.y) >= leastAge;
  };
  const int lane = static_cast<int>(threadIdx.x);
  const uint64_t old = packWord(isOld(lane), isOld(lane + kWarp));
  if (lane == 0) places.words.at(at.x, at.y) = isAlone ? old : places.words.at(at.x, at.y) | old;
}

/// What the contour of a still part is read from.
struct ContourPlanes {
  Planes picture;
  ModelView model;
  BitView foreground, still;
  ImageView<const uint8_t> fresh;
};

/// A side that leads out of the part.
__device__ void addAcross(const ContourPlanes& planes, Point p, Point step, ContourSums& sums) {
  const Point beside{p.x + step.x, p.y + step.y};
  const Point outside{p.x + 2 * step.x, p.y + 2 * step.y};
  const Point inside{p.x - step.x, p.y - step.y};
  const Box bounds = boundsOf(planes.foreground.size);
  if (!bounds.contains(outside) || !bounds.contains(inside)) return;
  ++sums.allPixels;
  if (isSet(planes.foreground, beside.x, beside.y) ||
      isSet(planes.foreground, outside.x, outside.y) || planes.fresh.at(outside.x, outside.y) != 0)
    return;
  const int channels = planes.picture.channels;
  sums.inPicture += rg::background::edgeBetween(
      channels, inside, outside,
      [&](Point at, int channel) { return +planes.picture.planes[channel].at(at.x, at.y); });
  sums.inModel += rg::background::edgeBetween(
      channels, inside, outside,
      [&](Point at, int channel) { return modelledLevel(planes.model, at, channel); });
  ++sums.readPixels;
}

/// A warp for each word, as a side reads much of the model.
__global__ void readContours(const __grid_constant__ ContourPlanes planes, ComponentsView parts,
                             ContourSums* contours) {
  const Size words = planes.still.words.size;
  const Point at = wordOfWarp();
  if (at.y >= words.height) return;
  const auto still = [&](int x, int y) {
    return boundsOf(words).contains({x, y}) ? planes.still.words.at(x, y) : 0;
  };
  constexpr int kLast = kWordColumns - 1;
  const uint64_t here = still(at.x, at.y);
  if (here == 0) return;
  const uint64_t left = here << 1 | still(at.x - 1, at.y) >> kLast;
  const uint64_t right = here >> 1 | still(at.x + 1, at.y) << kLast;
  const uint64_t above = still(at.x, at.y - 1), below = still(at.x, at.y + 1);
  const auto lane = static_cast<int>(threadIdx.x);
  forRunsIn(parts, {at.y * words.width + at.x, at, true}, [&](uint32_t run, uint64_t bits) {
    ContourSums own;
    const auto addSide = [&](uint64_t open, int column, Point step) {
      if ((open >> column & 1) != 0)
        addAcross(planes, {at.x * kWordColumns + column, at.y}, step, own);
    };
    for (int column = lane; column < kWordColumns; column += kWarp) {
      addSide(bits & ~left, column, {-1, 0});
      addSide(bits & ~right, column, {1, 0});
      addSide(bits & ~above, column, {0, -1});
      addSide(bits & ~below, column, {0, 1});
    }
    ContourSums& all = contours[parts.runs[run].component];
    const auto addToAll = [&](int64_t& sum, int64_t value) {
      value = sumOfWarp(value);
      if (lane == 0 && value != 0) addSum(sum, static_cast<uint64_t>(value));
    };
    addToAll(all.inPicture, own.inPicture);
    addToAll(all.inModel, own.inModel);
    addToAll(all.readPixels, own.readPixels);
    addToAll(all.allPixels, own.allPixels);
  });
}

struct IsGhostly {
  const ContourSums* contours;
  __device__ bool operator()(const ComponentsView&, uint32_t part) const {
    return rg::background::isGhostly(contours[part]);
  }
};

void startMarkAged(const char* name, const BitView& foreground, const StillView& still,
                   int leastAge, bool isAlone, const BitTarget& places, Stream stream) {
  const double words = static_cast<double>(foreground.words.size.area());
  const ImageView<const uint16_t> ages = still.ages;
  start(launchOverWords(name, foreground.size, {24 * words, 8 * words}), stream, markAged,
        foreground, ages, leastAge, isAlone, places);
}

}  // namespace

void followStill(const Planes& picture, const ModelView& model,
                 const rg::background::Tolerance& tolerance, const BitView& foreground,
                 uint16_t mostAge, const StillView& still, Stream stream) {
  const auto pixels = static_cast<double>(model.size.area());
  start(launchOverWords("followStill", model.size, {2.4 * pixels, 3 * pixels}), stream, followWords,
        picture, model, Followed{foreground, tolerance, mostAge}, still);
}

void addAged(const BitView& foreground, const StillView& still, int leastAge,
             const BitTarget& places, Stream stream) {
  startMarkAged("addAged", foreground, still, leastAge, false, places, stream);
}

void findGhosts(const Planes& picture, const ModelView& model, const BitView& foreground,
                const StillView& still, int leastAge, const GhostView& scratch,
                const BitTarget& ghosts, Stream stream) {
  const Size words = foreground.words.size;
  startMarkAged("markStill", foreground, still, leastAge, true, scratch.still, stream);
  findComponents(scratch.still, true, Connectivity::Eight, scratch.parts, stream);
  start(overWords("forgetParts", foreground, 4), stream, forgetParts<ContourSums>, words,
        scratch.parts, scratch.contours);
  const double outlineWords = static_cast<double>(words.area());
  start(launchOverWords("readOutlines", foreground.size, {32 * outlineWords, 8 * outlineWords}),
        stream, readContours, ContourPlanes{picture, model, foreground, scratch.still, still.fresh},
        scratch.parts, scratch.contours);
  start(overWords("markGhosts", foreground, 12), stream, markParts<IsGhostly>, ghosts,
        IsGhostly{scratch.contours}, scratch.parts);
  paint(ghosts, rg::background::kFreshFrames, still.fresh, stream);
}

}  // namespace rg::gpu::background
