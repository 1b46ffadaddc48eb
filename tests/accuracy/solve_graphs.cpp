// SPDX-License-Identifier: LGPL-2.1-or-later
// Groups the nodes of graphs as mrfmerge does and tells how good that is. energy.py feeds it.
//
// Standard input: for each graph one line "NODES ARCS a b weight a b weight …", nodes from 0, a <
// b, whole weights. Standard output: for each graph one line "KEPT BEST MICROSECONDS": the weight
// of the arcs inside groups, the most that any grouping keeps (−1 for graphs of more than 16
// nodes), and the least processor time of five runs on one thread.
#include "tests/support/best_partition.hpp"

#include <cstdio>
#include <ctime>
#include <iostream>

namespace rg {
namespace {

constexpr uint32_t kSmall = 16;
constexpr int kRuns = 5;

bool readGraph(std::istream& in, uint32_t& nodes, std::vector<objects::WeightedArc>& arcs) {
  size_t count = 0;
  if (!(in >> nodes >> count)) return false;
  arcs.resize(count);
  for (objects::WeightedArc& arc : arcs)
    if (!(in >> arc.a >> arc.b >> arc.weight) || arc.a >= arc.b || arc.b >= nodes) return false;
  return true;
}

int run() {
  objects::MergeScratch scratch;
  uint32_t nodes = 0;
  std::vector<objects::WeightedArc> arcs;
  std::vector<uint32_t> groupOf;
  while (readGraph(std::cin, nodes, arcs)) {
    double leastUs = 1e12;
    for (int i = 0; i < kRuns; ++i) {
      groupOf.clear();
      const std::clock_t begin = std::clock();
      objects::minimise(nodes, arcs, scratch, groupOf);
      const double us = 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      leastUs = std::min(leastUs, us);
    }
    const int64_t best = nodes <= kSmall ? testing::bestKeptWeight(nodes, arcs) : -1;
    std::printf("%lld %lld %.1f\n", static_cast<long long>(objects::keptWeight(arcs, groupOf)),
                static_cast<long long>(best), leastUs);
  }
  if (std::cin.eof()) return 0;
  std::cerr << "solve_graphs: a line is not \"NODES ARCS a b weight …\" with a < b < NODES\n";
  return 1;
}

}  // namespace
}  // namespace rg

int main() {
  return rg::run();
}
