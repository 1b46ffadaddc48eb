// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs a fuzzer's target over the files that are named, and those in the folders: what was found
// before stays mended, with any compiler and without libFuzzer.
//
// usage: replay-TARGET [--costs] PATH...
// --costs: a benchmark of slow inputs instead: each is run three times, and the least costs of its
// dearest frames are printed, in nanoseconds a pixel, the dearest first.
#include "tests/fuzz/cost.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
extern "C" __attribute__((weak)) int LLVMFuzzerInitialize(int* argc, char*** argv);

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> listFiles(int argc, char** argv) {
  std::vector<fs::path> files;
  for (int i = 1; i < argc; ++i) {
    if (!fs::is_directory(argv[i])) {
      files.emplace_back(argv[i]);
      continue;
    }
    for (const auto& entry : fs::directory_iterator(argv[i])) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool read(const fs::path& path, std::vector<char>& bytes) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "can't read %s\n", path.c_str());
    return false;
  }
  bytes.assign(std::istreambuf_iterator<char>(file), {});
  return true;
}

void run(const std::vector<char>& bytes) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
}

bool replay(const std::vector<fs::path>& files) {
  for (const fs::path& path : files) {
    std::vector<char> bytes;
    if (!read(path, bytes)) return false;
    std::fprintf(stderr, "%s\n", path.filename().c_str());  // The last one is the one that failed.
    run(bytes);
  }
  std::printf("%zu inputs replayed\n", files.size());
  return !files.empty();
}

bool tellCosts(const std::vector<fs::path>& files) {
  std::vector<std::pair<int64_t, std::string>> costs;
  for (const fs::path& path : files) {
    std::vector<char> bytes;
    if (!read(path, bytes)) return false;
    int64_t least = INT64_MAX;
    for (int i = 0; i < 3; ++i) {
      run(bytes);
      least = std::min(least, rg::fuzz::lastCost());
    }
    costs.emplace_back(least, path.filename());
  }
  std::sort(costs.rbegin(), costs.rend());
  for (const auto& [cost, name] : costs)
    std::printf("%10.1f ns/px  %s\n", static_cast<double>(cost) / 1000, name.c_str());
  return !costs.empty();
}

}  // namespace

int main(int argc, char** argv) {
  if (LLVMFuzzerInitialize) LLVMFuzzerInitialize(&argc, &argv);
  const bool tells = argc > 1 && std::strcmp(argv[1], "--costs") == 0;
  const std::vector<fs::path> files = listFiles(argc - tells, argv + tells);
  return (tells ? tellCosts(files) : replay(files)) ? 0 : 1;
}
