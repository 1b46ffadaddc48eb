// SPDX-License-Identifier: LGPL-2.1-or-later
// Each stage by itself: after an exception it goes on as after reset(Reset::Stream).
#include "core/objects/objects.hpp"
#include "tests/alloc/places.hpp"
#include "tests/core/scenes.hpp"
#include "tests/support/digest.hpp"

#include <map>
#include <new>

namespace rg::testing {
namespace {

constexpr Size kSize{64, 48};
constexpr int kFrames = 18;
constexpr int kFailing[] = {0, 1, 2, 9, 14};

/// A wall, a thing that walks through and one that stops; `pan` moves all of it.
std::shared_ptr<const Picture> pictureAt(int time, int pan) {
  const Box walker{3 * time - 6, 8, 12, 16}, parker{52 - 2 * std::min(time, 10), 28, 14, 12};
  return scenes::paint(kSize, [&](int px, int py) {
    const int x = px + pan * time;
    const auto level = static_cast<uint8_t>(90 + (x / 5 * 7 + py / 6 * 11) % 60);
    if (walker.contains({px, py}))
      return scenes::Rgb{static_cast<uint8_t>(200 + (px - walker.x) % 5 * 9), 40, 40};
    if (parker.contains({px, py}))
      return scenes::Rgb{30, static_cast<uint8_t>(30 + (py - parker.y) % 4 * 9), 220};
    return scenes::Rgb{level, level, static_cast<uint8_t>(level - 20)};
  });
}

Context context(int threads) {
  static const Context one = scenes::contextWith(1), two = scenes::contextWith(2);
  return threads == 1 ? one : two;
}

/// What one frame's input is to each stage; made once, by stages that never fail.
struct Inputs {
  std::vector<std::shared_ptr<const Picture>> pictures;
  std::vector<std::shared_ptr<const background::Foreground>> foregrounds;
  std::vector<std::shared_ptr<const segmentation::Labels>> labels;
  std::vector<std::shared_ptr<const graph::Graph>> graphs;
  std::vector<std::shared_ptr<const motion::Motion>> motions;
};

FrameTime timeOf(int frame) {
  return {frame * int64_t{40'000'000}, true};
}

segmentation::Params segmentationOf(segmentation::Scope scope) {
  segmentation::Params params;
  params.scope = scope;
  params.minAreaPx = 12;
  return params;
}

const Inputs& inputsOf(segmentation::Scope scope) {
  static std::map<segmentation::Scope, Inputs> made;
  Inputs& inputs = made[scope];
  if (!inputs.pictures.empty()) return inputs;
  const auto background = background::makeStage(context(1));
  const auto segmentation = segmentation::makeStage(context(1));
  const auto graph = graph::makeStage(context(1));
  const auto motion = motion::makeStage(context(1));
  for (int i = 0; i < kFrames; ++i) {
    inputs.pictures.push_back(pictureAt(i, scope == segmentation::Scope::Frame ? 1 : 0));
    inputs.foregrounds.push_back(*background->process(inputs.pictures.back(), {}, timeOf(i)));
    inputs.labels.push_back(*segmentation->process(
        inputs.pictures.back(),
        scope == segmentation::Scope::Frame ? nullptr : inputs.foregrounds.back(),
        segmentationOf(scope)));
    inputs.graphs.push_back(*graph->process(inputs.labels.back(), {}));
    inputs.motions.push_back(*motion->process(inputs.graphs.back(), {}, {}));
  }
  return inputs;
}

/// A stage, how it takes frame i, and what readers see of its results.
struct Subject {
  std::function<std::shared_ptr<const void>(int)> process;
  std::function<uint64_t(const void*)> digest;
  std::function<void()> reset;
};
using MakeSubject = std::function<Subject()>;

template <class Stage, class Process>
Subject subjectOf(std::unique_ptr<Stage> made, Process process) {
  const std::shared_ptr<Stage> stage = std::move(made);
  using Payload = std::remove_reference_t<decltype(*process(*stage, size_t{0}))>;
  return {[stage, process](int i) { return process(*stage, static_cast<size_t>(i)); },
          [](const void* result) { return digestOf(*static_cast<const Payload*>(result)); },
          [stage] { stage->reset(Reset::Stream); }};
}

uint64_t show(const Subject& subject, int frame) {
  return subject.digest(subject.process(frame).get());
}

/// The digests of the frames behind `missing`, in which the stage was reset.
std::vector<uint64_t> withReset(const Subject& subject, int missing) {
  std::vector<uint64_t> digests;
  for (int i = 0; i < kFrames; ++i) {
    if (i == missing) {
      subject.reset();
      continue;
    }
    const uint64_t digest = show(subject, i);
    if (i > missing) digests.push_back(digest);
  }
  return digests;
}

Outcome attempt(const MakeSubject& make, int failing, const Fault& fault,
                const std::vector<uint64_t>& expected) {
  const Subject subject = make();
  for (int i = 0; i < failing; ++i) subject.process(i);
  bool isThrown = false;
  armMemory(fault);
  try {
    subject.process(failing);
  } catch (const std::bad_alloc&) {
    isThrown = true;
  }
  if (!disarm()) return Outcome::NotReached;
  if (!isThrown) return Outcome::Graceful;
  std::vector<uint64_t> digests;
  for (int i = failing + 1; i < kFrames; ++i) digests.push_back(show(subject, i));
  return digests == expected ? Outcome::Graceful : Outcome::Wrong;
}

void addPlaces(const std::string& name, const MakeSubject& make, std::vector<Place>& places) {
  for (const int failing : kFailing) {
    const auto expected = std::make_shared<std::vector<uint64_t>>();
    places.push_back({name + ", frame " + std::to_string(failing), [=](const Fault& fault) {
                        if (expected->empty()) *expected = withReset(make(), failing);
                        return attempt(make, failing, fault, *expected);
                      }});
  }
}

const char* nameOf(background::Method method) {
  switch (method) {
    case background::Method::Paper:
      return "background by the paper";
    case background::Method::FrameDifference:
      return "background by frame difference";
    case background::Method::Hybrid:
      break;
  }
  return "hybrid background";
}

void addBackground(background::Method method, int threads, std::vector<Place>& places) {
  const auto process = [=](background::Stage& stage, size_t i) {
    background::Params params;
    params.method = method;
    params.trainingFrames = 3;
    return *stage.process(inputsOf(segmentation::Scope::Foreground).pictures[i], params,
                          timeOf(static_cast<int>(i)));
  };
  addPlaces(
      nameOf(method), [=] { return subjectOf(background::makeStage(context(threads)), process); },
      places);
}

void addOthers(segmentation::Scope scope, int threads, std::vector<Place>& places) {
  const std::string of = scope == segmentation::Scope::Frame ? " of frames" : " of the foreground";
  const auto add = [&](const char* name, auto makeStage, auto process) {
    addPlaces(
        name + of,
        [=] {
          return subjectOf(makeStage(context(threads)), [=](auto& stage, size_t i) {
            return process(stage, inputsOf(scope), i);
          });
        },
        places);
  };
  add("segmentation", segmentation::makeStage,
      [=](segmentation::Stage& stage, const Inputs& in, size_t i) {
        return *stage.process(in.pictures[i],
                              scope == segmentation::Scope::Frame ? nullptr : in.foregrounds[i],
                              segmentationOf(scope));
      });
  add("graph", graph::makeStage, [](graph::Stage& stage, const Inputs& in, size_t i) {
    return *stage.process(in.labels[i], {Connectivity::Eight});
  });
  add("motion", motion::makeStage, [](motion::Stage& stage, const Inputs& in, size_t i) {
    return *stage.process(in.graphs[i], {}, {});
  });
  add("objects", objects::makeStage, [](objects::Stage& stage, const Inputs& in, size_t i) {
    return *stage.process(in.motions[i], {}, timeOf(static_cast<int>(i)));
  });
}

}  // namespace

std::vector<Place> stagePlaces() {
  std::vector<Place> places;
  for (const int threads : {1, 2}) {
    for (const auto method : {background::Method::Hybrid, background::Method::Paper,
                              background::Method::FrameDifference})
      addBackground(method, threads, places);
    for (const segmentation::Scope scope :
         {segmentation::Scope::Frame, segmentation::Scope::Foreground})
      addOthers(scope, threads, places);
  }
  return places;
}

}  // namespace rg::testing
