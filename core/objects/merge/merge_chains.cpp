// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/merge_chains.hpp"

#include "core/objects/merge/empty_groups.hpp"

#include <algorithm>
#include <array>

namespace rg::objects {
namespace {

constexpr size_t kMostFollowers = 5;
constexpr uint32_t kNone = UINT32_MAX;
constexpr size_t kHubArcs = 64;  // Of fewer, walking them is as fast as looking their sum up.

class ChainSearch {
 public:
  ChainSearch(std::vector<uint32_t>& groupOf, MergeScratch& s)
      : groupOf_(groupOf), s_(s), empty_(s.groupSize, s.emptied) {
    s_.gain.resize(groupOf.size());
    s_.notedAt.assign(groupOf.size(), 0);
    s_.groupSize.assign(groupOf.size(), 0);
    for (const uint32_t group : groupOf) ++s_.groupSize[group];
    s_.seen.assign(groupOf.size(), kNone);
    noteChanges();
    findHub();
  }

  bool run() {
    bool hasMoved = false;
    for (uint32_t node = 0; node < groupOf_.size(); ++node) {
      if (!listTargets(node)) continue;
      bool isMoved = false;
      // A chain may change the group of `node`; what was listed holds only as long as none did.
      for (size_t i = 0; i < s_.touched.size() && !isMoved; ++i) {
        if (failsAsBefore(node, s_.touched[i])) continue;
        if (s_.visits >= s_.visitLimit) {
          s_.isCutShort = true;
          return hasMoved;
        }
        isMoved = tryChain(node, s_.touched[i]);
      }
      if (!isMoved) s_.triedAt[node] = s_.chainTime;
      hasMoved |= isMoved;
    }
    return hasMoved;
  }

 private:
  void spend(size_t visits) { s_.visits += visits; }

  /// What happened to the groups since the last search.
  void noteChanges() {
    const size_t count = groupOf_.size();
    if (s_.searched.size() != count) {
      s_.triedAt.assign(count, 0);
      s_.changedAt.assign(count, 1);
      s_.chainTime = 1;
      return;
    }
    ++s_.chainTime;
    for (size_t node = 0; node < count; ++node)
      if (s_.searched[node] != groupOf_[node])
        s_.changedAt[s_.searched[node]] = s_.changedAt[groupOf_[node]] = s_.chainTime;
  }

  /// A chain looks at nothing but two groups: as long as those stay as they were, so does what it
  /// gains.
  [[nodiscard]] bool failsAsBefore(uint32_t node, uint32_t to) const {
    const uint32_t triedAt = s_.triedAt[node];
    return triedAt >= s_.changedAt[groupOf_[node]] && triedAt >= s_.changedAt[to];
  }

  /// The node with most arcs, and how much it is pulled towards each group. It is a neighbour of
  /// so many that its arcs can't be walked anew for each of them.
  void findHub() {
    size_t most = kHubArcs;
    for (uint32_t node = 0; node < groupOf_.size(); ++node)
      if (s_.arcsOf(node).size() > most) {
        most = s_.arcsOf(node).size();
        hub_ = node;
      }
    if (hub_ == kNone) return;
    s_.hubWeight.assign(groupOf_.size(), 0);
    s_.pull.assign(groupOf_.size(), 0);
    for (const WeightedArc& arc : s_.arcsOf(hub_)) {
      s_.hubWeight[arc.b] += arc.weight;
      s_.pull[groupOf_[arc.b]] += arc.weight;
    }
  }

  /// The groups that `node` could go to, into s_.touched. False if it has no motive to go.
  bool listTargets(uint32_t node) {
    s_.touched.clear();
    bool hasMotive = false;
    spend(s_.arcsOf(node).size());
    for (const WeightedArc& arc : s_.arcsOf(node)) {
      const uint32_t group = groupOf_[arc.b];
      hasMotive |= group == groupOf_[node] ? arc.weight < 0 : arc.weight > 0;
      if (group == groupOf_[node] || s_.seen[group] == node || arc.weight == kNever) continue;
      s_.seen[group] = node;
      s_.touched.push_back(group);
    }
    if (!hasMotive) return false;
    const uint32_t empty = empty_.first();
    if (empty < groupOf_.size()) s_.touched.push_back(empty);
    return true;
  }

