// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/models/consensus_turns.hpp"
#include "core/base/pixel.hpp"
#include "kernels/model_pixels.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::kSamples;

constexpr int kTileWidth = static_cast<int>(kTile.x) + 2;
constexpr int kTileHeight = static_cast<int>(kTile.y) + 2;

/// Loads a block's pixels and those around it, `width` of a row, to tile[from …]; beyond the frame
/// its border is repeated.
template <int width, class Tile>
__device__ void loadTile(ImageView<const uint8_t> plane, int from, Tile& tile) {
  const int left = static_cast<int>(blockIdx.x) * (width - 2) - 1;
  const int top = static_cast<int>(blockIdx.y * kTile.y) - 1;
  for (int i = threadOfBlock(); i < width * kTileHeight; i += kTile.x * kTile.y) {
    const int x = i % width, y = i / width;
    if (isMutated(Mutant::StaleHalo) && x == width - 1) continue;
    tile[from + i] = plane.at(std::clamp(left + x, 0, plane.width() - 1),
                              std::clamp(top + y, 0, plane.height() - 1));
  }
}

/// The level of a column whose sum by 1 2 1 is `middle`, of those beside it.
__device__ uint8_t smoothed(int left, int middle, int right) {
  return static_cast<uint8_t>(roundShift(left + 2 * middle + right, 4));
}

__global__ void smoothTiles(const __grid_constant__ Planes picture,
                            const __grid_constant__ PlaneTargets out) {
  RG_SHARED(uint8_t, tile, kTileWidth * kTileHeight);
  loadTile<kTileWidth>(picture.planes[blockIdx.z], 0, tile);
  if (!isMutated(Mutant::MissingBarrier)) __syncthreads();
  const Point p = pixelOfThread();
  if (!isWithin(p, out.size())) return;
  const int at =
      (static_cast<int>(threadIdx.y) + 1) * kTileWidth + static_cast<int>(threadIdx.x) + 1;
  const auto sum = [&](int i) { return tile[i - kTileWidth] + 2 * tile[i] + tile[i + kTileWidth]; };
  out.planes[blockIdx.z].at(p.x, p.y) = smoothed(sum(at - 1), sum(at), sum(at + 1));
}

/// A thread for each column of the words, also of those beyond the width.
__global__ void fillSamples(const __grid_constant__ Planes picture,
                            const __grid_constant__ ModelView model) {
  const Point p = pixelOfThread();
  const Size size = picture.size();
  if (!isWithin(p, {wordsOf(size.width) * kWordColumns, size.height})) return;
  if (p.x < size.width) {
    model.noise.at(p.x, p.y) = 8;
    model.unrest.at(p.x, p.y) = 0;
  }
  for (int k = 0; k < kSamples; ++k) {
    const Point offset = rg::background::fillOffset(k);
    const int x = std::clamp(p.x + offset.x, 0, size.width - 1);
    const int y = std::clamp(p.y + offset.y, 0, size.height - 1);
    for (int c = 0; c < model.channels; ++c) *model.sample(p, k, c) = picture.planes[c].at(x, y);
  }
}

/// Four columns are looked at together, each in a byte; so half a warp has a word of 64 columns.
constexpr int kQuad = 4, kHalfWarp = 16;

struct Quads {
  unsigned pixels[3];
  unsigned radius, far, faint;
};

/// Of a place whose pixels are known.
__device__ void setRadii(const ModelView& model, const rg::background::Tolerance& tolerance,
                         Point p, Quads& quads) {
  const unsigned noise = loadQuad(model.noise.row(p.y) + p.x);
  const unsigned unrest = loadQuad(model.unrest.row(p.y) + p.x);
  for (int i = 0; i < 32; i += 8) {
    const auto byteOf = [i](unsigned quad) { return static_cast<int>(quad >> i & 255); };
    const int brightness = byteOf(quads.pixels[0]) * tolerance.brightness >> 8;
    const int radius =
        rg::background::radiusOf(tolerance.least + brightness, byteOf(noise), byteOf(unrest));
    quads.radius |= static_cast<unsigned>(radius) << i;
    quads.far |= static_cast<unsigned>(rg::background::farRadius(radius)) << i;
    quads.faint |= static_cast<unsigned>(rg::background::faintRadius(radius)) << i;
  }
}

__device__ unsigned distanceTo(const uint8_t* sample, const Quads& quads, int channels) {
  unsigned most = 0;
  for (int c = 0; c < 3; ++c)
    if (c < channels)
      most = __vmaxu4(most, __vabsdiffu4(quads.pixels[c], loadQuad(sample + c * kWordColumns)));
  return most;
}

