// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/merge_contraction.hpp"

#include "core/base/forest.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace rg::objects {
namespace {

constexpr uint32_t kNone = UINT32_MAX;
constexpr int kMutualRounds =
    24;  // Random weights need under 20; a chain of rising ones any number.
constexpr int kMaxRounds = 64;
constexpr size_t kManyShare = 16;  // Of all groups.
// Links that mutual rounds look at, at most: a node that many touch changes in each of the rounds,
// and all of those with it. Footage looks at each of its links ten times; where a frame of 640x480
// holds as many regions as can be made of it, that are 300 000 visits.
constexpr uint64_t kFewVisits = uint64_t{1} << 20;
constexpr uint64_t kVisitsPerLink = 3;

/// A group is called by its smallest node here, where groupOf has its name. Its neighbours lie
/// where those of its nodes lay, in a chain of their places; they get fewer only, so there is
/// always room.
class Contraction {
 public:
  Contraction(MergeScratch& s, std::vector<uint32_t>& groupOf) : s_(s), groupOf_(groupOf) {}

  void run() {
    begin();
    bool isHooking = false;
    for (int round = 0; round < kMaxRounds && !s_.changed.empty(); ++round) {
      if (!isHooking && (isLong() || round == kMutualRounds)) {
        isHooking = true;
        s_.isCutShort |= round < kMutualRounds;
        listGroups();
      }
      for (const uint32_t group : s_.changed) tidy(group);
      for (const uint32_t group : s_.changed) chooseBest(group);
      joinChoices(isHooking);
    }
    s_.contractionVisits += visits_;
    for (uint32_t i = 0; i < groupOf_.size(); ++i) groupOf_[i] = groupOf_[rootOf(s_.parent, i)];
  }

 private:
  using Link = WeightedArc;
  using TieKey = std::tuple<uint32_t, uint32_t, uint32_t>;

  [[nodiscard]] bool isLong() const {
    return visits_ > kFewVisits + kVisitsPerLink * s_.neighbours.size();
  }

  /// Every node alone, then joined as `groupOf` says.
  void begin() {
    const auto nodeCount = static_cast<uint32_t>(groupOf_.size());
    s_.links = s_.neighbours;
    s_.parent.resize(nodeCount);
    std::iota(s_.parent.begin(), s_.parent.end(), 0u);
    s_.lastPlace = s_.parent;
    s_.nextPlace.assign(nodeCount, kNone);
    s_.linkCount.resize(nodeCount);
    for (uint32_t i = 0; i < nodeCount; ++i) s_.linkCount[i] = s_.firstArc[i + 1] - s_.firstArc[i];
    s_.linkAt.assign(nodeCount, 0);
    s_.seen.assign(nodeCount, 0);
    s_.best.assign(nodeCount, kNone);
    s_.time = 0;
    std::vector<uint32_t>& firstOf = s_.best;
    for (uint32_t i = 0; i < nodeCount; ++i) {
      uint32_t& first = firstOf[groupOf_[i]];
      if (first == kNone)
        first = i;
      else
        joinGroups(first, i);
    }
    s_.best.assign(nodeCount, kNone);
    listGroups();
    s_.joined.reserve(nodeCount);
  }

  /// All of them, as if they had changed.
  void listGroups() {
    s_.changed.clear();
    s_.changed.reserve(groupOf_.size());
    for (uint32_t i = 0; i < groupOf_.size(); ++i)
      if (s_.parent[i] == i) s_.changed.push_back(i);
  }

  template <class Visit>
  void forLinks(uint32_t group, const Visit& visit) {
    for (uint32_t place = group; place != kNone; place = s_.nextPlace[place]) {
      visits_ += s_.linkCount[place];
      for (uint32_t i = 0; i < s_.linkCount[place]; ++i) visit(s_.links[s_.firstArc[place] + i]);
    }
  }

  /// Two different groups, each called by its smallest node.
  void joinGroups(uint32_t a, uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    s_.parent[high] = low;
    groupOf_[low] = std::min(groupOf_[low], groupOf_[high]);
    s_.nextPlace[s_.lastPlace[low]] = high;
    s_.lastPlace[low] = s_.lastPlace[high];
  }

