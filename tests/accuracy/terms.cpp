// SPDX-License-Identifier: LGPL-2.1-or-later
// What each term is worth: made-up scenes with known truth, with all terms, with one left out at a
// time, and with none. Under a panning camera without bgremove, where the merging alone parts
// things from the ground, also by arcs: one between two regions is told right when it is kept
// within a thing, or the ground, and broken between two.
#include "tests/accuracy/terms.hpp"

#include "core/objects/objects.hpp"
#include "tests/accuracy/earlier_stages.hpp"
#include "tests/accuracy/painter.hpp"
#include "tests/accuracy/verdict.hpp"
#include "tests/support/value_of.hpp"

#include <cstdio>
#include <iostream>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace rg::truth {
namespace {

constexpr int kMixed = -2;  ///< A region of which less than three quarters are one actor's.

/// Whose each region is: the actor that most of its pixels show, −1 for the ground.
std::vector<int> ownersOf(const graph::Graph& graph, const std::vector<int>& top) {
  std::vector<std::map<int, uint32_t>> votes(graph.regions.size());
  const Image<uint16_t>& ids = graph.labels->ids;
  for (int y = 0; y < ids.height(); ++y)
    for (int x = 0; x < ids.width(); ++x)
      if (ids.at(x, y) != segmentation::kNoRegion)
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

/// What a set of scenes says of a trial: means over its seeds.
struct Means {
  Counts arcs;
  double idf1 = 0, found = 0, falsePerFrame = 0, centroidPx = 0;
  int seeds = 0;

  void add(const Figures& figures) {
    idf1 += figures.idf1;
    found += figures.recall;
    falsePerFrame += figures.falsePerFrame;
    centroidPx += figures.centroidPx;
    ++seeds;
  }
};

/// Stage 5 with some terms left out.
struct Trial {
  std::string name;
  objects::Params params;
  std::unique_ptr<objects::Stage> stage;
  Verdict verdict;
  Means means;

  /// owners: of the regions, as ownersOf() tells; empty where arcs don't count.
  void judge(const std::shared_ptr<const motion::Motion>& motion, const std::vector<int>& owners,
             const Scene& scene, FrameTime time) {
    const auto objects = valueOf(stage->process(motion, params, time));
    verdict.add(scene, *objects);
    if (owners.empty()) return;
    Counts& counts = means.arcs;
    if (objects->arcs.empty()) return;
    for (const graph::Arc& arc : motion->graph->arcs) {
      const size_t a = arc.a.index(), b = arc.b.index();
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

using Trials = std::vector<Trial>;

Trials makeTrials(const Context& context) {
  Trials trials(std::size(kTerms) + 2);
  trials.front().name = "all terms";
  trials.back().name = "no terms";
  for (size_t i = 0; i < std::size(kTerms); ++i) {
    trials[i + 1].name = std::string("no ") + kTerms[i].name;
    trials[i + 1].params.*kTerms[i].weight = 0;
    trials.back().params.*kTerms[i].weight = 0;
  }
  for (Trial& trial : trials) trial.stage = objects::makeStage(context);
  return trials;
}

void play(uint32_t seed, bool isPan, const Context& context, Trials& trials) {
  constexpr Size kSize{640, 480};
  Plan plan = isPan ? planPan(seed, kSize) : planStill(seed, kSize);
  const Size canvas = plan.canvas;
  Painter painter(std::move(plan), makeYard(seed, canvas), seed);
  EarlierStages earlier(context, isPan, 25);
  bench::RawFrame frame;
  truth::Scene scene;
  for (int64_t number = 0; painter.next(frame, scene); ++number) {
    const auto moved = earlier.process(frame);
    const auto owners =
        isPan && number > 0 ? ownersOf(*moved->graph, painter.top()) : std::vector<int>{};
    for (Trial& trial : trials) trial.judge(moved, owners, scene, earlier.time());
  }
}

void print(const char* set, bool isPan, const Trials& trials) {
  std::printf("%-16s", set);
  for (const Trial& trial : trials) std::printf(" %13s", trial.name.c_str());
  const auto row = [&](const char* name, const auto& valueOfMeans) {
    std::printf("\n%-16s", name);
    for (const Trial& trial : trials) std::printf(" %13.4f", valueOfMeans(trial.means));
  };
  const auto share = [](double sum, const Means& m) { return sum / m.seeds; };
  if (isPan) row("arcs right, %", [](const Means& m) { return m.arcs.right(); });
  row("IDF1", [&](const Means& m) { return share(m.idf1, m); });
  row("found", [&](const Means& m) { return share(m.found, m); });
  row("false a frame", [&](const Means& m) { return share(m.falsePerFrame, m); });
  row("centroid, px", [&](const Means& m) { return share(m.centroidPx, m); });
  std::printf("\n");
}

int run(uint32_t first, uint32_t last, bool isPan) {
  const Context context{std::make_shared<const Executor>(0), nullptr};
  Trials trials = makeTrials(context);
  for (uint32_t seed = first; seed <= last; ++seed) {
    for (Trial& trial : trials) {
      trial.verdict = {};
      trial.stage = objects::makeStage(context);
    }
    play(seed, isPan, context, trials);
    for (Trial& trial : trials) trial.means.add(trial.verdict.figures());
  }
  print(isPan ? "panning" : "still", isPan, trials);
  return 0;
}

}  // namespace
}  // namespace rg::truth

int main(int argc, char** argv) {
  unsigned first = 1, last = 8;
  const std::string set = argc > 1 ? argv[1] : "pan";
  const bool isKnown = set == "pan" || set == "still";
  if (!isKnown || argc > 3 || (argc == 3 && std::sscanf(argv[2], "%u:%u", &first, &last) != 2)) {
    std::cerr << "usage: terms [pan|still] [FIRST:LAST]\n  made-up scenes by their seeds (default "
                 "pan 1:8)\n";
    return 2;
  }
  return rg::truth::run(first, last, set == "pan");
}
