// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/fuzz/object_program.hpp"

#include "core/base/pixel.hpp"
#include "tests/fuzz/cost.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <unordered_map>

namespace rg::fuzz {
namespace {

constexpr int kMostFrames = 40;
constexpr int kMostSide = 96;
constexpr uint32_t kMostLabels = 65535;

void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "the objects do not fit together: %s\n", what);
  std::abort();
}

uint32_t hashAt(int x, int y, uint32_t what) {
  return mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), what);
}

template <class T>
T valueOf(Result<T> result) {
  demand(static_cast<bool>(result), "a stage refused what it was given");
  return *std::move(result);
}

void check(const objects::Objects& objects) {
  const auto count = static_cast<uint16_t>(objects.objects.size());
  demand(objects.slots.size() == objects.size, "slots have the frame's size");
  for (int y = 0; y < objects.size.height; ++y)
    for (int x = 0; x < objects.size.width; ++x)
      demand(objects.slots.at(x, y) <= count, "a slot is an object's");
  for (size_t i = 1; i < objects.objects.size(); ++i)
    demand(objects.objects[i - 1].id < objects.objects[i].id, "objects are sorted by id");
  if (objects.status == Status::Skipped) return;
  const size_t regions = objects.motion->graph->regions.size();
  demand(objects.regionObject.size() == regions, "every region has an object or none");
  demand(objects.regionGroup.size() == regions, "every region has a group");
  demand(objects.arcs.size() == objects.motion->graph->arcs.size(), "every arc has an energy");
}

}  // namespace

ObjectProgram::ObjectProgram(Bytes& bytes)
    : bytes_(bytes), context_{std::make_shared<const Executor>(1), nullptr} {
  graphs_ = graph::makeStage(context_);
  objects_ = objects::makeStage(context_);
  scope_ = static_cast<segmentation::Scope>(bytes_.between(0, 2));
  connectivity_ = bytes_.flip() ? Connectivity::Eight : Connectivity::Four;
  startScene();
}

void ObjectProgram::run() {
  while (frame_ < kMostFrames && !bytes_.isEmpty()) {
    switch (bytes_.between(0, 9)) {
      case 0:
        startScene();
        break;
      case 1:
        changeParams();
        break;
      case 2:
        objects_->reset(static_cast<Reset>(bytes_.between(0, 2)));
        break;
      case 3:  // A stage may be given another size at any time.
        size_ = {bytes_.between(1, kMostSide), bytes_.between(1, kMostSide)};
        break;
      default:
        for (int i = bytes_.between(1, 5); i > 0; --i) processFrame();
    }
  }
}

void ObjectProgram::startScene() {
  pattern_ = static_cast<Pattern>(bytes_.between(0, 4));
  block_ = bytes_.between(1, 24);
  seed_ = bytes_.take<uint16_t>();
  things_.assign(bytes_.between<size_t>(0, 20), {});
  for (Thing& thing : things_) {
    thing.x = bytes_.take();
    thing.y = bytes_.take();
    thing.dx = bytes_.between(-9, 9);
    thing.dy = bytes_.between(-4, 4);
    thing.width = bytes_.between(1, 60);
    thing.height = bytes_.between(1, 60);
    thing.parts = bytes_.take() % 5 + 1;
    thing.level = bytes_.take();
  }
}

void ObjectProgram::changeParams() {
  const auto weight = [&] { return bytes_.flip() ? bytes_.take() * 4.0 : 1.0; };
  params_.motionWeight = weight();
  params_.borderWeight = weight();
  params_.arcWeight = weight();
  params_.predictionWeight = weight();
  params_.appearanceWeight = weight();
  params_.motionThreshold = bytes_.take();
  params_.maxLostTimeS = bytes_.take() / 16.0;
  params_.minObjectArea = bytes_.flip() ? 0 : bytes_.take() / 16.0;
}

/// Any number per region; 0 = none.
uint32_t ObjectProgram::rawLabelAt(int x, int y) const {
  for (size_t i = things_.size(); i-- > 0;) {
    const Thing& thing = things_[i];
    const int atX = x - thing.x - thing.dx * frame_, atY = y - thing.y - thing.dy * frame_;
    if (atX < 0 || atY < 0 || atX >= thing.width || atY >= thing.height) continue;
    const int part = atY * thing.parts / thing.height;
    return static_cast<uint32_t>(1 + i * 8 + static_cast<size_t>(part)) << 20;
  }
  if (scope_ != segmentation::Scope::Frame && pattern_ == Pattern::Things) return 0;
  switch (pattern_) {
    case Pattern::Blocks:
      return 1 + hashAt(x / block_, y / block_, seed_) % 997;
    case Pattern::Stripes:
      return 1 + static_cast<uint32_t>((x + frame_) / block_);
    case Pattern::Pixels:
      return 1 + static_cast<uint32_t>(y) * kMostSide + static_cast<uint32_t>(x);
    case Pattern::Nothing:
      return 0;
    default:
      return 1 + static_cast<uint32_t>(x / 32 + 8 * (y / 32));
  }
}