  /// Brings the names of a group's neighbours up to date and lists each of them once.
  void tidy(uint32_t group) {
    ++s_.time;
    uint32_t place = group, count = 0;
    for (uint32_t from = group; from != kNone; from = s_.nextPlace[from]) {
      const uint32_t links = s_.linkCount[from];
      visits_ += links;
      for (uint32_t i = 0; i < links; ++i) {
        const Link link = s_.links[s_.firstArc[from] + i];
        const uint32_t other = rootOf(s_.parent, link.b);
        if (other == group) continue;
        if (s_.seen[other] == s_.time) {
          s_.links[s_.linkAt[other]].weight += link.weight;
          continue;
        }
        while (s_.firstArc[place] + count == s_.firstArc[place + 1]) {
          s_.linkCount[place] = count;
          place = s_.nextPlace[place];
          count = 0;
        }
        s_.seen[other] = s_.time;
        s_.linkAt[other] = s_.firstArc[place] + count++;
        s_.links[s_.linkAt[other]] = {group, other, link.weight};
      }
    }
    s_.linkCount[place] = count;
    s_.nextPlace[place] = kNone;
    s_.lastPlace[group] = place;
  }

  /// Equal weights (a checkerboard) must not queue up along the groups' numbers, which would cost a
  /// round per group.
  [[nodiscard]] TieKey tieKey(uint32_t a, uint32_t b) const {
    const auto [low, high] = std::minmax(groupOf_[a], groupOf_[b]);
    return {mixHash(low, high, 1), low, high};
  }

  void chooseBest(uint32_t group) {
    uint32_t best = kNone;
    int64_t most = 0;
    TieKey bestKey{};
    bool hasKey = false;  // It is made when there is a tie.
    forLinks(group, [&](const Link& link) {
      if (link.weight < most || link.weight <= 0) return;
      if (link.weight > most) {
        hasKey = false;
      } else {
        const TieKey key = tieKey(group, link.b);
        if (!hasKey) bestKey = tieKey(group, best);
        hasKey = true;
        if (bestKey < key) return;
        bestKey = key;
      }
      best = link.b;
      most = link.weight;
    });
    s_.best[group] = best;
  }

  /// Joins the pairs that choose each other, or (isHooking) everybody with its choice. Who did not
  /// change in the round before has no new choice, nor is it one.
  void joinChoices(bool isHooking) {
    s_.joined.clear();
    for (const uint32_t group : s_.changed) {
      const uint32_t other = s_.best[group];
      if (other == kNone || (!isHooking && s_.best[other] != group)) continue;
      s_.joined.push_back(group);
    }
    ++s_.time;
    s_.changed.clear();
    for (const uint32_t group : s_.joined) {
      const uint32_t a = rootOf(s_.parent, group), b = rootOf(s_.parent, s_.best[group]);
      if (a == b) continue;
      noteChange(std::min(a, b), std::max(a, b));
      joinGroups(a, b);
    }
    const auto isGone = [&](uint32_t group) { return s_.parent[group] != group; };
    if (kManyShare * s_.changed.size() < groupOf_.size()) {
      std::erase_if(s_.changed, isGone);
      return;
    }
    // Neighbours lie near each other: many are faster in the order of their numbers.
    s_.changed.clear();
    for (uint32_t group = 0; group < groupOf_.size(); ++group)
      if (s_.seen[group] == s_.time && !isGone(group)) s_.changed.push_back(group);
  }

  /// Beside itself a joined group changes what its neighbours see: those of the higher one lose it,
  /// those of the lower one may know it by another name.
  void noteChange(uint32_t low, uint32_t high) {
    const auto note = [&](uint32_t group) {
      if (s_.seen[group] == s_.time) return;
      s_.seen[group] = s_.time;
      s_.changed.push_back(group);
    };
    note(low);
    forLinks(high, [&](const Link& link) { note(link.b); });
    if (groupOf_[high] < groupOf_[low]) forLinks(low, [&](const Link& link) { note(link.b); });
  }

  MergeScratch& s_;
  std::vector<uint32_t>& groupOf_;
  uint64_t visits_ = 0;  ///< Of links.
};

}  // namespace

void contract(MergeScratch& scratch, std::vector<uint32_t>& groupOf) {
  Contraction(scratch, groupOf).run();
}

}  // namespace rg::objects
