// SPDX-License-Identifier: LGPL-2.1-or-later
// What each of the objects' numbers (core/objects/numbers.hpp) does: the stages before go over the
// frames once, and the objects' stage once for each number that is moved. tests/accuracy/
// sensitivity.py, which knows their names, runs it and tells.
#include "core/objects/objects.hpp"
#include "core/text/mot.hpp"
#include "tests/accuracy/copies.hpp"
#include "tests/accuracy/earlier_stages.hpp"
#include "tests/accuracy/painter.hpp"
#include "tests/accuracy/sampling.hpp"
#include "tests/accuracy/terms.hpp"
#include "tests/accuracy/verdict.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rg::truth {
namespace {

constexpr char kUsage[] =
    "usage: sensitivity (still|pan) FIRST:LAST [--size WxH] [--fps F] [OPTIONS]\n"
    "       sensitivity VIDEO FPS FRAMES FOLDER [--copy NAME] [OPTIONS]\n"
    "       sensitivity copies\n"
    "  still, pan  made-up scenes by their seeds, 640x480 at 25 frames a second unless told\n"
    "              otherwise: prints of each scene and trial \"NUMBER WAY MOTA IDF1\"\n"
    "  VIDEO       a file, or pictures as in \"%06d.jpg\", before a still camera: writes\n"
    "              FOLDER/NUMBER.WAY.txt in the form of MOTChallenge, with frames and places of\n"
    "              the video, also where it is a copy that is looked at\n"
    "  --copy      a slightly changed one; \"copies\" lists \"NAME EVERY\", one frame in so many\n"
    "  --numbers   those to be moved, from 0, TO left out (default: all). Trial \"- 0\" moves "
    "none\n"
    "  --terms     instead of numbers each weight of the energy and of looks, and \"all\" of them, "
    "in\n"
    "              percent of what it is (0: left out); NUMBER is the term, WAY 0\n"
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
  std::optional<int> termPercent;
  Sampling sampling;
  Copy copy;
};

struct Trial {
  std::string number;  ///< "-": none.
  int way = 0;
  objects::Params params;
  std::unique_ptr<objects::Stage> stage;
  Verdict verdict;
  std::string lines;
};

void addTerms(int percent, std::vector<Trial>& trials) {
  Trial all;
  all.number = "all";
  const auto weigh = [&](const Term& term, Trial& trial) {
    trial.params.*term.weight *= percent / 100.0;
  };
  for (const Term& term : kTerms) {
    Trial& trial = trials.emplace_back();
    trial.number = term.name;
    weigh(term, trial);
    weigh(term, all);
  }
  trials.push_back(std::move(all));
}

