// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/contact_calm.hpp"

#include "core/base/time/time.hpp"

#include <algorithm>

namespace rg {
namespace {

/// Longer than the steps of two people who touch while they walk, shorter than a meeting.
constexpr int64_t kCalmNs = 2'000'000'000;

bool isCalm(std::optional<int64_t> sinceNs, std::optional<int64_t> nowNs) {
  return !sinceNs || !nowNs || *nowNs < *sinceNs || timeBetween(*sinceNs, *nowNs) >= kCalmNs;
}

}  // namespace

void ContactCalm::note(const Contact& contact, std::optional<int64_t> timeNs) {
  Known& known = known_[contact.ids];
  known.isMerged = contact.isMerged;
  known.isDue = isCalm(known.changedNs, timeNs);
  known.changedNs = timeNs;
}

std::vector<Contact> ContactCalm::take(std::optional<int64_t> timeNs) {
  std::vector<Contact> due;
  for (auto& [ids, known] : known_) {
    const bool isNews = known.wasTold != known.isMerged;
    if (isNews && (known.isDue || isCalm(known.changedNs, timeNs))) {
      due.push_back({ids, known.isMerged});
      known.wasTold = known.isMerged;
    }
    known.isDue = false;
  }
  return due;
}

void ContactCalm::forget(uint64_t id) {
  std::erase_if(known_, [&](const auto& entry) {
    return std::find(entry.first.begin(), entry.first.end(), id) != entry.first.end();
  });
}

}  // namespace rg
