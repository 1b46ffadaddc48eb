// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/models/consensus_turns.hpp"
#include "core/base/pixel.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::kSamples;

constexpr int kTileWidth = static_cast<int>(kTile.x) + 2;
constexpr int kTileHeight = static_cast<int>(kTile.y) + 2;

/// Loads a block's pixels and those around it; beyond the frame its border is repeated.
template <class Tile>
__device__ void loadTile(ImageView<const uint8_t> plane, Tile& tile) {
  const int left = static_cast<int>(blockIdx.x * kTile.x) - 1;
  const int top = static_cast<int>(blockIdx.y * kTile.y) - 1;
  for (int i = threadOfBlock(); i < kTileWidth * kTileHeight; i += kTile.x * kTile.y) {
    const int x = i % kTileWidth, y = i / kTileWidth;
    if (isMutated(Mutant::StaleHalo) && x == kTileWidth - 1) continue;
    tile[i] = plane.at(std::clamp(left + x, 0, plane.width() - 1),
                       std::clamp(top + y, 0, plane.height() - 1));
  }
}

__global__ void smoothTiles(const __grid_constant__ Planes picture,
                            const __grid_constant__ PlaneTargets out) {
  RG_SHARED(uint8_t, tile, kTileWidth * kTileHeight);
  loadTile(picture.planes[blockIdx.z], tile);
  if (!isMutated(Mutant::MissingBarrier)) __syncthreads();
  const Point p = pixelOfThread();
  if (!isWithin(p, out.size())) return;
  const int at =
      (static_cast<int>(threadIdx.y) + 1) * kTileWidth + static_cast<int>(threadIdx.x) + 1;
  const auto sum = [&](int i) { return tile[i - kTileWidth] + 2 * tile[i] + tile[i + kTileWidth]; };
  out.planes[blockIdx.z].at(p.x, p.y) =
      static_cast<uint8_t>(roundShift(sum(at - 1) + 2 * sum(at) + sum(at + 1), 4));
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

__device__ Quads loadQuads(const Planes& picture, const ModelView& model,
                           const rg::background::Tolerance& tolerance, Point p) {
  Quads quads{};
  for (int c = 0; c < 3; ++c)
    if (c < model.channels) quads.pixels[c] = loadQuad(picture.planes[c].row(p.y) + p.x);
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
  return quads;
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

__global__ void judgeWords(const __grid_constant__ Planes picture,
                           const __grid_constant__ ModelView model,
                           rg::background::Tolerance tolerance, VerdictTargets out) {
  const int lane = static_cast<int>(threadIdx.x);
  const int word = static_cast<int>(blockIdx.x) * 2 + lane / kHalfWarp;
  const Point p{word * kWordColumns + lane % kHalfWarp * kQuad,
                static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y)};
  const bool isInside = word < wordsOf(model.size.width) && p.y < model.size.height;
  const Quads quads = isInside ? loadQuads(picture, model, tolerance, p) : Quads{};
  const unsigned second = secondDistance(model, quads, p, isInside);
  const unsigned isRaw = __vcmpgtu4(second, quads.radius);
  const uint64_t raw = packQuads(isRaw);
  const uint64_t strong = packQuads(isRaw & __vcmpgtu4(second, quads.far));
  const uint64_t faint = packQuads(__vcmpgtu4(second, quads.faint));
  if (!isInside || lane % kHalfWarp != 0) return;
  const uint64_t columns = columnsOf(model.size.width, word);
  out.raw.words.at(word, p.y) = raw & columns;
  out.strong.words.at(word, p.y) = strong & columns;
  out.faint.words.at(word, p.y) = faint & columns;
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
  for (int c = 0; c < model.channels; ++c) {
    int sum = 0;
    for (int k = 0; k < kSamples; k += kSamples / 4) sum += *model.sample(p, k, c);
    out.planes[c].at(p.x, p.y) = static_cast<uint8_t>(roundShift(sum, 2));
  }
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

void judge(const Planes& picture, const ModelView& model,
           const rg::background::Tolerance& tolerance, const VerdictTargets& out, Stream stream) {
  // Where nothing moves, three samples are looked at: see secondDistance().
  constexpr double kUsualSamples = 3;
  const double bytes = bytesOf(model.size, model.channels);
  const auto pixels = static_cast<double>(model.size.area());
  const Size halves{(model.size.width + 1) / 2, model.size.height};
  start(
      launchOverWords("judge", halves,
                      {(1 + kUsualSamples) * bytes + 2.4 * pixels, kUsualSamples * 5 * bytes / 4}),
      stream, judgeWords, picture, model, tolerance, out);
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
