// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/dispatcher.hpp"

#include "kernels/runtime.hpp"

namespace rg::gpu {
namespace {

size_t bytesOf(const BitView& mask) {
  return static_cast<size_t>(mask.words.strideBytes) * static_cast<size_t>(mask.words.height());
}

}  // namespace

ComponentsView Dispatcher::components(Size size) const {
  const int64_t runs = mostRuns(size);
  const int words = wordsOf(size.width) * size.height;
  return {scratch().take<ComponentRun>(runs),
          scratch().take<Component>(runs),
          scratch().take<uint32_t>(runs),
          scratch().take<uint32_t>(runs),
          scratch().take<uint32_t>(words + 1),
          scratch().take<uint32_t>(words + 1),
          scratch().take<uint32_t>(scanScratchOf(words))};
}

BitTarget Dispatcher::scratchMask(Size size) const {
  constexpr int kAlignedWords = 8;
  const Size words{wordsOf(size.width), size.height};
  const int stride = (words.width + kAlignedWords - 1) / kAlignedWords * kAlignedWords;
  return {{scratch().take<uint64_t>(int64_t{stride} * size.height), words,
           ptrdiff_t{stride} * static_cast<ptrdiff_t>(sizeof(uint64_t))},
          size};
}

PlaneTargets Dispatcher::scratchPlanes(Size size, int channels) const {
  PlaneTargets planes{{}, channels};
  for (int c = 0; c < channels; ++c) planes.planes[c] = scratchPlane<uint8_t>(size);
  return planes;
}

BitTarget Dispatcher::copyOf(const BitView& mask) const {
  const BitTarget copied = scratchMask(mask.size);
  copy(mask, copied);
  return copied;
}

void Dispatcher::copy(const BitView& from, const BitTarget& to) const {
  runtime::copy(to.words.data, from.words.data, bytesOf(from), stream());
}

void Dispatcher::clear(ImageView<uint8_t> plane) const {
  runtime::clear(plane.data,
                 static_cast<size_t>(plane.strideBytes) * static_cast<size_t>(plane.height()),
                 stream());
}

void Dispatcher::send(void* to, const void* from, size_t bytes) const {
  device_.lane()->staging().upload(to, from, bytes);
}

void Dispatcher::fetch(void* to, const void* from, size_t bytes) const {
  device_.lane()->staging().download({{to, from, bytes}});
}

}  // namespace rg::gpu
