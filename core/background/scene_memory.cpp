// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/scene_memory.hpp"

#include <algorithm>

namespace rg::background {

void SceneMemory::prepare(const Picture& picture) {
  const int channels = picture.isGrey() ? 1 : 3;
  if (channels == images_.channels && images_.known.size() == picture.size()) return;
  for (int c = 0; c < channels; ++c) images_.seen[static_cast<size_t>(c)].resize(picture.size());
  images_.known.resize(picture.size());
  images_.channels = channels;
  forget();
}

ColourPlanes SceneMemory::planes() const {
  return {images_.seen[images_.channels == 1 ? 0 : 1], images_.seen[0],
          images_.seen[images_.channels == 1 ? 0 : 2]};
}

void SceneMemory::learn(const ColourPlanes& now, const Run& at) {
  const std::array from{now.green, now.red, now.blue};
  for (size_t c = 0; c < static_cast<size_t>(images_.channels); ++c) {
    const uint8_t* row = from[c].row(at.y);
    std::copy(row + at.begin, row + at.end, images_.seen[c].row(at.y) + at.begin);
  }
  std::fill(images_.known.row(at.y) + at.begin, images_.known.row(at.y) + at.end, uint8_t{255});
}

}  // namespace rg::background
