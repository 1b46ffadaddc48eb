// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/bit_mask.hpp"
#include "kernels/block_reduce.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu {
namespace {

__global__ void packWords(ImageView<const uint8_t> bytes, uint8_t value, BitTarget mask) {
  const Point at = wordOfWarp();
  const auto isEqual = [&](int lane) {
    const Point p{at.x * kWordColumns + lane, at.y};
    return isWithin(p, bytes.size) && bytes.at(p.x, p.y) == value;
  };
  const int lane = static_cast<int>(threadIdx.x);
  const uint64_t word = packWord(isEqual(lane), isEqual(lane + kWarp));
  if (lane == 0 && at.y < mask.size.height) mask.words.at(at.x, at.y) = word;
}

__global__ void countWords(BitView mask, uint32_t* count) {
  RG_SHARED(uint32_t, values, kReduceWarps);
  const auto words = static_cast<int>(mask.words.size.area());
  const auto stride = static_cast<int>(gridDim.x) * kReduceThreads;
  uint32_t own = 0;
  for (int i = indexInGrid(); i < words; i += stride)
    own += static_cast<uint32_t>(
        __popcll(mask.words.at(i % mask.words.width(), i / mask.words.width())));
  own = reduceBlock(own, values, [](uint32_t a, uint32_t b) { return a + b; });
  if (threadIdx.x == 0) atomicAdd(count, own);
}

__global__ void keepPixelsInside(ImageView<const uint8_t> interest, ImageView<uint8_t> scope) {
  const Point p = pixelOfThread();
  if (isWithin(p, scope.size)) scope.at(p.x, p.y) &= interest.at(p.x, p.y);
}

__global__ void paintPixels(BitView mask, uint8_t value, ImageView<uint8_t> bytes) {
  const Point p = pixelOfThread();
  if (isWithin(p, bytes.size) && isSet(mask, p.x, p.y)) bytes.at(p.x, p.y) = value;
}

enum class Change : uint8_t { Remove, KeepOnly, Add };

/// A thread for each word.
__global__ void changeWords(BitView b, BitTarget a, Change change) {
  const Point at = pixelOfThread();
  if (!isWithin(at, a.words.size)) return;
  const uint64_t other = b.words.at(at.x, at.y);
  uint64_t& word = a.words.at(at.x, at.y);
  word =
      change == Change::Add ? word | other : word & (change == Change::KeepOnly ? other : ~other);
}

/// What is at most `margin` columns from a bit of the words before, here and after.
__device__ uint64_t thickened(uint64_t before, uint64_t here, uint64_t after, int margin) {
  uint64_t thick = here;
  for (int i = 1; i <= margin; ++i) {
    thick |= here << i | before >> (kWordColumns - i);
    thick |= here >> i | after << (kWordColumns - i);
  }
  return thick;
}

/// The rows come together first: so each word is thickened once.
__global__ void thickenWords(BitView mask, int margin, BitTarget out) {
  const Point at = pixelOfThread();
  if (!isWithin(at, out.words.size)) return;
  uint64_t words[3] = {};
  const int bottom = std::min(mask.size.height - 1, at.y + margin);
  for (int y = std::max(0, at.y - margin); y <= bottom; ++y)
    for (int i = 0; i < 3; ++i) {
      const int word = at.x + i - 1;
      if (word >= 0 && word < mask.words.width()) words[i] |= mask.words.at(word, y);
    }
  const uint64_t columns = columnsOf(mask.size.width, at.x);
  out.words.at(at.x, at.y) = thickened(words[0], words[1], words[2], margin) & columns;
}

double bytesOf(const BitView& mask) {
  return static_cast<double>(mask.words.size.area()) * 8;
}

}  // namespace

void countSet(const BitView& mask, uint32_t* count, Stream stream) {
  constexpr unsigned kWordsOfThread = 8;
  const auto blocks = blocksFor(mask.words.size.area(), kReduceThreads * kWordsOfThread);
  clear(count, sizeof *count, stream);
  start({"countSet",
         {std::min(blocks, kMostBlocks), 1, 1},
         {kReduceThreads, 1, 1},
         {bytesOf(mask), bytesOf(mask) / 4}},
        stream, countWords, mask, count);
}

void keepInside(ImageView<const uint8_t> interest, ImageView<uint8_t> scope, Stream stream) {
  const auto pixels = static_cast<double>(scope.size.area());
  start(launchOver("keepInside", scope.size, 1, {3 * pixels, pixels}), stream, keepPixelsInside,
        interest, scope);
}

void packEqual(ImageView<const uint8_t> bytes, uint8_t value, const BitTarget& mask,
               Stream stream) {
  const auto pixels = static_cast<double>(bytes.size.area());
  start(launchOverWords("packEqual", bytes.size, {pixels * 1.125, pixels}), stream, packWords,
        bytes, value, mask);
}

void paint(const BitView& mask, uint8_t value, ImageView<uint8_t> bytes, Stream stream) {
  const auto pixels = static_cast<double>(bytes.size.area());
  start(launchOver("paint", bytes.size, 1, {pixels * 1.125, pixels}), stream, paintPixels, mask,
        value, bytes);
}

namespace {

void changeBy(const char* name, const BitView& b, const BitTarget& a, Change change,
              Stream stream) {
  start(launchOver(name, a.words.size, 1, {3 * bytesOf(a), 0}), stream, changeWords, b, a, change);
}

}  // namespace

void remove(const BitView& b, const BitTarget& a, Stream stream) {
  changeBy("remove", b, a, Change::Remove, stream);
}

void keepOnly(const BitView& b, const BitTarget& a, Stream stream) {
  changeBy("keepOnly", b, a, Change::KeepOnly, stream);
}

void add(const BitView& b, const BitTarget& a, Stream stream) {
  changeBy("add", b, a, Change::Add, stream);
}

void thicken(const BitView& mask, int margin, const BitTarget& out, Stream stream) {
  start(launchOver("thicken", mask.words.size, 1, {2 * bytesOf(mask), bytesOf(mask) * margin}),
        stream, thickenWords, mask, margin, out);
}

}  // namespace rg::gpu
