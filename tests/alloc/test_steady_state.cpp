// SPDX-License-Identifier: LGPL-2.1-or-later
// A pipeline that has seen its scene for a while works in the memory that it has.
#include "core/objects/objects.hpp"
#include "tests/alloc/failing_new.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace rg {
namespace {

using namespace scenes;

constexpr Size kSize{160, 120};
constexpr int kWarmUp = 600, kCounted = 600;
constexpr uint64_t kOfObject = 12;  // Its portrait, history, outline.

/// Two things that go to and fro on a wall, and one that stands.
std::vector<std::shared_ptr<const Picture>> toAndFro() {
  constexpr int kSteps = 30;
  std::vector<std::shared_ptr<const Picture>> pictures;
  for (int i = 0; i < 2 * kSteps; ++i) {
    const int step = i < kSteps ? i : 2 * kSteps - 1 - i;
    const Box one{10 + 3 * step, 30, 24, 30}, other{120 - 3 * step, 70, 20, 24};
    pictures.push_back(paint(kSize, [&](int x, int y) {
      const auto level = static_cast<uint8_t>(90 + (x / 5 * 7 + y / 6 * 11) % 60);
      if (one.contains({x, y})) return Rgb{static_cast<uint8_t>(200 + (x - one.x) % 5 * 9), 40, 40};
      if (other.contains({x, y}))
        return Rgb{30, static_cast<uint8_t>(30 + (y - other.y) % 4 * 9), 220};
      return Rgb{level, level, static_cast<uint8_t>(level - 20)};
    }));
  }
  return pictures;
}

/// Calls of operator new by each stage, in the order of the stages, and by the packer.
using Counts = std::array<uint64_t, 6>;

class Counted {
 public:
  explicit Counted(segmentation::Scope scope) : scope_(scope) {}

  Counts process(const std::shared_ptr<const Picture>& picture) {
    const FrameTime now{index_++ * int64_t{40'000'000}, true};
    size_t stage = 0;
    Counts counts{};
    const auto count = [&](auto call) {
      const uint64_t before = ::rg::testing::allocations();
      auto result = *call();
      counts[stage++] = ::rg::testing::allocations() - before;
      return result;
    };
    const auto foreground = count([&] { return background_->process(picture, {}, now); });
    const auto labels = count([&] {
      return segmentation_->process(
          picture, scope_ == segmentation::Scope::Frame ? nullptr : foreground, {scope_});
    });
    const auto graph = count([&] { return graph_->process(labels, {}); });
    const auto motion = count([&] { return motion_->process(graph, {}, {}); });
    const auto objects = count([&] { return objects_->process(motion, {}, now); });
    seen_ += objects->objects.size();
    for (const objects::Object& object : objects->objects) last_ = std::max(last_, object.id);
    const uint64_t before = ::rg::testing::allocations();
    (void)packer_.pack(objects);
    packer_.endFrame();
    counts[stage] = ::rg::testing::allocations() - before;
    return counts;
  }
  [[nodiscard]] size_t seen() const { return seen_; }
  /// Objects that there have been.
  [[nodiscard]] uint64_t begun() const { return last_; }

 private:
  const segmentation::Scope scope_;
  const Context context_ = contextWith(1);
  const std::unique_ptr<background::Stage> background_ = background::makeStage(context_);
  const std::unique_ptr<segmentation::Stage> segmentation_ = segmentation::makeStage(context_);
  const std::unique_ptr<graph::Stage> graph_ = graph::makeStage(context_);
  const std::unique_ptr<motion::Stage> motion_ = motion::makeStage(context_);
  const std::unique_ptr<objects::Stage> objects_ = objects::makeStage(context_);
  objects::ResultPacker packer_;
  int index_ = 0;
  size_t seen_ = 0;
  uint64_t last_ = 0;
};

TEST(SteadyState, NeedsNoMemory) {
  const auto pictures = toAndFro();
  for (const segmentation::Scope scope :
       {segmentation::Scope::Foreground, segmentation::Scope::Frame}) {
    Counted chain(scope);
    Counts sums{};
    uint64_t before = 0;
    for (int i = 0; i < kWarmUp + kCounted; ++i) {
      if (i == kWarmUp) before = chain.begun();
      const Counts counts = chain.process(pictures[static_cast<size_t>(i) % pictures.size()]);
      for (size_t stage = 0; i >= kWarmUp && stage < counts.size(); ++stage)
        sums[stage] += counts[stage];
    }
    EXPECT_GT(chain.seen(), size_t{kCounted});
    // An object that begins has memory of its own, and so has what is told of it.
    const uint64_t ofObjects = kOfObject * (chain.begun() - before);
    for (size_t stage = 0; stage < sums.size(); ++stage)
      EXPECT_LE(sums[stage], stage < 4 ? 0u : ofObjects) << "stage " << stage + 1;
  }
}

}  // namespace
}  // namespace rg
