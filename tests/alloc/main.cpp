// SPDX-License-Identifier: LGPL-2.1-or-later
// Every allocation fails in its turn, and every start of a thread: no crash, and what comes next is
// right. Each place runs in a child, so that a crash is counted and the rest goes on.
//
// usage: allocation-failures [--every N] [--only TEXT]
// --every N: only every N-th allocation (1 = all of them). --only TEXT: places whose name has it.
#include "tests/alloc/places.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace rg::testing {
namespace {

struct Options {
  uint64_t every = 1;
  std::string only;
};

/// Shared with the child: where it is, and what it has seen.
struct Progress {
  size_t place = 0;
  bool staysSo = false;  ///< The second round: all later ones fail as well.
  uint64_t at = 0;       ///< The allocation that fails.
  uint64_t points = 0, graceful = 0, wrong = 0, crashes = 0;
  bool isDone = false;
  char name[200] = {};
};

/// Short runs look at other points in each place.
uint64_t firstPoint(const Progress& progress, uint64_t every) {
  return 1 + (progress.place * 7 + (progress.staysSo ? 3 : 0)) % every;
}

void tryPoints(const Place& place, uint64_t every, Progress& progress) {
  std::snprintf(progress.name, sizeof progress.name, "%s", place.name.c_str());
  for (progress.at = progress.at == 0 ? firstPoint(progress, every) : progress.at + every;;
       progress.at += every) {
    const Outcome outcome = place.attempt({progress.at, progress.staysSo});
    if (outcome == Outcome::NotReached) return;
    ++progress.points;
    if (outcome == Outcome::Graceful) {
      ++progress.graceful;
      continue;
    }
    ++progress.wrong;
    std::printf("wrong: %s, allocation %llu%s\n", place.name.c_str(),
                static_cast<unsigned long long>(progress.at),
                progress.staysSo ? " and all later ones" : "");
  }
}

[[noreturn]] void runChild(const Options& options, Progress& progress) {
  std::vector<Place> places = elementPlaces();
  for (Place& place : stagePlaces()) places.push_back(std::move(place));
  for (; progress.place < places.size(); ++progress.place, progress.staysSo = false) {
    const Place& place = places[progress.place];
    if (place.name.find(options.only) == std::string::npos) continue;
    for (;; progress.staysSo = true) {
      tryPoints(place, options.every, progress);
      progress.at = 0;
      if (progress.staysSo) break;
    }
  }
  progress.isDone = true;
  std::exit(EXIT_SUCCESS);
}

void runAll(const Options& options, Progress& progress) {
  while (!progress.isDone) {
    const pid_t child = fork();
    if (child == 0) runChild(options, progress);
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) {
      std::perror("allocation-failures");
      std::exit(EXIT_FAILURE);
    }
    if (progress.isDone && WIFEXITED(status) && WEXITSTATUS(status) == 0) break;
    ++progress.crashes;
    ++progress.points;
    std::printf("crash: %s, allocation %llu%s, %s %d\n", progress.name,
                static_cast<unsigned long long>(progress.at),
                progress.staysSo ? " and all later ones" : "",
                WIFSIGNALED(status) ? "signal" : "status",
                WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
  }
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--every") == 0)
      options.every = std::max(1ull, std::strtoull(argv[i + 1], nullptr, 10));
    else if (std::strcmp(argv[i], "--only") == 0)
      options.only = argv[i + 1];
  }
  return options;
}

}  // namespace
}  // namespace rg::testing

int main(int argc, char** argv) {
  using namespace rg::testing;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // What a child has said must survive its crash.
  void* shared =
      mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) {
    std::perror("allocation-failures");
    return EXIT_FAILURE;
  }
  auto& progress = *new (shared) Progress;
  runAll(parse(argc, argv), progress);
  std::printf("points %llu, failed gracefully %llu, wrong %llu, crashes %llu\n",
              static_cast<unsigned long long>(progress.points),
              static_cast<unsigned long long>(progress.graceful),
              static_cast<unsigned long long>(progress.wrong),
              static_cast<unsigned long long>(progress.crashes));
  const bool isGood = progress.points > 0 && progress.graceful == progress.points;
  return isGood ? EXIT_SUCCESS : EXIT_FAILURE;
}
