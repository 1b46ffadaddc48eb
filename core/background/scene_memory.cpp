// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/scene_memory.hpp"

#include <algorithm>

namespace rg::background {

void SceneMemory::prepare(const Picture& picture) {
  const int channels = picture.isGrey() ? 1 : 3;
  if (channels == channels_ && known_.size() == picture.size()) return;
  for (int c = 0; c < channels; ++c) seen_[static_cast<size_t>(c)].resize(picture.size());
  known_.resize(picture.size());
  channels_ = channels;
  forget();
}

ColourPlanes SceneMemory::planes() const {
  return {seen_[channels_ == 1 ? 0 : 1], seen_[0], seen_[channels_ == 1 ? 0 : 2]};
}

void SceneMemory::learn(const ColourPlanes& now, const Run& at) {
  const std::array from{now.green, now.red, now.blue};
  for (size_t c = 0; c < static_cast<size_t>(channels_); ++c) {
    const uint8_t* row = from[c].row(at.y);
    std::copy(row + at.begin, row + at.end, seen_[c].row(at.y) + at.begin);
  }
  std::fill(known_.row(at.y) + at.begin, known_.row(at.y) + at.end, uint8_t{255});
}

}  // namespace rg::background