std::shared_ptr<const segmentation::Labels> ObjectProgram::makeLabels() {
  std::vector<uint8_t> levels(static_cast<size_t>(size_.area()));
  auto labels = std::make_shared<segmentation::Labels>();
  labels->size = size_;
  labels->status = Status::Ok;
  labels->scope = scope_;
  labels->ids.resize(size_);
  std::unordered_map<uint32_t, uint16_t> numbers;
  size_t i = 0;
  for (int y = 0; y < size_.height; ++y)
    for (int x = 0; x < size_.width; ++x, ++i) {
      const uint32_t raw = rawLabelAt(x, y);
      levels[i] = static_cast<uint8_t>(raw * 37 + hashAt(x / 2, y / 2, seed_) % 16);
      uint16_t& label = labels->ids.at(x, y);
      label = segmentation::kNoRegion;
      if (raw == 0 || numbers.size() == kMostLabels) continue;
      label = numbers.try_emplace(raw, static_cast<uint16_t>(numbers.size() + 1)).first->second;
    }
  labels->count = static_cast<uint32_t>(numbers.size());
  const PlaneMemory plane{levels.data(), levels.size(), size_.width};
  auto picture = std::make_shared<Picture>();
  picture->load(valueOf(Frame::make({PixelFormat::Gray8, size_}, std::array{plane})),
                *context_.cpu);
  labels->picture = picture;
  if (scope_ != segmentation::Scope::Frame) {
    auto foreground = std::make_shared<background::Foreground>();
    foreground->size = size_;
    foreground->status = Status::Ok;
    foreground->picture = picture;
    foreground->mask.resize(size_);
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x)
        foreground->mask.at(x, y) = labels->ids.at(x, y) != segmentation::kNoRegion
                                        ? background::kForegroundPixel
                                        : background::kBackgroundPixel;
    foreground->extent = boundsOf(size_);
    labels->foreground = foreground;
  }
  return labels;
}

std::shared_ptr<const motion::Motion> ObjectProgram::makeMotion(
    std::shared_ptr<const graph::Graph> graph) {
  auto motion = std::make_shared<motion::Motion>();
  motion->size = graph->size;
  const uint8_t kind = bytes_.take();
  motion->status = kind % 16 == 0 ? Status::Skipped : Status::Ok;
  const int32_t dx = bytes_.take<int8_t>(), dy = bytes_.take<int8_t>();
  for (size_t i = 0; i < graph->regions.size(); ++i) {
    motion::RegionMotion of{dx, dy, 100, motion::kFullReliability};
    const uint32_t hash = hashAt(static_cast<int>(i), frame_, seed_);
    if (kind % 3 == 1)
      of = {dx + static_cast<int32_t>(hash % 64), dy, hash, static_cast<uint16_t>(hash % 257)};
    if (kind % 3 == 2)
      of = {static_cast<int32_t>(hash % 2049) - 1024,
            static_cast<int32_t>((hash >> 11) % 2049) - 1024, hash,
            static_cast<uint16_t>((hash >> 3) % 257)};
    motion->regions.push_back(of);
  }
  motion->regions.shrink_to_fit();
  motion->camera = CameraMotion(Point{dx, dy});
  if (kind % 4 == 3)  // It turns and grows, round a place that may lie far outside.
    motion->camera = {{CameraMotion::kOne + dx * (1 << 20), dy * (1 << 20), dx * (1 << 24),
                       -dy * (1 << 20), CameraMotion::kOne - dx * (1 << 20), dy * (1 << 24),
                       dx * (1 << 12), dy * (1 << 12), CameraMotion::kOne},
                      {dx * 50, dy * 50}};
  motion->graph = std::move(graph);
  return motion;
}

void ObjectProgram::processFrame() {
  const auto graph = valueOf(graphs_->process(makeLabels(), {connectivity_}));
  const auto motion = makeMotion(graph);
  timeNs_ += bytes_.flip() ? 40'000'000 : bytes_.take<int32_t>();
  const FrameTime time{timeNs_, !bytes_.flip()};
  const auto work = static_cast<int64_t>(size_.area()) +
                    100 * static_cast<int64_t>(graph->regions.size() + graph->arcs.size());
  const auto objects =
      measured(work + 5000, [&] { return valueOf(objects_->process(motion, params_, time)); });
  check(*objects);
  ++frame_;
}

}  // namespace rg::fuzz
