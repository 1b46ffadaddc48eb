// SPDX-License-Identifier: LGPL-2.1-or-later
// Files whose paths a user gave.
#pragma once

#include "core/base/result.hpp"

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace rg {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// Opens a regular file, or what a link to one leads to, for reading. The error is the reason
/// alone, also where it has more bytes than `mostMiB`. Never waits: to open a pipe would wait for
/// its writer, and to read from a device might never end.
[[nodiscard]] Result<File> openRegular(const std::string& path, int64_t mostMiB);

}  // namespace rg
