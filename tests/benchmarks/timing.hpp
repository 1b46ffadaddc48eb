// SPDX-License-Identifier: LGPL-2.1-or-later
// Times of the steps of a frame, and their medians over the frames.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace rg::bench {

/// Median of the values, the mean of the middle two where their number is even; 0 of none.
[[nodiscard]] inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

/// The least value that is not below 99 % of them; 0 of none.
[[nodiscard]] inline double percentile99(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[(values.size() * 99 + 99) / 100 - 1];
}

[[nodiscard]] inline double mean(const std::vector<double>& values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

/// What is read before and after a step.
enum class Clock : uint8_t {
  Wall,
  Cpu,  ///< Time of all threads, whatever else runs on the machine.
};

[[nodiscard]] inline double nowMs(Clock clock) {
  if (clock == Clock::Cpu) return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  const std::chrono::duration<double, std::milli> now =
      std::chrono::steady_clock::now().time_since_epoch();
  return now.count();
}

/// One row per step, one column per frame.
class Timings {
 public:
  explicit Timings(Clock clock = Clock::Wall) : clock_(clock) {}

  /// Calls step() and books its milliseconds under `name`; steps keep the order of the first frame.
  template <class Step>
  decltype(auto) measure(const std::string& name, Step&& step) {
    const Booking booking{*this, name, nowMs(clock_)};
    return std::forward<Step>(step)();
  }

  /// Forgets what was measured, so that a warm-up does not count.
  void clear() { rows_.clear(); }

  void printRows() const {
    std::printf("%-14s %10s %10s %10s\n", "stage", "99 % ms", "mean ms", "median ms");
    for (const Row& row : rows_)
      std::printf("%-14s %10.3f %10.3f %10.3f\n", row.name.c_str(), percentile99(row.ms),
                  mean(row.ms), median(row.ms));
  }

  /// Median over the frames of one row; 0 if there is none.
  [[nodiscard]] double of(const std::string& name) const {
    for (const Row& row : rows_)
      if (row.name == name) return median(row.ms);
    return 0;
  }

  /// Median over the frames of the sum of all rows but those of `without`.
  [[nodiscard]] double total(const std::vector<std::string>& without = {}) const {
    std::vector<double> sums;
    for (const Row& row : rows_) {
      if (std::find(without.begin(), without.end(), row.name) != without.end()) continue;
      sums.resize(std::max(sums.size(), row.ms.size()));
      for (size_t i = 0; i < row.ms.size(); ++i) sums[i] += row.ms[i];
    }
    return median(std::move(sums));
  }

 private:
  struct Row {
    std::string name;
    std::vector<double> ms;
  };
  struct Booking {
    Timings& timings;
    const std::string& name;
    double startMs;
    ~Booking() { timings.rowOf(name).ms.push_back(nowMs(timings.clock_) - startMs); }
  };

  Row& rowOf(const std::string& name) {
    for (Row& row : rows_)
      if (row.name == name) return row;
    return rows_.emplace_back(Row{name, {}});
  }

  Clock clock_;
  std::vector<Row> rows_;
};

}  // namespace rg::bench
