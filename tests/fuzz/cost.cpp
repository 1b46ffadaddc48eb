// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/fuzz/cost.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>

namespace rg::fuzz {
namespace {

// libFuzzer looks at this section after each input: a counter that was never set is news to it.
__attribute__((section("__libfuzzer_extra_counters"), used)) uint8_t costCounters[256];

constexpr double kStepsPerDoubling = 4;  // Time is noisy: a step is 19 %.

constexpr size_t kMostKept = 100;

int64_t dearest = 0, last = 0;

namespace fs = std::filesystem;

/// The names of the inputs that were kept, the cheapest first: their costs with leading zeros.
std::set<std::string> listKept(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

}  // namespace

void noteCost(int64_t ns, int64_t units) {
  const int64_t cost = ns * 1000 / std::max<int64_t>(units, 1);
  dearest = std::max(dearest, cost);
  static const bool isFeedback = std::getenv("RG_NO_COSTS") == nullptr;
  if (!isFeedback) return;
  const double step =
      kStepsPerDoubling * std::log2(static_cast<double>(std::max<int64_t>(cost, 1)));
  const auto highest = static_cast<double>(std::size(costCounters) - 1);
  costCounters[static_cast<size_t>(std::clamp(step, 0.0, highest))] = 1;
}

int64_t takeDearest() {
  return std::exchange(dearest, 0);
}

int64_t lastCost() {
  return last;
}

void keepIfDear(const uint8_t* data, size_t size) {
  const int64_t cost = last = takeDearest();
  const char* const folder = std::getenv("RG_SLOW_DIR");
  if (!folder) return;
  static std::set<std::string> kept = listKept(folder);
  char digits[32];
  std::snprintf(digits, sizeof digits, "%012lld", static_cast<long long>(cost));
  const std::string name(digits);
  if (kept.size() >= kMostKept && name <= *kept.begin()) return;
  std::ofstream(fs::path(folder) / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  kept.insert(name);
  if (kept.size() <= kMostKept) return;
  fs::remove(fs::path(folder) / *kept.begin());
  kept.erase(kept.begin());
}

}  // namespace rg::fuzz
