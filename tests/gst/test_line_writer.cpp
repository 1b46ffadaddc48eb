// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/line_writer.hpp"
#include "tests/support/busy_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace rg {
namespace {

using std::chrono::milliseconds;
using testing::Watchdog;

const IsCancelled kNever = [] { return false; };

/// What the sinks of a test did, and whether they may go on; outlives them.
struct Story {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::string> told;
  bool isOpen = true;
  bool isGone = false;

  void tell(const std::string& what) {
    const std::lock_guard lock(mutex);
    told.push_back(what);
    changed.notify_all();
  }
  void open() {
    const std::lock_guard lock(mutex);
    isOpen = true;
    changed.notify_all();
  }
  template <class Condition>
  void await(Condition condition) {
    std::unique_lock lock(mutex);
    changed.wait(lock, condition);
  }
};

/// Keeps each text; fails for those that begin with '!'. While the story is closed, a write does
/// not return, whatever anybody says.
class Teller final : public LineSink {
 public:
  explicit Teller(std::shared_ptr<Story> story) : story_(std::move(story)) {}
  ~Teller() override {
    const std::lock_guard lock(story_->mutex);
    story_->isGone = true;
    story_->changed.notify_all();
  }
  std::optional<Error> begin(const IsCancelled&) override { return std::nullopt; }
  Writing write(std::string_view text, int64_t, const IsCancelled&) override {
    story_->tell("in " + std::string(text.substr(0, 8)));
    story_->await([&] { return story_->isOpen; });
    if (text.front() == '!') return {false, Error{"refused"}};
    story_->tell(std::string(text.substr(0, 8)));
    return {};
  }
  std::optional<Error> reopen() override {
    story_->tell("reopened");
    return std::nullopt;
  }
  std::optional<Error> close() override {
    story_->tell("closed");
    return std::nullopt;
  }

 private:
  const std::shared_ptr<Story> story_;
};

class LineWriters : public ::testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<LineWriter> start(milliseconds patience = milliseconds(60'000)) {
    auto writer = LineWriter::start(std::make_unique<Teller>(story_), patience);
    EXPECT_TRUE(writer);
    return *std::move(writer);
  }

  const Watchdog watchdog_{120};
  const std::shared_ptr<Story> story_ = std::make_shared<Story>();
};

/// The write of the first text never returns: whoever waited for it would hang here.
TEST_F(LineWriters, NobodyWaitsForAWriteThatNeverReturns) {
  story_->isOpen = false;
  auto writer = start(milliseconds(0));
  const std::string text(size_t{1} << 20, 'x');
  for (int i = 0; i < 20; ++i) writer->push(text, i, Crowded::Drop, kNever);
  EXPECT_EQ(writer->dropped(), 16u);
  EXPECT_TRUE(writer->wasCrowded());
  writer->drain(kNever);
  writer->reopen();
  writer->stop();
  EXPECT_EQ(writer->dropped(), 20u);
  writer.reset();
  story_->open();
  story_->await([&] { return story_->isGone; });
}

TEST_F(LineWriters, ATextIsNeverPartedFromTheCount) {
  auto writer = start();
  for (int i = 0; i < 300; ++i)
    writer->push(i % 3 == 0 ? "!bad" : "good", i, Crowded::Drop, kNever);
  writer->drain(kNever);
  EXPECT_EQ(writer->dropped(), 100u);
  EXPECT_EQ(writer->takeFailure()->message, "refused");
  EXPECT_FALSE(writer->takeFailure());
  EXPECT_FALSE(writer->wasCrowded());
  writer->stop();
  EXPECT_EQ(writer->dropped(), 100u);
  EXPECT_EQ(std::count(story_->told.begin(), story_->told.end(), "good"), 200);
  EXPECT_EQ(story_->told.back(), "closed");
}

TEST_F(LineWriters, WaitingLosesNothingHoweverMuchThereIs) {
  auto writer = start();
  const std::string text(3 * kMostQueuedBytes, 'x');
  for (int i = 0; i < 5; ++i) {
    writer->push(text, i, Crowded::Wait, kNever);
    EXPECT_EQ(story_->told.size(), static_cast<size_t>(2 * (i + 1)));
  }
  EXPECT_EQ(writer->dropped(), 0u);
}

TEST_F(LineWriters, WaitingEndsWhenItIsCancelled) {
  story_->isOpen = false;
  auto writer = start();
  writer->push("one", 0, Crowded::Wait, [] { return true; });
  writer->push(std::string(2 * kMostQueuedBytes, 'x'), 0, Crowded::Wait, [] { return true; });
  EXPECT_EQ(writer->dropped(), 1u);
  story_->open();
  writer->drain(kNever);
  EXPECT_EQ(writer->dropped(), 1u);
}

TEST_F(LineWriters, OpenTheFileAgainBetweenTexts) {
  story_->isOpen = false;
  auto writer = start();
  writer->push("before", 0, Crowded::Drop, kNever);
  writer->reopen();
  writer->push("behind", 0, Crowded::Drop, kNever);
  story_->open();
  writer->stop();
  EXPECT_EQ(story_->told, (std::vector<std::string>{"in before", "before", "reopened", "in behind",
                                                    "behind", "closed"}));
}

/// Texts, reopenings and questions from several threads, while the writer is now fast, now stuck.
TEST_F(LineWriters, ManyThreadsCountTogether) {
  auto writer = start();
  constexpr int kEach = 500;
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < kEach; ++k) {
        writer->push(k % 7 == 0 ? "!bad" : "good", k, k % 2 ? Crowded::Wait : Crowded::Drop,
                     kNever);
        if (k % 50 == 0) writer->reopen();
        if (k % 90 == 0) (void)writer->takeFailure();
      }
    });
  for (std::thread& thread : threads) thread.join();
  writer->stop();
  const auto good = std::count(story_->told.begin(), story_->told.end(), "good");
  EXPECT_EQ(static_cast<uint64_t>(good) + writer->dropped(), uint64_t{3 * kEach});
}

}  // namespace
}  // namespace rg
