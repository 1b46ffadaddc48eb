// SPDX-License-Identifier: LGPL-2.1-or-later
// Where results come from, in the user's own words: the name of a camera, and tags.
#pragma once

#include "core/base/result.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rg::text {

/// Each of the two texts that users give is at most so long: it stands in every line.
inline constexpr size_t kMostOriginBytes = 4096;

/// Keys and values, in the order in which they were given; no key twice.
using Tags = std::vector<std::pair<std::string, std::string>>;

/// All texts are UTF-8.
struct Origin {
  std::string source;
  Tags tags;
  [[nodiscard]] bool isEmpty() const { return source.empty() && tags.empty(); }
};

/// Reads KEY=VALUE, KEY=VALUE, …: keys begin with a letter and go on with letters, digits, '_', '-'
/// and '.'; a value that holds a comma or begins or ends with a blank stands in double quotes, in
/// which a backslash takes the next character as it is. Errors say where the text is none.
[[nodiscard]] Result<Tags> parseTags(std::string_view text);

}  // namespace rg::text
