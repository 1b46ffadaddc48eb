// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/assignment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rg {
namespace {

using testing::ElementsAre;

std::vector<int> solve(const std::vector<int64_t>& costs, int rows, int columns, int64_t leaveOut) {
  objects::Assignment assignment;
  assignment.solve(costs, rows, columns, leaveOut);
  std::vector<int> result;
  for (int row = 0; row < rows; ++row) result.push_back(assignment.columnOf(row));
  return result;
}

TEST(Assignment, TakesTheCheapestWholeRatherThanTheCheapestPair) {
  EXPECT_THAT(solve({1, 2, 2, 9}, 2, 2, 100), ElementsAre(1, 0));
}

TEST(Assignment, LeavesOutWhatIsForbiddenOrTooDear) {
  EXPECT_THAT(solve({objects::kForbidden, 50}, 2, 1, 20), ElementsAre(-1, -1));
  EXPECT_THAT(solve({5, 7}, 2, 1, 20), ElementsAre(0, -1));
  EXPECT_TRUE(solve({}, 0, 0, 1).empty());
  EXPECT_THAT(solve({}, 2, 0, 1), ElementsAre(-1, -1));
}

TEST(Assignment, IsOptimalOnRandomCosts) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> cost(0, 60), side(1, 5);
  for (int n = 0; n < 500; ++n) {
    const int rows = side(random), columns = side(random);
    constexpr int64_t kLeaveOut = 30;
    std::vector<int64_t> costs(static_cast<size_t>(rows * columns));
    for (int64_t& c : costs) c = cost(random);
    const auto total = [&](const std::vector<int>& columnOf) {
      int64_t sum = 0;
      for (int row = 0; row < rows; ++row) {
        const int column = columnOf[static_cast<size_t>(row)];
        sum += column < 0 ? kLeaveOut : costs[static_cast<size_t>(row * columns + column)];
      }
      return sum;
    };
    // All ways: permutations of the columns and as many blanks as rows.
    std::vector<int> order(static_cast<size_t>(rows), -1);
    for (int column = 0; column < columns; ++column) order.push_back(column);
    int64_t best = INT64_MAX;
    do best = std::min(best, total(order));
    while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(total(solve(costs, rows, columns, kLeaveOut)), best);
  }
}

}  // namespace
}  // namespace rg
