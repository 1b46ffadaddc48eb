// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/line_file.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace rg {
namespace {

constexpr int kPollMs = 100;  // How soon a cancellation is noticed.

std::atomic<bool> isStandardOutputTaken = false;

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

int openFile(const std::string& location) {
  // Non-blocking, so that a pipe without a reader is an error instead of a pipeline that hangs. Not
  // emptied before it is known that nobody else writes to it.
  constexpr int kFlags = O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOCTTY | O_NONBLOCK;
  int fd = -1;
  do {
    fd = ::open(location.c_str(), kFlags, 0666);
  } while (fd < 0 && errno == EINTR);
  return fd;
}

/// Whether another one has the lock that every writer takes. File systems without locks have none
/// to refuse.
bool isTaken(int fd) {
  return flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

/// Whether a file ends within a line, as after a crash or on a disk that was full.
bool endsWithinALine(const std::string& location, off_t size) {
  if (size <= 0) return false;
  const int fd = ::open(location.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return false;
  char last = '\n';
  const bool isRead = pread(fd, &last, 1, size - 1) == 1;
  ::close(fd);
  return isRead && last != '\n';
}

}  // namespace

Result<std::unique_ptr<LineSink>> LineFile::open(LineFileOptions options) {
  const Content content = options.isAppending ? Content::Keep : Content::Drop;
  std::unique_ptr<LineFile> file(new LineFile(std::move(options)));
  if (auto error = file->openAnew(content)) return *std::move(error);
  return std::unique_ptr<LineSink>(std::move(file));
}

std::optional<Error> LineFile::openAnew(Content content) {
  if (options_.location != "-") {
    const int fd = openFile(options_.location);
    if (fd < 0 && errno == ENXIO) return Error{"nobody reads from this pipe"};
    if (fd < 0) return errorOf(errno);
    return adopt(fd, content);
  }
  if (isStandardOutputTaken.exchange(true))
    return Error{"another element writes there; give each a location of its own"};
  hasStandardOutput_ = true;
  return adopt(STDOUT_FILENO, Content::Keep);
}

/// Takes the descriptor, in place of the one before, or closes it.
std::optional<Error> LineFile::adopt(int fd, Content content) {
  struct stat status {};
  const bool isKnown = fstat(fd, &status) == 0;
  const bool isRegular = isKnown && S_ISREG(status.st_mode);
  const bool isOwned = !hasStandardOutput_ && (isRegular || (isKnown && S_ISFIFO(status.st_mode)));
  if (isOwned && isTaken(fd)) {
    ::close(fd);
    return Error{"another element or program writes there; give each a location of its own"};
  }
  if (isRegular && content == Content::Drop && ftruncate(fd, 0) != 0) {
    const int code = errno;
    ::close(fd);
    return errorOf(code);
  }
  release();
  fd_ = fd;
  isRegular_ = isRegular;
  const bool hasContent = isRegular && content == Content::Keep && status.st_size > 0;
  bytes_ = hasContent ? static_cast<uint64_t>(status.st_size) : 0;
  firstNs_.reset();
  needsHeader_ = !options_.header.empty() && !hasContent;
  if (hasContent && endsWithinALine(options_.location, status.st_size)) return put("\n", nullptr);
  return std::nullopt;
}

std::optional<Error> LineFile::begin(const IsCancelled& isCancelled) {
  if (fd_ == kNone)
    if (auto error = openAnew(Content::Keep)) return error;
  if (!needsHeader_) return std::nullopt;
  auto error = put(options_.header, isCancelled);
  needsHeader_ = error.has_value();
  return error;
}

Writing LineFile::write(std::string_view text, int64_t timeNs, const IsCancelled& isCancelled) {
  std::optional<Error> notRotated;
  if (isRotationDue(text.size(), timeNs)) notRotated = rotate();
  auto error = begin(isCancelled);
  if (!error) error = put(text, isCancelled);
  if (error) return {false, std::move(error)};
  if (!firstNs_ || timeNs < *firstNs_) firstNs_ = timeNs;
  return {true, std::move(notRotated)};
}

std::optional<Error> LineFile::reopen() {
  if (hasStandardOutput_ || isStillThere()) return std::nullopt;
  return openAnew(Content::Keep);
}

std::optional<Error> LineFile::close() {
  const int fd = std::exchange(fd_, kNone);
  if (std::exchange(hasStandardOutput_, false)) {
    isStandardOutputTaken = false;
    return std::nullopt;
  }
  if (fd == kNone) return std::nullopt;
  // What was written may be refused as late as here, by a network's file system for instance.
  if (::close(fd) != 0 && errno != EINTR) return errorOf(errno);
  return std::nullopt;
}

/// Lets go of a pipe that nobody reads, or of a file whose lines were written.
void LineFile::release() {
  if (fd_ != kNone && !hasStandardOutput_) ::close(fd_);
  fd_ = kNone;
}

/// Whether the location still names what is open.
bool LineFile::isStillThere() const {
  struct stat open {
  }, named{};
  return fd_ != kNone && fstat(fd_, &open) == 0 && stat(options_.location.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

bool LineFile::isRotationDue(size_t bytes, int64_t timeNs) const {
  if (!isRegular_ || hasStandardOutput_ || bytes_ <= options_.header.size()) return false;
  if (options_.mostBytes > 0 && bytes_ + bytes > options_.mostBytes) return true;
  return options_.mostNs > 0 && firstNs_ && timeNs >= *firstNs_ &&
         timeNs - *firstNs_ >= options_.mostNs;
}

/// The file becomes LOCATION.1, which was LOCATION.2 before, and so on; the oldest goes. Where that
/// fails the lines go on in the file, and it is tried again after as much again.
std::optional<Error> LineFile::rotate() {
  const auto old = [&](int i) { return options_.location + "." + std::to_string(i); };
  std::optional<Error> error;
  if (isStillThere()) {
    for (int i = options_.mostOldFiles - 1; i >= 1; --i)
      ::rename(old(i).c_str(), old(i + 1).c_str());
    if (::rename(options_.location.c_str(), old(1).c_str()) != 0) error = errorOf(errno);
  }
  if (!error) error = openAnew(Content::Keep);
  if (!error) return std::nullopt;
  bytes_ = 0;
  firstNs_.reset();
  return Error{"no other file could be begun, so that this one grows on: " + error->message};
}

std::optional<Error> LineFile::put(std::string_view text, const IsCancelled& isCancelled) {
  size_t done = 0;
  while (done < text.size()) {
    if (!isRegular_) {
      pollfd waiting{fd_, POLLOUT, 0};
      const int ready = poll(&waiting, 1, kPollMs);
      if (ready < 0 && errno != EINTR) return errorOf(errno);
      if (ready == 0 && isCancelled && isCancelled()) return Error{"nobody read in time"};
      if (ready <= 0) continue;
    }
    // A pipe that poll() calls writable takes PIPE_BUF bytes without blocking.
    const size_t rest = text.size() - done;
    const size_t most = isRegular_ ? rest : std::min<size_t>(rest, PIPE_BUF);
    const ssize_t written = ::write(fd_, text.data() + done, most);
    if (written >= 0) {
      done += static_cast<size_t>(written);
    } else if (errno != EINTR && errno != EAGAIN) {
      const int code = errno;
      takeBack(done);
      if (code == EPIPE && !hasStandardOutput_) release();
      return errorOf(code);
    }
  }
  bytes_ += text.size();
  return std::nullopt;
}

/// Cuts off the part of a line that was written before it failed.
void LineFile::takeBack(size_t bytes) const {
  struct stat status {};
  if (bytes == 0 || !isRegular_ || hasStandardOutput_ || fstat(fd_, &status) != 0) return;
  // Where that fails too, the next start with `append` ends the line.
  const off_t before = status.st_size - static_cast<off_t>(bytes);
  if (before >= 0 && ftruncate(fd_, before) != 0) return;
}

}  // namespace rg