std::vector<Trial> makeTrials(const Options& options) {
  std::vector<Trial> trials(1);
  trials[0].number = "-";
  if (options.termPercent) {
    addTerms(*options.termPercent, trials);
    return trials;
  }
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

void tell(const Trial& trial) {
  const Figures figures = trial.verdict.figures();
  std::printf("%s %d %.4f %.4f\n", trial.number.c_str(), trial.way, figures.mota, figures.idf1);
}

Painter painterOf(bool isPan, uint32_t seed, const Sampling& sampling) {
  const Size planned = plannedFrame(sampling.size);
  Plan plan = sampled(isPan ? planPan(seed, planned) : planStill(seed, planned), sampling);
  auto yard = makeYard(seed, plan.canvas, plan.scale);
  return {std::move(plan), std::move(yard), seed};
}

int playScenes(bool isPan, uint32_t first, uint32_t last, const Sampling& sampling,
               std::vector<Trial>& trials) {
  const Context context{std::make_shared<const Executor>(0), nullptr};
  for (uint32_t seed = first; seed <= last; ++seed) {
    begin(trials, context);
    Painter painter = painterOf(isPan, seed, sampling);
    EarlierStages earlier(context, isPan, sampling.fps);
    bench::RawFrame frame;
    Scene scene;
    while (painter.next(frame, scene)) {
      const auto motion = earlier.process(frame);
      for (Trial& trial : trials)
        trial.verdict.add(
            scene,
            *earlier.shown(valueOf(trial.stage->process(motion, trial.params, earlier.time()))));
    }
    for (const Trial& trial : trials) tell(trial);
  }
  return 0;
}

struct Video {
  std::string path;
  double fps = 0;
  uint64_t frames = 0;
  std::string folder;
};

int write(const std::vector<Trial>& trials, const std::string& folder) {
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

int playVideo(const Video& video, const Copy& copy, std::vector<Trial>& trials) {
  const Context context{std::make_shared<const Executor>(0), nullptr};
  const auto source = valueOf(bench::openVideo(video.path));
  begin(trials, context);
  EarlierStages earlier(context, false, video.fps / static_cast<double>(copy.every));
  bench::RawFrame frame;
  for (uint64_t number = 1; number <= video.frames && valueOf(source->next(frame)); ++number) {
    if ((number - 1) % copy.every != 0) continue;
    const Size size = frame.layout.size;
    change(copy, number, frame);
    const auto motion = earlier.process(frame);
    for (Trial& trial : trials)
      text::appendMot(trial.lines,
                      *valueOf(trial.stage->process(motion, trial.params, earlier.time())),
                      {.number = number, .size = size, .ptsNs = {}, .utcNs = {}});
  }
  return write(trials, video.folder);
}

bool findCopy(const std::string& name, Copy& copy) {
  const auto known = copies();
  const auto at = std::find_if(known.begin(), known.end(),
                               [&](const Copy& candidate) { return candidate.name == name; });
  if (at != known.end()) copy = *at;
  return at != known.end();
}

bool parse(int argc, char** argv, bool isScenes, Options& options) {
  Size& size = options.sampling.size;
  for (int i = 0; i < argc; i += 2) {
    const std::string name = argv[i];
    if (i + 1 == argc) return false;
    const char* value = argv[i + 1];
    bool isRead = false;
    if (name == "--numbers")
      isRead = std::sscanf(value, "%zu:%zu", &options.from, &options.to) == 2;
    else if (name == "--terms")
      isRead = std::sscanf(value, "%d", &options.termPercent.emplace()) == 1 &&
               *options.termPercent >= 0 && *options.termPercent <= 1000;
    else if (name == "--by")
      isRead = std::sscanf(value, "%d", &options.percent) == 1;
    else if (name == "--size" && isScenes)
      isRead = std::sscanf(value, "%dx%d", &size.width, &size.height) == 2;
    else if (name == "--fps" && isScenes)
      isRead = std::sscanf(value, "%lf", &options.sampling.fps) == 1;
    else if (name == "--copy" && !isScenes)
      isRead = findCopy(value, options.copy);
    if (!isRead) return false;
  }
  return options.from < options.to && options.to <= Array{}.size() && options.percent > 0 &&
         options.percent < 100 && size.width >= 64 && size.height >= 64 &&
         options.sampling.fps >= 1 && options.sampling.fps <= 1000;
}

int run(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "copies" && argc == 2) {
    for (const Copy& copy : copies()) std::printf("%s %" PRIu64 "\n", copy.name, copy.every);
    return 0;
  }
  const bool isScenes = what == "still" || what == "pan";
  const int own = isScenes ? 3 : 5;
  Options options;
  unsigned first = 0, last = 0;
  Video video;
  video.path = what;
  const bool isRight =
      argc >= own && parse(argc - own, argv + own, isScenes, options) &&
      (isScenes ? std::sscanf(argv[2], "%u:%u", &first, &last) == 2 && first <= last
                : std::sscanf(argv[2], "%lf", &video.fps) == 1 && video.fps > 0 &&
                      std::sscanf(argv[3], "%" SCNu64, &video.frames) == 1);
  if (!isRight) {
    std::cerr << kUsage;
    return 2;
  }
  std::vector<Trial> trials = makeTrials(options);
  if (isScenes) return playScenes(what == "pan", first, last, options.sampling, trials);
  video.folder = argv[4];
  return playVideo(video, options.copy, trials);
}

}  // namespace
}  // namespace rg::truth

int main(int argc, char** argv) {
  return rg::truth::run(argc, argv);
}
