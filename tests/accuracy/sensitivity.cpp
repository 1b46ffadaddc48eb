// SPDX-License-Identifier: LGPL-2.1-or-later
// What each of the objects' numbers (core/objects/numbers.hpp) does: the stages before go over the
// frames once, and the objects' stage once for each number that is moved. tests/accuracy/
// sensitivity.py, which knows their names, runs it and tells.
#include "core/objects/objects.hpp"
#include "core/text/mot.hpp"
#include "tests/accuracy/earlier_stages.hpp"
#include "tests/accuracy/painter.hpp"
#include "tests/accuracy/verdict.hpp"

#include <array>
#include <bit>
#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

namespace rg::truth {
namespace {

constexpr char kUsage[] =
    "usage: sensitivity (still|pan) FIRST:LAST [--numbers FROM:TO] [--by PERCENT]\n"
    "       sensitivity VIDEO FPS FRAMES FOLDER [--numbers FROM:TO] [--by PERCENT]\n"
    "  still, pan  made-up scenes by their seeds: prints of each trial \"NUMBER WAY MOTA IDF1\",\n"
    "              their means\n"
    "  VIDEO       a file, or pictures as in \"%06d.jpg\", before a still camera: writes\n"
    "              FOLDER/NUMBER.WAY.txt in the form of MOTChallenge\n"
    "  --numbers   those to be moved, from 0, TO left out (default: all). Trial \"- 0\" moves "
    "none\n"
    "  --by        each once down and once up, WAY -1 and 1 (default: 25); what counts something\n"
    "              is moved by one at least\n";

using Array = std::array<objects::Number, sizeof(objects::Numbers) / sizeof(objects::Number)>;

/// What counts something and would stay is moved by one, but not to 0.
objects::Number moved(objects::Number n, int percent) {
  const objects::Number result{n.num * (100 + percent), n.den * 100};
  if (n.den != 1 || n.num == 0 || result.whole() != n.num) return result;
  return {std::max<int64_t>(1, n.num + (percent > 0 ? 1 : -1)), 1};
}

struct Options {
  size_t from = 0, to = Array{}.size();
  int percent = 25;
};

struct Trial {
  std::string number;  ///< "-": none.
  int way = 0;
  objects::Params params;
  std::unique_ptr<objects::Stage> stage;
  Verdict verdict;
  double mota = 0, idf1 = 0;  ///< Sums over scenes.
  std::string lines;
};

std::vector<Trial> makeTrials(const Options& options) {
  std::vector<Trial> trials(1);
  trials[0].number = "-";
  const Array numbers = std::bit_cast<Array>(objects::Numbers{});
  for (size_t i = options.from; i < options.to; ++i)
    for (const int way : {-1, 1}) {
      Array changed = numbers;
      changed[i] = moved(numbers[i], way * options.percent);
      Trial& trial = trials.emplace_back();
      trial.number = std::to_string(i);
      trial.way = way;
      trial.params.numbers = std::bit_cast<objects::Numbers>(changed);
    }
  return trials;
}

void begin(std::vector<Trial>& trials, const Context& context) {
  for (Trial& trial : trials) {
    trial.stage = objects::makeStage(context);
    trial.verdict = {};
  }
}

int playScenes(bool isPan, uint32_t first, uint32_t last, std::vector<Trial>& trials) {
  const Context context{std::make_shared<const Executor>(0), nullptr};
  for (uint32_t seed = first; seed <= last; ++seed) {
    begin(trials, context);
    constexpr Size kSize{640, 480};
    Plan plan = isPan ? planPan(seed, kSize) : planStill(seed, kSize);
    const Size canvas = plan.canvas;
    const double fps = plan.fps;
    Painter painter(std::move(plan), makeYard(seed, canvas), seed);
    EarlierStages earlier(context, isPan, fps);
    bench::RawFrame frame;
    Scene scene;
    while (painter.next(frame, scene)) {
      const auto motion = earlier.process(frame);
      for (Trial& trial : trials)
        trial.verdict.add(scene,
                          *valueOf(trial.stage->process(motion, trial.params, earlier.time())));
    }
    for (Trial& trial : trials) {
      const Figures figures = trial.verdict.figures();
      trial.mota += figures.mota;
      trial.idf1 += figures.idf1;
    }
  }
  const double seeds = last - first + 1;
  for (const Trial& trial : trials)
    std::printf("%s %d %.4f %.4f\n", trial.number.c_str(), trial.way, trial.mota / seeds,
                trial.idf1 / seeds);
  return 0;
}

int playVideo(const std::string& path, double fps, uint64_t frames, const std::string& folder,
              std::vector<Trial>& trials) {
  const Context context{std::make_shared<const Executor>(0), nullptr};
  const auto source = valueOf(bench::openVideo(path));
  begin(trials, context);
  EarlierStages earlier(context, false, fps);
  bench::RawFrame frame;
  for (uint64_t number = 1; number <= frames && valueOf(source->next(frame)); ++number) {
    const auto motion = earlier.process(frame);
    for (Trial& trial : trials)
      text::appendMot(trial.lines,
                      *valueOf(trial.stage->process(motion, trial.params, earlier.time())),
                      {.number = number, .size = motion->size, .ptsNs = {}, .utcNs = {}});
  }
  for (const Trial& trial : trials) {
    const std::string name = folder + "/" + trial.number + "." + std::to_string(trial.way) + ".txt";
    std::ofstream file(name, std::ios::binary);
    if (!(file << trial.lines).flush()) {
      std::cerr << "sensitivity: cannot write " << name << '\n';
      return 1;
    }
  }
  return 0;
}

bool parse(int argc, char** argv, Options& options) {
  for (int i = 0; i < argc; i += 2) {
    const std::string name = argv[i];
    if (i + 1 == argc) return false;
    const bool isRead =
        name == "--numbers"
            ? std::sscanf(argv[i + 1], "%zu:%zu", &options.from, &options.to) == 2
            : name == "--by" && std::sscanf(argv[i + 1], "%d", &options.percent) == 1;
    if (!isRead) return false;
  }
  return options.from < options.to && options.to <= Array{}.size() && options.percent > 0 &&
         options.percent < 100;
}

int run(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const bool isScenes = what == "still" || what == "pan";
  const int own = isScenes ? 3 : 5;
  Options options;
  unsigned first = 0, last = 0;
  double fps = 0;
  uint64_t frames = 0;
  const bool isRight =
      argc >= own && parse(argc - own, argv + own, options) &&
      (isScenes ? std::sscanf(argv[2], "%u:%u", &first, &last) == 2 && first <= last
                : std::sscanf(argv[2], "%lf", &fps) == 1 && fps > 0 &&
                      std::sscanf(argv[3], "%" SCNu64, &frames) == 1);
  if (!isRight) {
    std::cerr << kUsage;
    return 2;
  }
  std::vector<Trial> trials = makeTrials(options);
  return isScenes ? playScenes(what == "pan", first, last, trials)
                  : playVideo(what, fps, frames, argv[4], trials);
}

}  // namespace
}  // namespace rg::truth

int main(int argc, char** argv) {
  return rg::truth::run(argc, argv);
}
