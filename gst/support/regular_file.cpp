// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/regular_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace rg {
namespace {

const char* kindOf(mode_t mode) {
  if (S_ISDIR(mode)) return "it is a directory";
  if (S_ISFIFO(mode)) return "it is a pipe";
  return "it is no regular file";
}

}  // namespace

Result<File> openRegular(const std::string& path, int64_t mostMiB) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (fd < 0) return Error{std::strerror(errno)};
  File file(::fdopen(fd, "rb"));
  if (!file) {
    const int reason = errno;
    ::close(fd);
    return Error{std::strerror(reason)};
  }
  struct stat status;
  if (::fstat(fd, &status) != 0) return Error{std::strerror(errno)};
  if (!S_ISREG(status.st_mode)) return Error{kindOf(status.st_mode)};
  if (status.st_size > mostMiB << 20) return Error{"more than " + std::to_string(mostMiB) + " MiB"};
  return file;
}

}  // namespace rg
