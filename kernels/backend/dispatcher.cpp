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
          scratch().take<uint32_t>(scanScratchOf(words) + 1)};
}

BitTarget Dispatcher::copyOf(const BitView& mask) const {
  auto* words = scratch().take<uint64_t>(static_cast<int64_t>(bytesOf(mask) / sizeof(uint64_t)));
  const BitTarget copied{{words, mask.words.size, mask.words.strideBytes}, mask.size};
  copy(mask, copied);
  return copied;
}

void Dispatcher::copy(const BitView& from, const BitTarget& to) const {
  runtime::copy(to.words.data, from.words.data, bytesOf(from), stream());
}

}  // namespace rg::gpu
