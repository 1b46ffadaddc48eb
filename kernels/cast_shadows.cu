// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/cast_shadows.hpp"
#include "kernels/start.hpp"
#include "kernels/word_runs.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::DarkPart;

struct Shadows {
  BitView mask, dark;

  /// Foreground that is not darkened; nothing outside of the picture.
  __device__ uint64_t solidAt(int x, int y) const {
    return isOutside(x, y) ? 0 : mask.words.at(x, y) & ~dark.words.at(x, y);
  }
  __device__ uint64_t freeAt(int x, int y) const {
    return isOutside(x, y) ? 0 : ~mask.words.at(x, y) & columnsOf(mask.size.width, x);
  }
  __device__ bool isSolid(int x, int y) const {
    return y >= 0 && y < mask.size.height &&
           (solidAt(x / kWordColumns, y) >> x % kWordColumns & 1) != 0;
  }

 private:
  __device__ bool isOutside(int x, int y) const {
    return !boundsOf(mask.words.size).contains({x, y});
  }
};

/// How many sides the pixels of `bits` share with those of what is at (x, y) and around it.
template <class WordAt>
__device__ uint32_t contactsOf(uint64_t bits, Point at, const WordAt& wordAt) {
  constexpr int kLast = kWordColumns - 1;
  const uint64_t here = wordAt(at.x, at.y);
  const uint64_t fromLeft = here << 1 | wordAt(at.x - 1, at.y) >> kLast;
  const uint64_t fromRight = here >> 1 | wordAt(at.x + 1, at.y) << kLast;
  return static_cast<uint32_t>(__popcll(bits & fromLeft) + __popcll(bits & fromRight) +
                               __popcll(bits & wordAt(at.x, at.y - 1)) +
                               __popcll(bits & wordAt(at.x, at.y + 1)));
}

/// Of the vertical runs that begin in `tops`, those with solid foreground above and below.
__device__ uint32_t enclosedColumns(const Shadows& shadows, Point at, uint64_t tops) {
  uint32_t enclosed = 0;
  for (uint64_t left = tops & shadows.solidAt(at.x, at.y - 1); left != 0; left &= left - 1) {
    const int x = at.x * kWordColumns + __ffsll(static_cast<long long>(left)) - 1;
    int end = at.y;
    while (end < shadows.mask.size.height && isSet(shadows.dark, x, end)) ++end;
    enclosed += shadows.isSolid(x, end);
  }
  return enclosed;
}

__global__ void readParts(Shadows shadows, CastShadowView scratch) {
  const WordOfThread word = wordOfThread(shadows.dark.words.size);
  if (!word.isInside) return;
  const Point at = word.at;
  const uint64_t above = at.y > 0 ? shadows.dark.words.at(at.x, at.y - 1) : 0;
  forRunsIn(scratch.found, word, [&](uint32_t run, uint64_t bits) {
    DarkPart& part = scratch.darkParts[scratch.found.runs[run].component];
    const auto solid = [&](int x, int y) { return shadows.solidAt(x, y); };
    const auto free = [&](int x, int y) { return shadows.freeAt(x, y); };
    const uint64_t tops = bits & ~above;
    atomicAdd(&part.columns, static_cast<uint32_t>(__popcll(tops)));
    atomicAdd(&part.enclosedColumns, enclosedColumns(shadows, at, tops));
    atomicAdd(&part.solidContacts, contactsOf(bits, at, solid));
    atomicAdd(&part.freeContacts, contactsOf(bits, at, free));
  });
}

__global__ void countDark(BitView dark, CastShadowView scratch) {
  const WordOfThread word = wordOfThread(dark.words.size);
  if (!word.isInside) return;
  const uint64_t columns = dark.words.at(word.at.x, word.at.y);
  if (columns == 0) return;
  forRunsIn(scratch.found, word, [&](uint32_t run, uint64_t bits) {
    const auto count = static_cast<uint32_t>(__popcll(columns & bits));
    if (count != 0) atomicAdd(scratch.darkOf + scratch.found.runs[run].component, count);
  });
}

struct IsNoShadow {
  const DarkPart* parts;
  __device__ bool operator()(const ComponentsView&, uint32_t part) const {
    return !rg::background::isCast(parts[part]);
  }
};
struct IsMostlyDark {
  const uint32_t* darkOf;
  __device__ bool operator()(const ComponentsView& found, uint32_t object) const {
    return rg::background::isMostlyDark(darkOf[object], found.list[object].areaPx);
  }
};

}  // namespace

void keepCastShadows(const BitView& mask, const BitTarget& dark, const CastShadowView& scratch,
                     Stream stream) {
  const Size words = mask.words.size;
  findComponents(dark, true, Connectivity::Four, scratch.found, stream);
  start(overWords("forgetParts", mask, 4), stream, forgetParts<DarkPart>, words, scratch.found,
        scratch.darkParts);
  start(overWords("readParts", mask, 40), stream, readParts, Shadows{mask, dark}, scratch);
  start(overWords("dropNoShadows", mask, 8), stream, changeParts<IsNoShadow>, dark, false,
        IsNoShadow{scratch.darkParts}, scratch.found);
  findComponents(mask, true, Connectivity::Eight, scratch.found, stream);
  start(overWords("forgetParts", mask, 4), stream, forgetParts<uint32_t>, words, scratch.found,
        scratch.darkOf);
  start(overWords("countDark", mask, 12), stream, countDark, BitView(dark), scratch);
  start(overWords("dropDarkObjects", mask, 8), stream, changeParts<IsMostlyDark>, dark, false,
        IsMostlyDark{scratch.darkOf}, scratch.found);
}

}  // namespace rg::gpu::background
