// SPDX-License-Identifier: LGPL-2.1-or-later
// In place of clip_scene.cpp where there is no OpenCV to decode a clip.
#include "tests/benchmarks/scene.hpp"

namespace rg::bench {

std::string findClip() {
  return {};
}

Result<std::unique_ptr<FrameSource>> openClip(const std::string& path, Size) {
  return Error{path + " can't be decoded: built without OpenCV"};
}

Result<std::unique_ptr<FrameSource>> openVideo(const std::string& path) {
  return openClip(path, {});
}

}  // namespace rg::bench