  [[nodiscard]] int64_t gainOf(uint32_t node, uint32_t to) {
    if (node == hub_) return s_.pull[to] - s_.pull[groupOf_[node]];
    int64_t gain = 0;
    spend(s_.arcsOf(node).size());
    for (const WeightedArc& arc : s_.arcsOf(node)) {
      if (groupOf_[arc.b] == to) gain += arc.weight;
      if (groupOf_[arc.b] == groupOf_[node]) gain -= arc.weight;
    }
    return gain;
  }

  void move(uint32_t node, uint32_t to) {
    --s_.groupSize[groupOf_[node]];
    ++s_.groupSize[to];
    if (hub_ != kNone) {
      s_.pull[groupOf_[node]] -= s_.hubWeight[node];
      s_.pull[to] += s_.hubWeight[node];
    }
    groupOf_[node] = to;
  }

  /// After the chain's last node has changed groups: what each of its neighbours in the two groups
  /// would gain by doing so.
  void noteGains(size_t length, uint32_t a, uint32_t b) {
    const uint32_t mover = chain_[length - 1];
    const auto step = static_cast<uint8_t>(length);
    spend(s_.arcsOf(mover).size());
    for (const WeightedArc& arc : s_.arcsOf(mover)) {
      const uint32_t node = arc.b, group = groupOf_[node];
      if ((group != a && group != b) || s_.notedAt[node] == step) continue;
      if (s_.notedAt[node] != 0) {
        s_.gain[node] += group == groupOf_[mover] ? -2 * arc.weight : 2 * arc.weight;
        continue;
      }
      s_.notedAt[node] = step;
      s_.gain[node] = gainOf(node, group == a ? b : a);
      s_.noted.push_back(node);
    }
  }

  /// The neighbour of the chain that gains most by changing between its two groups.
  [[nodiscard]] uint32_t bestFollower(size_t length, int64_t& gain) {
    uint32_t best = kNone;
    spend(s_.noted.size());
    for (const uint32_t node : s_.noted) {
      if (isInChain(node, length)) continue;
      const int64_t nodeGain = s_.gain[node];
      if (best == kNone || nodeGain > gain || (nodeGain == gain && node < best)) {
        best = node;
        gain = nodeGain;
      }
    }
    return best;
  }

  [[nodiscard]] bool isInChain(uint32_t node, size_t length) const {
    const auto* end = chain_.data() + length;
    return std::find(chain_.data(), end, node) != end;
  }

  bool tryChain(uint32_t node, uint32_t to) {
    const uint32_t from = groupOf_[node];
    int64_t gain = gainOf(node, to), most = 0;
    size_t length = 0, kept = 0;
    while (true) {
      move(node, groupOf_[node] == from ? to : from);
      chain_[length++] = node;
      if (gain > most) {
        most = gain;
        kept = length;
      }
      if (length == chain_.size()) break;
      int64_t more = 0;
      noteGains(length, from, to);
      node = bestFollower(length, more);
      if (node == kNone) break;
      gain += more;
    }
    for (const uint32_t other : s_.noted) s_.notedAt[other] = 0;
    s_.noted.clear();
    for (size_t i = length; i > kept; --i)
      move(chain_[i - 1], groupOf_[chain_[i - 1]] == from ? to : from);
    if (kept == 0) return false;
    s_.changedAt[from] = s_.changedAt[to] = ++s_.chainTime;
    for (const uint32_t group : {from, to})
      if (s_.groupSize[group] == 0) empty_.add(group);
    return true;
  }

  std::vector<uint32_t>& groupOf_;
  MergeScratch& s_;
  std::array<uint32_t, kMostFollowers + 1> chain_{};
  EmptyGroups empty_;
  uint32_t hub_ = kNone;
};

}  // namespace

bool moveChains(std::vector<uint32_t>& groupOf, MergeScratch& scratch) {
  const bool hasMoved = ChainSearch(groupOf, scratch).run();
  scratch.searched = groupOf;
  return hasMoved;
}

}  // namespace rg::objects
