// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/line_writer.hpp"

#include <gst/gst.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <csignal>
#include <ctime>
#include <mutex>
#include <new>
#include <pthread.h>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace rg {
namespace {

constexpr std::chrono::milliseconds kCancelPoll{100};  // How soon a cancellation is noticed.
/// Of the patience, for the sink to notice that it is at its end.
constexpr int kNoticeShare = 8;

/// A time on the monotonic clock.
GstClockTime in(std::chrono::milliseconds time) {
  return gst_util_get_timestamp() + static_cast<GstClockTime>(time.count()) * GST_MSECOND;
}
bool isOver(GstClockTime end) {
  return gst_util_get_timestamp() >= end;
}

/// Waits for news until a time. The library's own waits ask the clock themselves, which
/// tests/symbols.py forbids.
void waitUntil(std::condition_variable& news, std::unique_lock<std::mutex>& lock,
               GstClockTime end) {
  const timespec time{static_cast<time_t>(end / GST_SECOND), static_cast<long>(end % GST_SECOND)};
  pthread_cond_clockwait(news.native_handle(), lock.mutex()->native_handle(), CLOCK_MONOTONIC,
                         &time);
}

template <class Condition>
void waitUntil(std::condition_variable& news, std::unique_lock<std::mutex>& lock, GstClockTime end,
               Condition isMet) {
  while (!isMet() && !isOver(end)) waitUntil(news, lock, end);
}

/// A text in the queue, or the wish to open the file again.
struct Entry {
  size_t bytes;
  int64_t timeNs;
  bool isReopening;
};

struct Batch {
  std::string text;
  std::vector<Entry> entries;

