// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/background.hpp"
#include "kernels/mask_cleaning.hpp"
#include "kernels/start.hpp"
#include "kernels/word_runs.hpp"

namespace rg::gpu::background {
namespace {

constexpr int kMostRadius = 7;
constexpr int kCountRows = static_cast<int>(kTile.y) + 2 * kMostRadius;

/// How many of the columns x − radius … x + radius are set; the row's ends are repeated.
__device__ int countAlong(const uint64_t* row, int width, int x, int radius) {
  const int begin = std::max(0, x - radius), end = std::min(width, x + radius + 1);
  const int word = begin / kWordColumns, first = begin % kWordColumns;
  uint64_t bits = row[word] >> first;
  if (first + end - begin > kWordColumns) bits |= row[word + 1] << (kWordColumns - first);
  int count = __popcll(bits & ((uint64_t{1} << (end - begin)) - 1));
  if (x < radius && (row[0] & 1) != 0) count += radius - x;
  const int last = width - 1;
  if (x + radius > last && (row[last / kWordColumns] >> last % kWordColumns & 1) != 0)
    count += x + radius - last;
  return count;
}

/// Counts along the rows of a block and those above and below it, then down their columns. A warp
/// has a word, a lane two of its columns.
__global__ void keepMajorityOfWords(BitView mask, int radius, int limit, BitTarget out) {
  RG_SHARED(uint8_t, counts, kCountRows * kWordColumns);
  const Point at = wordOfWarp();
  const int lane = static_cast<int>(threadIdx.x), height = mask.size.height;
  const int top = static_cast<int>(blockIdx.y * kTile.y) - radius;
  const int rows = static_cast<int>(kTile.y) + 2 * radius;
  for (int i = threadOfBlock(); i < rows * kWordColumns; i += kTile.x * kTile.y) {
    const int x = std::min(at.x * kWordColumns + i % kWordColumns, mask.size.width - 1);
    const uint64_t* row = mask.words.row(std::clamp(top + i / kWordColumns, 0, height - 1));
    counts[i] = static_cast<uint8_t>(countAlong(row, mask.size.width, x, radius));
  }
  if (!isMutated(Mutant::MissingBarrier)) __syncthreads();
  const auto isMajority = [&](int column) {
    int sum = 0;
    for (int i = 0; i <= 2 * radius; ++i)
      sum += counts[(static_cast<int>(threadIdx.y) + i) * kWordColumns + column];
    return sum > limit;
  };
  const uint64_t word = packWord(isMajority(lane), isMajority(lane + kWarp));
  if (lane == 0 && at.y < height)
    out.words.at(at.x, at.y) = word & columnsOf(mask.size.width, at.x);
}

__global__ void paintPixels(BitView mask, BitView shadow, Point shift, ImageView<uint8_t> out) {
  const Point p = pixelOfThread();
  if (!isWithin(p, out.size)) return;
  const Point from{p.x + shift.x, p.y + shift.y};
  uint8_t value = rg::background::kBackgroundPixel;
  if (boundsOf(out.size).contains(from)) {
    if (isSet(mask, from.x, from.y)) value = rg::background::kForegroundPixel;
    if (isSet(shadow, from.x, from.y)) value = rg::background::kShadowPixel;
  }
  out.at(p.x, p.y) = value;
}

struct IsSmall {
  uint32_t leastPx;
  __device__ bool operator()(const ComponentsView& found, uint32_t part) const {
    return found.list[part].areaPx < leastPx;
  }
};

struct IsHole {
  uint32_t mostPx;
  Size size;
  __device__ bool operator()(const ComponentsView& found, uint32_t part) const {
    const Box& box = found.list[part].box;
    const bool touchesBorder =
        box.x == 0 || box.y == 0 || box.right() == size.width || box.bottom() == size.height;
    return !touchesBorder && found.list[part].areaPx <= mostPx;
  }
};

__global__ void forgetAreas(Size words, ComponentsView found) {
  const WordOfThread word = wordOfThread(words);
  if (!word.isInside) return;
  for (uint32_t i = found.firstRoot[word.index]; i < found.firstRoot[word.index + 1]; ++i)
    found.list[i].areaPx = 0;
}

/// The area is not needed any more: it takes the count of what is strong.
__global__ void countStrong(BitView strong, ComponentsView found) {
  const WordOfThread word = wordOfThread(strong.words.size);
  if (!word.isInside) return;
  const uint64_t columns = strong.words.at(word.at.x, word.at.y);
  if (columns == 0) return;
  forRunsIn(found, word, [&](uint32_t run, uint64_t bits) {
    const auto count = static_cast<uint32_t>(__popcll(columns & bits));
    if (count != 0) atomicAdd(&found.list[found.runs[run].component].areaPx, count);
  });
}

}  // namespace

void keepMajority(const BitView& mask, int radius, int share, const BitTarget& out, Stream stream) {
  const int side = 2 * radius + 1;
  const auto pixels = static_cast<double>(mask.size.area());
  start(launchOverWords("keepMajority", mask.size, {pixels / 4, pixels * (20 + side)}), stream,
        keepMajorityOfWords, mask, radius, side * side * share / 256, out);
}

void dropSmallParts(const BitTarget& mask, uint32_t leastPx, const ComponentsView& scratch,
                    Stream stream) {
  findComponents(mask, true, Connectivity::Four, scratch, stream);
  start(overWords("dropSmallParts", mask, 8), stream, changeParts<IsSmall>, mask, false,
        IsSmall{leastPx}, scratch);
}

void fillHoles(const BitTarget& mask, uint32_t mostPx, const ComponentsView& scratch,
               Stream stream) {
  findComponents(mask, false, Connectivity::Four, scratch, stream);
  start(overWords("fillHoles", mask, 8), stream, changeParts<IsHole>, mask, true,
        IsHole{mostPx, mask.size}, scratch);
}

void keepSupported(const BitTarget& mask, const BitView& strong, uint32_t leastPx,
                   const ComponentsView& scratch, Stream stream) {
  findComponents(mask, true, Connectivity::Eight, scratch, stream);
  start(overWords("forgetAreas", mask, 4), stream, forgetAreas, mask.words.size, scratch);
  start(overWords("countStrong", mask, 12), stream, countStrong, strong, scratch);
  start(overWords("keepSupported", mask, 8), stream, changeParts<IsSmall>, mask, false,
        IsSmall{leastPx}, scratch);
}

void paintForeground(const BitView& mask, const BitView& shadow, Point shift,
                     ImageView<uint8_t> out, Stream stream) {
  const auto pixels = static_cast<double>(out.size.area());
  start(launchOver("paintForeground", out.size, 1, {1.25 * pixels, 4 * pixels}), stream,
        paintPixels, mask, shadow, shift, out);
}

}  // namespace rg::gpu::background
