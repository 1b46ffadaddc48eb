// SPDX-License-Identifier: LGPL-2.1-or-later
// The file that an element writes lines to.
#pragma once

#include "core/base/result.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace rg {

/// A file, a pipe or standard output, open for writing. Nothing is buffered: a reader sees a line
/// as soon as write() has returned. Errors name the reason, not the file.
class LineFile {
 public:
  LineFile() = default;
  ~LineFile() { close(); }
  LineFile(LineFile&& other) noexcept;
  LineFile& operator=(LineFile&& other) noexcept;

  /// "-" is standard output. Files are made or emptied, and not handed on to child processes. A
  /// pipe must have a reader.
  [[nodiscard]] static Result<LineFile> open(const std::string& location);

  /// Writes all of the text. A reader that does not read is waited for until isCancelled() says
  /// otherwise; the rest of the text is lost then. A reader that went away is an error, no signal,
  /// and so is the limit of a file's size.
  std::optional<Error> write(std::string_view text, const std::function<bool()>& isCancelled);

  std::optional<Error> close();

 private:
  static constexpr int kNone = -1;
  int fd_ = kNone;
  bool isRegular_ = false;
};

}  // namespace rg