/// The distance to the second nearest sample. The warp stops as soon as no sample could make
/// background of any of its pixels; so most samples are never read.
__device__ unsigned secondDistance(const ModelView& model, const Quads& quads, Point p,
                                   bool isInside) {
  unsigned nearest = ~0u, second = ~0u;
  const uint8_t* sample = isInside ? model.sample(p, 0, 0) : nullptr;
  for (int k = 0; k < kSamples; ++k, sample += model.channels * kWordColumns) {
    if (isInside) {
      const unsigned d = distanceTo(sample, quads, model.channels);
      second = __vminu4(second, __vmaxu4(nearest, d));
      nearest = __vminu4(nearest, d);
    }
    if (__all_sync(kFullWarp, !isInside || __vcmpgtu4(second, quads.faint) == 0)) break;
  }
  return second;
}

/// Word of half a warp whose lanes know four columns each, a byte each: 255 is set.
__device__ uint64_t packQuads(unsigned isSet) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  // One bit of each byte, brought together by the sum of the bytes.
  const unsigned four = (isSet & 0x08040201u) * 0x01010101u >> 24;
  unsigned eight = four << kQuad * (lane % 8);
  for (int i = 1; i < 8; i *= 2) eight |= __shfl_xor_sync(kFullWarp, eight, i);
  const unsigned other = __shfl_xor_sync(kFullWarp, eight, 8);
  return uint64_t{eight} | uint64_t{other} << 32;
}

/// The word of half a warp, and the first of the four columns of a thread.
struct QuadPlace {
  int word;
  Point at;
  bool isInside;
};
__device__ QuadPlace placeOfQuad(Size size) {
  const int lane = static_cast<int>(threadIdx.x);
  const int word = static_cast<int>(blockIdx.x) * 2 + lane / kHalfWarp;
  const Point at{word * kWordColumns + lane % kHalfWarp * kQuad,
                 static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y)};
  return {word, at, word < wordsOf(size.width) && at.y < size.height};
}

/// All of the warp must call.
__device__ void judgeQuads(const ModelView& model, const rg::background::Tolerance& tolerance,
                           const QuadPlace& place, Quads& quads, const VerdictTargets& out) {
  if (place.isInside) setRadii(model, tolerance, place.at, quads);
  const unsigned second = secondDistance(model, quads, place.at, place.isInside);
  const unsigned isRaw = __vcmpgtu4(second, quads.radius);
  const uint64_t raw = packQuads(isRaw);
  const uint64_t strong = packQuads(isRaw & __vcmpgtu4(second, quads.far));
  const uint64_t faint = packQuads(__vcmpgtu4(second, quads.faint));
  if (!place.isInside || static_cast<int>(threadIdx.x) % kHalfWarp != 0) return;
  const uint64_t columns = columnsOf(model.size.width, place.word);
  out.raw.words.at(place.word, place.at.y) = raw & columns;
  out.strong.words.at(place.word, place.at.y) = strong & columns;
  out.faint.words.at(place.word, place.at.y) = faint & columns;
}

__global__ void judgeWords(const __grid_constant__ Planes picture,
                           const __grid_constant__ ModelView model,
                           rg::background::Tolerance tolerance, VerdictTargets out) {
  const QuadPlace place = placeOfQuad(model.size);
  Quads quads{};
  for (int c = 0; c < 3; ++c)
    if (place.isInside && c < model.channels)
      quads.pixels[c] = loadQuad(picture.planes[c].row(place.at.y) + place.at.x);
  judgeQuads(model, tolerance, place, quads, out);
}

/// Four smoothed columns of a tile.
constexpr int kJudgedWidth = 2 * kWordColumns + 2;
template <class Tile>
__device__ unsigned smoothedQuad(Tile& tile, int at) {
  const auto sum = [&](int i) {
    return tile[i - kJudgedWidth] + 2 * tile[i] + tile[i + kJudgedWidth];
  };
  int before = sum(at - 1), here = sum(at);
  unsigned quad = 0;
  for (int i = 0; i < kQuad; ++i) {
    const int after = sum(at + i + 1);
    quad |= static_cast<unsigned>(smoothed(before, here, after)) << 8 * i;
    before = here;
    here = after;
  }
  return quad;
}

