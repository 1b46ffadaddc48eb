// SPDX-License-Identifier: LGPL-2.1-or-later
// A scene as bgremove sees it, for tests of the stages behind.
#pragma once

#include "core/segmentation/segmentation.hpp"
#include "tests/core/staged_scene.hpp"

#include <memory>
#include <utility>

namespace rg::test {

/// What is looked at.
struct Watched {
  bool isAll = true;  ///< False: a part is left out.
  bool isGrey = false;
};

/// A walker before a wall after `steps` frames.
inline std::shared_ptr<const background::Foreground> walkerSeen(
    int steps, const Watched& watched, const std::shared_ptr<Device>& device = nullptr) {
  background::Params params;
  params.trainingFrames = 2;
  if (!watched.isAll) {
    auto interest = std::make_shared<Image<uint8_t>>(StagedScene::kSize);
    for (int y = 0; y < interest->height(); ++y)
      for (int x = 0; x < interest->width(); ++x)
        interest->at(x, y) = x + y < 130 ? background::kInside : uint8_t{0};
    params.interest = std::move(interest);
  }
  StagedScene scene({}, params, device);
  Take take;
  take.isGrey = watched.isGrey;
  (void)scene.showFor(4, take);
  take.walker = walkerAt(steps);
  return scene.show(take);
}

/// A stage of the CPU or of a device, by `make`.
template <class Make>
auto stageOn(const Make& make, std::shared_ptr<Device> device) {
  return make({std::make_shared<const Executor>(1), std::move(device)});
}

}  // namespace rg::test
