// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/evidence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rg {
namespace {

using testing::ElementsAre;

Evidence drawn(const std::vector<std::string>& rows) {
  Evidence e;
  e.frame = e.grid = {static_cast<int>(rows[0].size()), static_cast<int>(rows.size())};
  for (const std::string& row : rows)
    for (const char c : row) e.group.push_back(c == '#');
  return e;
}

std::vector<uint32_t> cellsOfPieces(const Evidence& e, const std::vector<uint16_t>& owner) {
  PieceScratch scratch;
  std::vector<Piece> pieces;
  findPieces(e, owner, scratch, pieces);
  std::vector<uint32_t> cells;
  for (const Piece& piece : pieces) cells.push_back(piece.cells);
  return cells;
}

TEST(Evidence, PiecesAreConnectedThroughCornersInRasterOrder) {
  const Evidence e = drawn({"#..##", ".#...", "...#.", "#.#.."});
  EXPECT_THAT(cellsOfPieces(e, std::vector<uint16_t>(20, 0)), ElementsAre(2, 2, 2, 1));
}

TEST(Evidence, BranchesThatMeetLaterAreOnePiece) {
  const Evidence e = drawn({"#...#", "#.#.#", "#####"});
  EXPECT_THAT(cellsOfPieces(e, std::vector<uint16_t>(15, 0)), ElementsAre(10));
}

TEST(Evidence, OwnedCellsAreNoPieces) {
  const Evidence e = drawn({"###", "###", "###"});
  std::vector<uint16_t> owner(9, 0);
  owner[3] = owner[4] = owner[5] = 1;
  EXPECT_THAT(cellsOfPieces(e, owner), ElementsAre(3, 3));
}

TEST(Evidence, CellsSampleTheGroupsThatAreNoBackground) {
  auto labels = std::make_shared<Labels>();
  labels->size = {640, 480};
  labels->ids.resize(labels->size);
  labels->ids.fill(1);
  for (int y = 100; y < 200; ++y)
    for (int x = 100; x < 150; ++x) labels->ids.at(x, y) = 2;
  labels->count = 2;
  Graph graph;
  graph.size = labels->size;
  graph.labels = labels;
  Evidence e;
  gather(graph, std::vector<uint32_t>{0, 1}, std::vector<uint8_t>{1, 0}, e);
  EXPECT_EQ(e.stepPx, 2);
  EXPECT_EQ(e.grid, (Size{320, 240}));
  EXPECT_THAT(e.cellsOf, ElementsAre(0, 25 * 50));
  EXPECT_EQ(e.group[e.at(60, 60)], 2);
  EXPECT_EQ(e.group[e.at(10, 10)], 0);
}

}  // namespace
}  // namespace rg