__global__ void smoothAndJudgeWords(const __grid_constant__ Planes picture,
                                    const __grid_constant__ ModelView model,
                                    rg::background::Tolerance tolerance,
                                    const __grid_constant__ JudgedPicture out) {
  constexpr int kPlane = kJudgedWidth * kTileHeight;
  RG_SHARED(uint8_t, tile, 3 * kPlane);
  for (int c = 0; c < 3; ++c)
    if (c < model.channels) loadTile<kJudgedWidth>(picture.planes[c], c * kPlane, tile);
  __syncthreads();
  const QuadPlace place = placeOfQuad(model.size);
  const int at = (static_cast<int>(threadIdx.y) + 1) * kJudgedWidth +
                 static_cast<int>(threadIdx.x) * kQuad + 1;
  Quads quads{};
  for (int c = 0; c < 3; ++c) {
    if (c >= model.channels) break;
    quads.pixels[c] = smoothedQuad(tile, c * kPlane + at);
    for (int i = 0; i < kQuad; ++i)
      if (place.isInside && place.at.x + i < model.size.width)
        out.picture.planes[c].at(place.at.x + i, place.at.y) =
            static_cast<uint8_t>(quads.pixels[c] >> 8 * i);
  }
  judgeQuads(model, tolerance, place, quads, out.verdicts);
}

__global__ void replaceSamples(BitView places, const __grid_constant__ Planes picture,
                               const __grid_constant__ ModelView model) {
  const Point p = pixelOfThread();
  if (!isWithin(p, model.size) || !isSet(places, p.x, p.y)) return;
  for (int k = 0; k < kSamples; ++k)
    for (int c = 0; c < model.channels; ++c)
      *model.sample(p, k, c) = picture.planes[c].at(p.x, p.y);
}

/// places without words: everywhere.
__global__ void paintSamples(BitView places, const __grid_constant__ ModelView model,
                             const __grid_constant__ PlaneTargets out) {
  const Point p = pixelOfThread();
  if (!isWithin(p, model.size)) return;
  if (places.words.data != nullptr && places.words.at(p.x / kWordColumns, p.y) == 0) return;
  for (int c = 0; c < model.channels; ++c)
    out.planes[c].at(p.x, p.y) = static_cast<uint8_t>(modelledLevel(model, p, c));
}

double bytesOf(Size size, int channels) {
  return static_cast<double>(size.area()) * channels;
}

}  // namespace

void smooth(const Planes& picture, const PlaneTargets& out, Stream stream) {
  const double bytes = bytesOf(picture.size(), picture.channels);
  start(launchOver("smooth", picture.size(), static_cast<unsigned>(picture.channels),
                   {2 * bytes, 9 * bytes}),
        stream, smoothTiles, picture, out);
}

void fillFrom(const Planes& picture, const ModelView& model, Stream stream) {
  const double bytes = bytesOf(model.size, model.channels);
  const Size columns{wordsOf(model.size.width) * kWordColumns, model.size.height};
  start(launchOver("fillFrom", columns, 1, {(1 + kSamples) * bytes, kSamples * bytes}), stream,
        fillSamples, picture, model);
}

namespace {

/// Where nothing moves, three samples are looked at: see secondDistance().
constexpr double kUsualSamples = 3;

Launch overQuads(const char* name, const ModelView& model, double planesMoved, double each) {
  const double bytes = bytesOf(model.size, model.channels);
  const auto pixels = static_cast<double>(model.size.area());
  const Size halves{(model.size.width + 1) / 2, model.size.height};
  return launchOverWords(name, halves,
                         {(planesMoved + kUsualSamples) * bytes + 2.4 * pixels,
                          (kUsualSamples * 5 / 4 + each) * bytes});
}

}  // namespace

void judge(const Planes& picture, const ModelView& model,
           const rg::background::Tolerance& tolerance, const VerdictTargets& out, Stream stream) {
  start(overQuads("judge", model, 1, 0), stream, judgeWords, picture, model, tolerance, out);
}

void smoothAndJudge(const Planes& picture, const ModelView& model,
                    const rg::background::Tolerance& tolerance, const JudgedPicture& out,
                    Stream stream) {
  start(overQuads("smoothAndJudge", model, 2, 9), stream, smoothAndJudgeWords, picture, model,
        tolerance, out);
}

void replaceWhere(const BitView& places, const Planes& picture, const ModelView& model,
                  Stream stream) {
  const auto pixels = static_cast<double>(model.size.area());
  start(launchOver("replaceWhere", model.size, 1, {pixels / 8, 2 * pixels}), stream, replaceSamples,
        places, picture, model);
}

void paintModel(const ModelView& model, const PlaneTargets& out, Stream stream) {
  const double bytes = bytesOf(model.size, model.channels);
  start(launchOver("paintModel", model.size, 1, {5 * bytes, 6 * bytes}), stream, paintSamples,
        BitView{}, model, out);
}

void paintModelAt(const BitView& places, const ModelView& model, const PlaneTargets& out,
                  Stream stream) {
  const auto pixels = static_cast<double>(model.size.area());
  start(launchOver("paintModelAt", model.size, 1, {pixels / 8, 2 * pixels}), stream, paintSamples,
        places, model, out);
}

}  // namespace rg::gpu::background
