// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/line_file.hpp"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <ctime>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace rg {
namespace {

constexpr int kPollMs = 100;  // How soon a cancellation is noticed.

/// A file is too large for the process's limit, or else for the file system.
Error sizeError() {
  rlimit limit{};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    return {"the process may not make files of more than " + std::to_string(limit.rlim_cur) +
            " bytes; raise its limit (ulimit -f) or write to a pipe"};
  return {"the file system takes no file as large; write to another one or to a pipe"};
}

Error errorOf(int code) {
  return code == EFBIG ? sizeError() : Error{std::generic_category().message(code)};
}

/// Keeps a signal from ending the process: SIGPIPE when the reader of a pipe goes away, SIGXFSZ
/// when a file reaches the process's limit. Only this thread's mask changes; a signal that write()
/// raised meanwhile is taken back.
class SignalBlock {
 public:
  explicit SignalBlock(int signal) {
    sigemptyset(&signal_);
    sigaddset(&signal_, signal);
    sigset_t pending;
    sigpending(&pending);
    wasPending_ = sigismember(&pending, signal) == 1;
    pthread_sigmask(SIG_BLOCK, &signal_, &old_);
  }
  ~SignalBlock() {
    constexpr timespec kNow{};
    if (!wasPending_) sigtimedwait(&signal_, nullptr, &kNow);
    pthread_sigmask(SIG_SETMASK, &old_, nullptr);
  }
  SignalBlock(const SignalBlock&) = delete;
  SignalBlock& operator=(const SignalBlock&) = delete;

 private:
  sigset_t signal_;
  sigset_t old_;
  bool wasPending_;
};

}  // namespace

LineFile::LineFile(LineFile&& other) noexcept
    : fd_(std::exchange(other.fd_, kNone)), isRegular_(other.isRegular_) {}

LineFile& LineFile::operator=(LineFile&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(isRegular_, other.isRegular_);
  return *this;
}

Result<LineFile> LineFile::open(const std::string& location) {
  LineFile file;
  if (location == "-") {
    file.fd_ = STDOUT_FILENO;
  } else {
    // Non-blocking, so that a pipe without a reader is an error instead of a pipeline that hangs.
    constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOCTTY | O_NONBLOCK;
    do {
      file.fd_ = ::open(location.c_str(), kFlags, 0666);
    } while (file.fd_ == kNone && errno == EINTR);
    if (file.fd_ == kNone && errno == ENXIO) return Error{"nobody reads from this pipe"};
    if (file.fd_ == kNone) return errorOf(errno);
  }
  struct stat status;
  file.isRegular_ = fstat(file.fd_, &status) == 0 && S_ISREG(status.st_mode);
  return file;
}

std::optional<Error> LineFile::write(std::string_view text,
                                     const std::function<bool()>& isCancelled) {
  const SignalBlock noPipe(SIGPIPE), noLimit(SIGXFSZ);
  while (!text.empty()) {
    if (!isRegular_) {
      pollfd waiting{fd_, POLLOUT, 0};
      const int ready = poll(&waiting, 1, kPollMs);
      if (ready < 0 && errno != EINTR) return errorOf(errno);
      if (ready == 0 && isCancelled()) return std::nullopt;
      if (ready <= 0) continue;
    }
    // A pipe that poll() calls writable takes PIPE_BUF bytes without blocking.
    const size_t most = isRegular_ ? text.size() : std::min<size_t>(text.size(), PIPE_BUF);
    const ssize_t written = ::write(fd_, text.data(), most);
    if (written >= 0)
      text.remove_prefix(static_cast<size_t>(written));
    else if (errno != EINTR && errno != EAGAIN)
      return errorOf(errno);
  }
  return std::nullopt;
}

std::optional<Error> LineFile::close() {
  const int fd = std::exchange(fd_, kNone);
  if (fd == kNone || fd == STDOUT_FILENO) return std::nullopt;
  // What was written may be refused as late as here, by a network's file system for instance.
  if (::close(fd) != 0 && errno != EINTR) return errorOf(errno);
  return std::nullopt;
}

}  // namespace rg
