// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/origin.hpp"

#include <algorithm>

namespace rg::text {
namespace {

constexpr std::string_view kBlanks = " \t\n";

bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool isKeyCharacter(char c) {
  return isLetter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
}

void skipBlanks(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
}

std::string_view takeKey(std::string_view& rest) {
  const auto end = std::find_if_not(rest.begin(), rest.end(), isKeyCharacter);
  const auto key = rest.substr(0, static_cast<size_t>(end - rest.begin()));
  rest.remove_prefix(key.size());
  return key;
}

/// What stands in quotes, without them. False where they are not closed.
bool takeQuoted(std::string_view& rest, std::string& value) {
  rest.remove_prefix(1);
  while (!rest.empty() && rest.front() != '"') {
    if (rest.front() == '\\') rest.remove_prefix(1);
    if (rest.empty()) return false;
    value += rest.front();
    rest.remove_prefix(1);
  }
  if (rest.empty()) return false;
  rest.remove_prefix(1);
  return true;
}

void takePlain(std::string_view& rest, std::string& value) {
  const auto text = rest.substr(0, rest.find(','));
  rest.remove_prefix(text.size());
  value = text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

Error errorAt(std::string_view text, std::string_view rest, const char* what) {
  return {"tags at character " + std::to_string(text.size() - rest.size() + 1) + ": " + what};
}

}  // namespace

Result<Tags> parseTags(std::string_view text) {
  Tags tags;
  std::string_view rest = text;
  skipBlanks(rest);
  while (!rest.empty()) {
    std::string value;
    const std::string_view begin = rest, key = takeKey(rest);
    if (key.empty() || !isLetter(key.front()))
      return errorAt(text, begin, "a key begins with a letter");
    if (std::any_of(tags.begin(), tags.end(), [&](const auto& tag) { return tag.first == key; }))
      return errorAt(text, begin, "this key was there before");
    skipBlanks(rest);
    if (rest.empty() || rest.front() != '=')
      return errorAt(text, rest, "a key is followed by = and its value");
    rest.remove_prefix(1);
    skipBlanks(rest);
    const bool isQuoted = !rest.empty() && rest.front() == '"';
    if (!isQuoted)
      takePlain(rest, value);
    else if (!takeQuoted(rest, value))
      return errorAt(text, rest, "a quote is not closed");
    skipBlanks(rest);
    if (!rest.empty() && rest.front() != ',') return errorAt(text, rest, "a comma parts two tags");
    tags.emplace_back(key, std::move(value));
    if (rest.empty()) break;
    rest.remove_prefix(1);
    skipBlanks(rest);
    if (rest.empty()) return errorAt(text, rest, "nothing follows the comma");
  }
  return tags;
}

}  // namespace rg::text
