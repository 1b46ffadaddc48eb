// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/objects/tracking/pieces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace rg {
namespace {

using testing::ElementsAre;

objects::GroupGrid drawn(const std::vector<std::string>& rows) {
  objects::GroupGrid e;
  e.frame = e.grid = {static_cast<int>(rows[0].size()), static_cast<int>(rows.size())};
  for (const std::string& row : rows)
    for (const char c : row) e.group.push_back(c == '#');
  e.listRuns();
  return e;
}

std::vector<uint32_t> cellsOfPieces(const objects::GroupGrid& e,
                                    const std::vector<uint16_t>& owner) {
  objects::PieceScratch scratch;
  std::vector<objects::Piece> pieces;
  objects::findPieces(e, owner, true, scratch, pieces);
  std::vector<uint32_t> cells;
  for (const objects::Piece& piece : pieces) cells.push_back(piece.cells);
  return cells;
}

TEST(Pieces, AreConnectedThroughCornersInRasterOrder) {
  const objects::GroupGrid e = drawn({"#..##", ".#...", "...#.", "#.#.."});
  EXPECT_THAT(cellsOfPieces(e, std::vector<uint16_t>(20, 0)), ElementsAre(2, 2, 2, 1));
}

TEST(Pieces, BranchesThatMeetLaterAreOnePiece) {
  const objects::GroupGrid e = drawn({"#...#", "#.#.#", "#####"});
  EXPECT_THAT(cellsOfPieces(e, std::vector<uint16_t>(15, 0)), ElementsAre(10));
}

TEST(Pieces, OwnedCellsAreNoPieces) {
  const objects::GroupGrid e = drawn({"###", "###", "###"});
  std::vector<uint16_t> owner(9, 0);
  owner[3] = owner[4] = owner[5] = 1;
  EXPECT_THAT(cellsOfPieces(e, owner), ElementsAre(3, 3));
}

TEST(Pieces, AScratchServesGridsOfAnySize) {
  const objects::GroupGrid wide = drawn({"#..#..#..#", "..........", "#########."});
  const objects::GroupGrid tall = drawn({"##", "..", "##", "..", "##", "..", "##", ".#"});
  const objects::GroupGrid tiny = drawn({"#"});
  objects::PieceScratch scratch;
  std::vector<objects::Piece> pieces;
  for (const objects::GroupGrid* e : {&wide, &tall, &tiny, &wide, &tiny, &tall}) {
    objects::findPieces(*e, {}, true, scratch, pieces);
    objects::PieceScratch fresh;
    std::vector<objects::Piece> expected;
    objects::findPieces(*e, {}, true, fresh, expected);
    EXPECT_EQ(scratch.label, fresh.label);
    EXPECT_EQ(pieces.size(), expected.size());
  }
}

/// Each row of the labels that cutPieces leaves, a digit a cell.
std::vector<std::string> cutRows(const std::vector<std::string>& rows) {
  const objects::GroupGrid e = drawn(rows);
  objects::PieceScratch scratch;
  std::vector<objects::Piece> pieces;
  objects::findPieces(e, std::vector<uint16_t>(e.group.size(), 0), true, scratch, pieces);
  objects::cutPieces(e, scratch, pieces);
  std::vector<std::string> result(rows.size());
  std::vector<objects::Piece> counted(pieces.size());
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

TEST(Pieces, TwoThingsThatTouchAreCutAtTheJoint) {
  EXPECT_THAT(cutRows({"##...##.#", "##...##.#", "#######.#", "##...##.#"}),
              ElementsAre("11...33.2", "11...33.2", "1133333.2", "11...33.2"));
}

TEST(Pieces, AreOfOneGroupAlsoWhereTheyAreCut) {
  objects::GroupGrid e = drawn({"##...####", "##...##.#", "#######.#", "##...##.#"});
  for (int y = 0; y < e.grid.height; ++y)
    for (int x = 0; x < e.grid.width; ++x)
      if (uint16_t& group = e.group[e.at(x, y)]; group != 0) group = x < 7 ? 1 : 2;
  e.listRuns();
  objects::PieceScratch scratch;
  std::vector<objects::Piece> pieces;
  objects::findPieces(e, {}, true, scratch, pieces);
  objects::cutPieces(e, scratch, pieces);
  std::vector<int> groups;
  for (const objects::Piece& piece : pieces) groups.push_back(piece.group);
  EXPECT_THAT(groups, ElementsAre(1, 2, 1));
}

TEST(Pieces, ABodyIsNotCutFromItsLegsAndArms) {
  const std::vector<std::string> body = {"...##...", "..####..", ".######.",
                                         "...##...", "..####..", ".##..##."};
  std::vector<std::string> labels = body;
  for (std::string& row : labels) std::replace(row.begin(), row.end(), '#', '1');
  EXPECT_EQ(cutRows(body), labels);
}

/// The labels of findPieces() by a flood from each cell in raster order.
std::vector<uint32_t> flooded(const objects::GroupGrid& e, const std::vector<uint16_t>& owner,
                              bool areParted) {
  std::vector<uint32_t> labels(e.group.size(), 0);
  uint32_t count = 0;
  const auto isFree = [&](size_t cell) { return e.group[cell] != 0 && owner[cell] == 0; };
  for (size_t start = 0; start < labels.size(); ++start) {
    if (!isFree(start) || labels[start] != 0) continue;
    std::vector<size_t> open{start};
    labels[start] = ++count;
    while (!open.empty()) {
      const size_t cell = open.back();
      open.pop_back();
      const int x = static_cast<int>(cell) % e.grid.width;
      const int y = static_cast<int>(cell) / e.grid.width;
      for (int i = 0; i < 9; ++i) {
        const Point next{x + i % 3 - 1, y + i / 3 - 1};
        if (!boundsOf(e.grid).contains(next)) continue;
        const size_t other = e.at(next.x, next.y);
        if (!isFree(other) || labels[other] != 0) continue;
        if (areParted && e.group[other] != e.group[start]) continue;
        labels[other] = count;
        open.push_back(other);
      }
    }
  }
  return labels;
}

TEST(Pieces, AreThoseOfAFloodOnNoiseOfGroupsAndOwners) {
  objects::PieceScratch scratch;  // Kept: what a frame leaves there must not show in the next.
  for (uint32_t seed = 0; seed < 60; ++seed) {
    objects::GroupGrid e;
    e.frame = e.grid = {1 + static_cast<int>(seed * 7 % 40), 1 + static_cast<int>(seed * 3 % 17)};
    std::vector<uint16_t> owner;
    for (uint32_t i = 0; i < static_cast<uint32_t>(e.grid.area()); ++i) {
      e.group.push_back(static_cast<uint16_t>(mixHash(i, seed, 1) % (2 + seed % 3)));
      owner.push_back(mixHash(i, seed, 2) % 4 == 0);
    }
    e.listRuns();
    std::vector<objects::Piece> pieces;
    const bool areParted = seed % 2 == 0;
    objects::findPieces(e, owner, areParted, scratch, pieces);
    ASSERT_EQ(scratch.label, flooded(e, owner, areParted)) << "seed " << seed;
    for (uint32_t i = 0; i < pieces.size(); ++i)
      EXPECT_EQ(pieces[i].cells, std::count(scratch.label.begin(), scratch.label.end(), i + 1));
  }
}

}  // namespace
}  // namespace rg
