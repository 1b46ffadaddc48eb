// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/ownership/region_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace rg {

namespace objects {
bool operator==(const PartContact& p, const PartContact& q) {
  return p.a == q.a && p.b == q.b && p.border == q.border;
}
}  // namespace objects

namespace {

using objects::PartContact;
using testing::ElementsAre;
using Rows = std::vector<std::string>;

std::vector<uint16_t> numbers(const Rows& rows, char nothing) {
  std::vector<uint16_t> result;
  for (const std::string& row : rows)
    for (const char c : row)
      result.push_back(c == nothing ? uint16_t{0} : static_cast<uint16_t>(c - '0'));
  return result;
}

/// Digits are regions.
objects::GroupGrid drawn(const Rows& rows) {
  objects::GroupGrid e;
  e.frame = e.grid = {static_cast<int>(rows[0].size()), static_cast<int>(rows.size())};
  e.region = e.group = numbers(rows, '.');
  e.expected.assign(e.region.size(), 0);
  e.listRuns();
  return e;
}

struct Found {
  explicit Found(const Rows& regions, const Rows& claims = {}, const Rows& partedFrom = {})
      : evidence(drawn(regions)) {
    const std::vector<uint16_t> none(evidence.region.size(), 0);
    parts.find(evidence, claims.empty() ? none : numbers(claims, '.'),
               partedFrom.empty() ? none : numbers(partedFrom, '.'));
  }
  [[nodiscard]] std::vector<uint32_t> cells() const {
    std::vector<uint32_t> result;
    for (const objects::RegionPart& part : parts.list()) result.push_back(part.cells);
    return result;
  }
  objects::GroupGrid evidence;
  objects::RegionParts parts;
};

TEST(RegionParts, RegionsThatNobodyClaimsStayWhole) {
  const Found found({"1122", "1122", "...2"});
  EXPECT_THAT(found.cells(), ElementsAre(4, 5));
  EXPECT_EQ(found.parts.list()[1].region, 2);
  EXPECT_THAT(found.parts.contacts(), ElementsAre(PartContact{0, 1, 2}));
}

TEST(RegionParts, AreCutWhereClaimsEnd) {
  const Found found({"1111", "1111"}, {"33..", "33.."});
  EXPECT_THAT(found.cells(), ElementsAre(4, 4));
  EXPECT_EQ(found.parts.list()[0].claim, 3);
  EXPECT_EQ(found.parts.list()[1].claim, 0);
}

TEST(RegionParts, AreCutWhereATrackGaveThemUp) {
  const Found found({"1111"}, {"...."}, {".55."});
  EXPECT_THAT(found.cells(), ElementsAre(1, 2, 1));
  EXPECT_EQ(found.parts.list()[1].partedFrom, 5);
}

TEST(RegionParts, CornersDoNotConnect) {
  const Found found({"1.", ".1"});
  EXPECT_THAT(found.cells(), ElementsAre(1, 1));
  EXPECT_TRUE(found.parts.contacts().empty());
}

TEST(RegionParts, BranchesThatMeetLaterAreOnePart) {
  EXPECT_THAT(Found({"1.1.1", "1.1.1", "11111"}).cells(), ElementsAre(11));
}

TEST(RegionParts, CountWhatTouchesOfARing) {
  const Found found({"1111", "1221", "1111"});
  EXPECT_THAT(found.cells(), ElementsAre(10, 2));
  EXPECT_THAT(found.parts.contacts(), ElementsAre(PartContact{0, 1, 6}));
}

/// By flooding each cell's part.
std::vector<uint32_t> flooded(const objects::GroupGrid& e, const std::vector<uint16_t>& claims) {
  std::vector<uint32_t> part(e.region.size(), UINT32_MAX);
  uint32_t count = 0;
  e.forForeground([&](size_t cell, int x, int y) {
    if (part[cell] != UINT32_MAX) return;
    std::vector<Point> open{{x, y}};
    part[cell] = count;
    while (!open.empty()) {
      const Point from = open.back();
      open.pop_back();
      for (const Point d : {Point{1, 0}, Point{-1, 0}, Point{0, 1}, Point{0, -1}}) {
        const Point to{from.x + d.x, from.y + d.y};
        if (!boundsOf(e.grid).contains(to)) continue;
        const size_t next = e.at(to.x, to.y);
        if (part[next] != UINT32_MAX || e.region[next] != e.region[cell] ||
            claims[next] != claims[cell])
          continue;
        part[next] = count;
        open.push_back(to);
      }
    }
    ++count;
  });
  return part;
}

TEST(RegionParts, AreThoseOfAFloodOnGridsOfAnySize) {
  std::mt19937 dice(3);
  objects::RegionParts parts;
  for (int round = 0; round < 200; ++round) {
    Rows rows(1 + dice() % 12, std::string(1 + dice() % 12, '.'));
    std::vector<uint16_t> claims;
    for (std::string& row : rows)
      for (char& c : row) {
        c = ".112"[dice() % 4];
        claims.push_back(dice() % 3 == 0);
      }
    const objects::GroupGrid e = drawn(rows);
    parts.find(e, claims, std::vector<uint16_t>(claims.size(), 0));
    const std::vector<uint32_t> expected = flooded(e, claims);
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> borders;
    uint32_t cells = 0;
    e.forForeground([&](size_t cell, int x, int y) {
      EXPECT_EQ(parts.at(cell), expected[cell]);
      ++cells;
      const auto touch = [&](int toX, int toY) {
        if (!boundsOf(e.grid).contains({toX, toY})) return;
        const size_t other = e.at(toX, toY);
        if (e.group[other] != 0 && expected[other] != expected[cell])
          ++borders[std::minmax(expected[cell], expected[other])];
      };
      touch(x + 1, y);
      touch(x, y + 1);
    });
    for (const objects::RegionPart& part : parts.list()) cells -= part.cells;
    EXPECT_EQ(cells, 0u);
    ASSERT_EQ(parts.contacts().size(), borders.size());
    auto border = borders.begin();
    for (const PartContact& contact : parts.contacts()) {
      EXPECT_EQ(std::pair(contact.a, contact.b), border->first);
      EXPECT_EQ(contact.border, border++->second);
    }
  }
}

}  // namespace
}  // namespace rg
