// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/ownership/region_parts.hpp"

#include "core/base/forest.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rg::objects {
namespace {

bool areAlike(const RegionPart& a, const RegionPart& b) {
  return a.region == b.region && a.claim == b.claim && a.partedFrom == b.partedFrom;
}

}  // namespace

void RegionParts::find(const GroupGrid& e, std::span<const uint16_t> claims,
                       std::span<const uint16_t> partedFrom) {
  contacts_.clear();
  listRuns(e, claims, partedFrom);
  touchRows();
  number(e);
  sumContacts();
}

void RegionParts::listRuns(const GroupGrid& e, std::span<const uint16_t> claims,
                           std::span<const uint16_t> partedFrom) {
  runs_.clear();
  ofRun_.clear();
  for (const Run& run : e.runs)
    for (uint16_t x = run.begin; x < run.end; ++x) {
      const size_t cell = e.at(x, run.y);
      const RegionPart part{e.region[cell], e.expected[cell], claims[cell], partedFrom[cell], 0};
      if (x == run.begin || !areAlike(ofRun_.back(), part)) {
        runs_.push_back({{run.y, x, x}, 0});
        ofRun_.push_back(part);
      }
      ++runs_.back().cells.end;
    }
  parent_.resize(runs_.size());
  std::iota(parent_.begin(), parent_.end(), 0u);
}

/// Along each row, and between each row and the one above it.
void RegionParts::touchRows() {
  uint32_t above = 0;
  for (uint32_t i = 0; i < runs_.size(); ++i) {
    const Run& run = runs_[i].cells;
    if (i > 0 && runs_[i - 1].cells.y == run.y && runs_[i - 1].cells.end == run.begin)
      touch(i, i - 1, 1);
    while (runs_[above].cells.y + 1 < run.y ||
           (runs_[above].cells.y + 1 == run.y && runs_[above].cells.end <= run.begin))
      ++above;
    for (uint32_t j = above; runs_[j].cells.y + 1 == run.y && runs_[j].cells.begin < run.end; ++j)
      touch(i, j,
            std::min(run.end, runs_[j].cells.end) - std::max(run.begin, runs_[j].cells.begin));
  }
}

void RegionParts::touch(uint32_t run, uint32_t other, int cells) {
  if (areAlike(ofRun_[run], ofRun_[other]))
    join(parent_, run, other);
  else
    contacts_.push_back({other, run, static_cast<uint32_t>(cells)});
}

void RegionParts::number(const GroupGrid& e) {
  parts_.resize(numberSets(parent_));
  for (RegionPart& part : parts_) part = {};
  partAt_.resize(e.region.size());
  for (size_t i = 0; i < runs_.size(); ++i) {
    const Run& run = runs_[i].cells;
    const uint32_t number = runs_[i].part = parent_[i];
    RegionPart& part = parts_[number];
    const uint32_t before = part.cells;
    part = ofRun_[i];
    part.cells = before + run.end - run.begin;
    std::fill_n(partAt_.data() + e.at(run.begin, run.y), run.end - run.begin, number);
  }
}

void RegionParts::sumContacts() {
  for (PartContact& contact : contacts_) {
    contact.a = parent_[contact.a];
    contact.b = parent_[contact.b];
    if (contact.a > contact.b) std::swap(contact.a, contact.b);
  }
  std::sort(contacts_.begin(), contacts_.end(), [](const PartContact& p, const PartContact& q) {
    return p.a != q.a ? p.a < q.a : p.b < q.b;
  });
  size_t count = 0;
  for (const PartContact& contact : contacts_) {
    PartContact* last = count > 0 ? &contacts_[count - 1] : nullptr;
    if (last && last->a == contact.a && last->b == contact.b)
      last->border += contact.border;
    else
      contacts_[count++] = contact;
  }
  contacts_.resize(count);
}

}  // namespace rg::objects