  void clear() {
    text.clear();
    entries.clear();
  }
};

/// New threads have the mask of the one that starts them: the writer gets no signal that is meant
/// for the application, and none for a pipe without a reader or a file that is too large.
class AllSignalsBlocked {
 public:
  AllSignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~AllSignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  AllSignalsBlocked(const AllSignalsBlocked&) = delete;
  AllSignalsBlocked& operator=(const AllSignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

/// What both threads see, and keep alive.
struct LineWriter::State {
  explicit State(std::unique_ptr<LineSink> output) : sink(std::move(output)) {}

  mutable std::mutex mutex;  ///< Protects all but `sink` and `writing`; never held while writing.
  std::condition_variable hasWork, hasProgress;
  Batch queued;
  size_t waitingBytes = 0;       ///< Of all texts that were taken and are not done.
  uint64_t taken = 0, done = 0;  ///< Entries.
  uint64_t waitingTexts = 0;
  uint64_t dropped = 0;
  bool hasBegun = false;
  bool isStopping = false;
  bool isAbandoned = false;  ///< What is not done has been counted as dropped.
  bool isOver = false;
  bool wasCrowded = false;
  std::optional<Error> failure, complaint;
  std::atomic<bool> isCancelled = false;

  std::unique_ptr<LineSink> sink;  ///< The writer's, until it is over.
  Batch writing;                   ///< The writer's.

  [[nodiscard]] bool hasRoomFor(size_t bytes) const {
    return waitingBytes == 0 || waitingBytes + bytes <= kMostQueuedBytes;
  }
  void take(std::string_view text, Entry entry);
  void run() noexcept;
  void begin();
  bool fetch();
  void writeBatch();
  void finish(const Entry& entry, Writing result);
  Writing write(std::string_view text, const Entry& entry) noexcept;
};

/// With the mutex held. Without memory it changes nothing.
void LineWriter::State::take(std::string_view text, Entry entry) {
  if (queued.entries.size() == queued.entries.capacity())
    queued.entries.reserve(std::max<size_t>(16, 2 * queued.entries.capacity()));
  queued.text.append(text);
  queued.entries.push_back(entry);
  ++taken;
  waitingBytes += entry.bytes;
  if (!entry.isReopening) ++waitingTexts;
  hasWork.notify_one();
}

void LineWriter::State::run() noexcept {
  begin();
  while (fetch()) writeBatch();
  const std::lock_guard lock(mutex);
  isOver = true;
  hasProgress.notify_all();
}

void LineWriter::State::begin() {
  std::optional<Error> error;
  try {
    error = sink->begin([this] { return isCancelled.load(); });
  } catch (...) {
    error = Error{"out of memory"};
  }
  const std::lock_guard lock(mutex);
  hasBegun = true;
  if (!isAbandoned) failure = std::move(error);
  hasProgress.notify_all();
}

/// Waits for entries; false where none will come.
bool LineWriter::State::fetch() {
  std::unique_lock lock(mutex);
  hasWork.wait(lock, [&] { return isStopping || !queued.entries.empty(); });
  if (queued.entries.empty() || isAbandoned) return false;
  writing.clear();
  std::swap(writing, queued);
  return true;
}

void LineWriter::State::writeBatch() {
  std::string_view rest = writing.text;
  for (const Entry& entry : writing.entries) {
    if (isCancelled) return;
    const std::string_view text = rest.substr(0, entry.bytes);
    rest.remove_prefix(entry.bytes);
    finish(entry, write(text, entry));
  }
}

Writing LineWriter::State::write(std::string_view text, const Entry& entry) noexcept {
  try {
    if (!entry.isReopening)
      return sink->write(text, entry.timeNs, [this] { return isCancelled.load(); });
    auto error = sink->reopen();
    return {true, std::move(error)};
  } catch (...) {
    return {entry.isReopening, Error{"out of memory"}};
  }
}

void LineWriter::State::finish(const Entry& entry, Writing result) {
  const std::lock_guard lock(mutex);
  if (isAbandoned) return;
  ++done;
  waitingBytes -= entry.bytes;
  if (!entry.isReopening) --waitingTexts;
  if (!result.isWritten) ++dropped;
  if (result.error) (result.isWritten ? complaint : failure) = std::move(result.error);
  hasProgress.notify_all();
}

LineWriter::LineWriter(std::shared_ptr<State> state, std::chrono::milliseconds patience)
    : state_(std::move(state)), patience_(patience) {}

LineWriter::~LineWriter() {
  stop();
}

Result<std::unique_ptr<LineWriter>> LineWriter::start(std::unique_ptr<LineSink> sink,
                                                      std::chrono::milliseconds patience) {
  auto state = std::make_shared<State>(std::move(sink));
  std::unique_ptr<LineWriter> writer(new LineWriter(state, patience));
  try {
    const AllSignalsBlocked blocked;
    writer->thread_ = std::thread([state] { state->run(); });
    pthread_setname_np(writer->thread_.native_handle(), "regionwrite");
  } catch (const std::system_error& error) {
    state->isOver = true;
    return Error{"no thread could be started to write with: " + error.code().message()};
  }
  std::unique_lock lock(state->mutex);
  waitUntil(state->hasProgress, lock, in(patience), [&] { return state->hasBegun; });
  if (state->failure) return *std::move(state->failure);
  return writer;
}

void LineWriter::push(std::string_view text, int64_t timeNs, Crowded crowded,
                      const IsCancelled& isCancelled) {
  State& state = *state_;
  std::unique_lock lock(state.mutex);
  const auto waitFor = [&](auto isReached) {
    while (!isReached() && !state.isOver && !isCancelled())
      waitUntil(state.hasProgress, lock, in(kCancelPoll));
  };
  if (crowded == Crowded::Wait) waitFor([&] { return state.hasRoomFor(text.size()); });
  if (state.isOver || state.isStopping || !state.hasRoomFor(text.size())) {
    ++state.dropped;
    state.wasCrowded = true;
    return;
  }
  state.take(text, {text.size(), timeNs, false});
  const uint64_t mine = state.taken;
  if (crowded == Crowded::Wait) waitFor([&] { return state.done >= mine; });
}

void LineWriter::reopen() {
  const std::lock_guard lock(state_->mutex);
  if (!state_->isStopping) state_->take({}, {0, 0, true});
}

void LineWriter::drain(const IsCancelled& isCancelled) {
  State& state = *state_;
  std::unique_lock lock(state.mutex);
  const GstClockTime end = in(patience_);
  while (state.done < state.taken && !state.isOver && !isCancelled() && !isOver(end))
    waitUntil(state.hasProgress, lock, std::min(end, in(kCancelPoll)));
}

void LineWriter::stop() {
  State& state = *state_;
  std::unique_lock lock(state.mutex);
  if (std::exchange(state.isStopping, true)) return;
  state.hasWork.notify_all();
  const auto notice = patience_ / kNoticeShare;
  const auto hasEnded = [&] { return state.isOver; };
  waitUntil(state.hasProgress, lock, in(patience_ - notice), hasEnded);
  if (!state.isOver) {
    state.isAbandoned = true;
    state.isCancelled = true;
    state.dropped += state.waitingTexts;
    state.wasCrowded = state.wasCrowded || state.waitingTexts > 0;
    waitUntil(state.hasProgress, lock, in(notice), hasEnded);
  }
  const bool hangs = !state.isOver;
  lock.unlock();
  if (!thread_.joinable()) return;
  // What a thread that hangs uses goes with it.
  if (hangs) return thread_.detach();
  thread_.join();
  if (auto error = state.sink->close()) {
    lock.lock();
    state.failure = std::move(error);
  }
}

uint64_t LineWriter::dropped() const {
  const std::lock_guard lock(state_->mutex);
  return state_->dropped;
}

std::optional<Error> LineWriter::takeFailure() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->failure, std::nullopt);
}

std::optional<Error> LineWriter::takeComplaint() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->complaint, std::nullopt);
}

bool LineWriter::wasCrowded() const {
  const std::lock_guard lock(state_->mutex);
  return state_->wasCrowded;
}

}  // namespace rg
