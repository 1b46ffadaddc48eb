// SPDX-License-Identifier: LGPL-2.1-or-later
// Merges and splits as a person would tell of them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace rg {

/// Objects that have come together, or parted.
struct Contact {
  std::vector<uint64_t> ids;
  bool isMerged = false;
};

/// People who walk side by side touch and part several times a second. A change is told at once
/// where the same objects have been at rest for two seconds before; what follows within these is
/// told when it has lasted as long, should it then differ from what was told.
class ContactCalm {
 public:
  /// A change in a frame. Without a time it is told at once.
  void note(const Contact& contact, std::optional<int64_t> timeNs);
  /// What is to be told in a frame, in the order of the ids.
  [[nodiscard]] std::vector<Contact> take(std::optional<int64_t> timeNs);
  /// An object has ended.
  void forget(uint64_t id);
  void clear() { known_.clear(); }

 private:
  struct Known {
    bool isMerged = false;
    std::optional<bool> wasTold;  ///< That they are merged, or parted.
    std::optional<int64_t> changedNs;
    bool isDue = false;
  };
  std::map<std::vector<uint64_t>, Known> known_;
};

}  // namespace rg
