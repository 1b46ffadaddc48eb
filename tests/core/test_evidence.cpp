// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/evidence.hpp"
#include "tests/core/scenes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace rg {
namespace {

using testing::ElementsAre;

Evidence drawn(const std::vector<std::string>& rows) {
  Evidence e;
  e.frame = e.grid = {static_cast<int>(rows[0].size()), static_cast<int>(rows.size())};
  for (const std::string& row : rows)
    for (const char c : row) e.group.push_back(c == '#');
  e.listRuns();
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

/// Each row of the labels that cutPieces leaves, a digit a cell.
std::vector<std::string> cutRows(const std::vector<std::string>& rows) {
  const Evidence e = drawn(rows);
  PieceScratch scratch;
  std::vector<Piece> pieces;
  findPieces(e, std::vector<uint16_t>(e.group.size(), 0), scratch, pieces);
  cutPieces(e, scratch, pieces);
  std::vector<std::string> result(rows.size());
  std::vector<Piece> counted(pieces.size());
  for (int y = 0; y < e.grid.height; ++y)
    for (int x = 0; x < e.grid.width; ++x) {
      const uint32_t label = scratch.label[e.at(x, y)];
      result[static_cast<size_t>(y)] += label == 0 ? '.' : static_cast<char>('0' + label);
      if (label == 0) continue;
      ++counted[label - 1].cells;
      counted[label - 1].box = unite(counted[label - 1].box, {x, y, 1, 1});
    }
  for (size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_EQ(pieces[i].cells, counted[i].cells);
    EXPECT_EQ(pieces[i].box, counted[i].box);
  }
  return result;
}

TEST(Evidence, TwoThingsThatTouchAreCutAtTheJoint) {
  EXPECT_THAT(cutRows({"##...##.#", "##...##.#", "#######.#", "##...##.#"}),
              ElementsAre("11...33.2", "11...33.2", "1133333.2", "11...33.2"));
}

TEST(Evidence, ABodyIsNotCutFromItsLegsAndArms) {
  const std::vector<std::string> body = {"...##...", "..####..", ".######.",
                                         "...##...", "..####..", ".##..##."};
  std::vector<std::string> labels = body;
  for (std::string& row : labels) std::replace(row.begin(), row.end(), '#', '1');
  EXPECT_EQ(cutRows(body), labels);
}

TEST(Evidence, MoversThatTouchAreApartByTheirMotion) {
  Evidence e = drawn({"####", "####"});
  for (size_t cell = 0; cell < e.group.size(); ++cell) e.group[cell] = cell % 4 < 2 ? 1 : 2;
  e.cellsOf = {4, 4};
  e.motionOf = {{20, 0}, {30, 0}};
  const auto count = [&] {
    PieceScratch scratch;
    std::vector<Piece> pieces;
    findPieces(e, {}, scratch, pieces);
    return pieces.size();
  };
  EXPECT_EQ(count(), 1u);
  e.showsMovers = true;
  EXPECT_EQ(count(), 2u);
  e.motionOf[1] = {22, 0};  // Parts of one thing.
  EXPECT_EQ(count(), 1u);
  e.motionOf[1] = {30, 0};
  e.cellsOf = {4, 40};  // A bit of the other.
  EXPECT_EQ(count(), 1u);
}

TEST(Evidence, CellsSampleTheGroupsThatAreNoBackground) {
  auto labels = std::make_shared<Labels>();
  labels->size = {640, 480};
  labels->ids.resize(labels->size);
  labels->ids.fill(1);
  for (int y = 100; y < 200; ++y)
    for (int x = 100; x < 150; ++x) labels->ids.at(x, y) = 2;
  labels->count = 2;
  const auto picture = scenes::paintGrey(labels->size, [](int, int) { return 9; });
  labels->picture = picture;
  labels->status = Status::Ok;
  const auto graph = *makeGraphStage(scenes::contextWith(1))->process(labels, {});
  Evidence e;
  gather(*graph, std::vector<uint32_t>{0, 1}, std::vector<uint8_t>{1, 0},
         std::vector<uint32_t>{0, 7}, e);
  EXPECT_EQ(e.stepPx, 2);
  EXPECT_EQ(e.grid, (Size{320, 240}));
  EXPECT_THAT(e.cellsOf, ElementsAre(0, 25 * 50));
  EXPECT_EQ(e.group[e.at(60, 60)], 2);
  EXPECT_EQ(e.group[e.at(10, 10)], 0);
  EXPECT_EQ(e.expected[e.at(60, 60)], 7);
  EXPECT_EQ(e.runs.size(), 50u);
  EXPECT_EQ(e.runs.front(), (RegionRun{50, 50, 75}));
}

}  // namespace
}  // namespace rg
