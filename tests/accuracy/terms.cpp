// SPDX-License-Identifier: LGPL-2.1-or-later
// What each term of the energy is worth: scenes with known truth under a panning camera, without
// bgremove, so that the merging alone parts things from the ground. An arc between two regions is
// told right when it is kept within a thing, or the ground, and broken between two.
#include "core/objects.hpp"
#include "core/pool.hpp"
#include "tests/accuracy/painter.hpp"
#include "tests/support/value_of.hpp"

#include <array>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>

namespace rg::truth {
namespace {

constexpr int kMixed = -2;  ///< A region of which less than three quarters are one actor's.

/// Whose each region is: the actor that most of its pixels show, −1 for the ground.
std::vector<int> ownersOf(const Graph& graph, const std::vector<int>& top) {
  std::vector<std::map<int, uint32_t>> votes(graph.regions.size());
  const Image<uint16_t>& ids = graph.labels->ids;
  for (int y = 0; y < ids.height(); ++y)
    for (int x = 0; x < ids.width(); ++x)
      if (ids.at(x, y) != kNoRegion)
        ++votes[ids.at(x, y) - 1u][top[static_cast<size_t>(y * ids.width() + x)]];
  std::vector<int> owners;
  for (const std::map<int, uint32_t>& of : votes) {
    uint32_t all = 0, most = 0;
    int owner = kMixed;
    for (const auto& [actor, pixels] : of) {
      all += pixels;
      if (pixels > most) owner = actor;
      most = std::max(most, pixels);
    }
    owners.push_back(4 * most >= 3 * all ? owner : kMixed);
  }
  return owners;
}

/// Arcs by what they should be and what they are.
struct Counts {
  int64_t within = 0, keptWithin = 0, between = 0, brokenBetween = 0;

  /// In percent: the mean of what is told right within things and between them.
  [[nodiscard]] double right() const {
    const auto share = [](int64_t part, int64_t all) {
      return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 1.0;
    };
    return 50 * (share(keptWithin, within) + share(brokenBetween, between));
  }
};

/// Stage 5 with one term left out, or with all of them.
struct Trial {
  const char* name;
  ObjectParams params;
  std::unique_ptr<ObjectStage> stage;
  Counts counts, all;

  void judge(const std::shared_ptr<const Motion>& motion, const std::vector<int>& owners,
             FrameTime time) {
    const auto objects = valueOf(stage->process(motion, params, time));
    if (objects->arcs.empty()) return;
    for (const Arc& arc : motion->graph->arcs) {
      const size_t a = arc.a - 1u, b = arc.b - 1u;
      if (owners[a] == kMixed || owners[b] == kMixed) continue;
      const bool isKept = objects->regionGroup[a] == objects->regionGroup[b];
      if (owners[a] == owners[b]) {
        ++counts.within;
        counts.keptWithin += isKept;
      } else {
        ++counts.between;
        counts.brokenBetween += !isKept;
      }
    }
  }
};

std::array<Trial, 5> makeTrials(const Context& context) {
  std::array<Trial, 5> trials{{{"all terms", {}, {}, {}, {}},
                               {"without U1", {}, {}, {}, {}},
                               {"without U2", {}, {}, {}, {}},
                               {"without U3", {}, {}, {}, {}},
                               {"no prediction", {}, {}, {}, {}}}};
  trials[1].params.motionWeight = 0;
  trials[2].params.borderWeight = 0;
  trials[3].params.arcWeight = 0;
  trials[4].params.predictionWeight = 0;
  for (Trial& trial : trials) trial.stage = makeObjectStage(context);
  return trials;
}

void play(uint32_t seed, Size size, const Context& context, std::array<Trial, 5>& trials) {
  Plan plan = planPan(seed, size);
  const Size canvas = plan.canvas;
  Painter painter(std::move(plan), makeYard(seed, canvas), seed);
  const auto segmentation = makeSegmentationStage(context);
  const auto graph = makeGraphStage(context);
  const auto motion = makeMotionStage(context);
  Pool<Picture> pictures;
  bench::RawFrame frame;
  Scene scene;
  for (int64_t number = 0; painter.next(frame, scene); ++number) {
    const auto picture = pictures.take();
    picture->load(frame.view(), *context.cpu);
    const auto labels = valueOf(segmentation->process(picture, nullptr, {}));
    const auto regions = valueOf(graph->process(labels, {}));
    const auto moved = valueOf(motion->process(regions, {}));
    const std::vector<int> owners = ownersOf(*regions, painter.top());
    for (Trial& trial : trials) trial.judge(moved, owners, {number * 40'000'000, true});
  }
}

void printRow(const char* name, const std::array<Trial, 5>& trials, Counts Trial::*counts) {
  std::printf("%-8s", name);
  for (const Trial& trial : trials) std::printf(" %14.2f", (trial.*counts).right());
  std::printf("\n");
}

int run(uint32_t first, uint32_t last) {
  const Context context{std::make_shared<const Executor>(0), nullptr};
  auto trials = makeTrials(context);
  std::printf("arcs told right, percent\n%-8s", "seed");
  for (const Trial& trial : trials) std::printf(" %14s", trial.name);
  std::printf("\n");
  for (uint32_t seed = first; seed <= last; ++seed) {
    for (Trial& trial : trials) {
      trial.counts = {};
      trial.stage->reset(Reset::Stream);
    }
    play(seed, {640, 480}, context, trials);
    printRow(std::to_string(seed).c_str(), trials, &Trial::counts);
    for (Trial& trial : trials) {
      trial.all.within += trial.counts.within;
      trial.all.keptWithin += trial.counts.keptWithin;
      trial.all.between += trial.counts.between;
      trial.all.brokenBetween += trial.counts.brokenBetween;
    }
  }
  printRow("all", trials, &Trial::all);
  return 0;
}

}  // namespace
}  // namespace rg::truth

int main(int argc, char** argv) {
  unsigned first = 1, last = 8;
  if (argc > 2 || (argc == 2 && std::sscanf(argv[1], "%u:%u", &first, &last) != 2)) {
    std::cerr << "usage: terms [FIRST:LAST]\n  seeds of panning scenes (default 1:8)\n";
    return 2;
  }
  return rg::truth::run(first, last);
}
