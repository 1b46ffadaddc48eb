// SPDX-License-Identifier: LGPL-2.1-or-later
// A host process that is hostile: signals, another floating-point mode, another locale, little
// memory, no threads. What the elements say must not change, or must be an error.
#include "tests/support/busy_scene.hpp"

#include <glib/gstdio.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace rg {
namespace {

using testing::BufferPtr;
using testing::busyFrame;
using testing::Caps;
using testing::Chain;
using testing::Story;
using testing::Watchdog;

const Caps kSmall{"I420", 96, 64};

/// A folder that is there as long as this is.
class Folder {
 public:
  Folder() {
    char name[] = "/tmp/regiongraph-process-XXXXXX";
    path_ = mkdtemp(name);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string file(const char* name) const { return path_ + "/" + name; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string contentOf(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// What the stages say of 30 frames and what regionwrite writes of them. Text is parsed and written
/// on the way: a polygon, hues, JSON lines.
std::string wholeStory(const std::string& location, int frames = 30) {
  std::string told;
  {
    Chain chain(
        "bgremove training-frames=2 areas-of-interest=\"0.0,0.0 1.0,0 1,1 0,0.75\" ! hsvsegment "
        "background-hue=80-160 ! srg ! prmmotion ! mrfmerge motion-weight=1.25 ! regionwrite "
        "contours=true location=" +
            location,
        kSmall);
    Story story;
    for (int i = 0; i < frames; ++i) told += story.tell(chain.pass(busyFrame(kSmall, i)).get());
    EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  }
  EXPECT_NE(told.find("object 1"), std::string::npos);
  return told + contentOf(location);
}

std::atomic<int> alarms = 0;

/// Alarms every millisecond, whose handler does not restart what it interrupts.
TEST(Process, SignalsInterruptNothing) {
  const Watchdog watchdog(120);
  const Folder folder;
  const std::string expected = wholeStory(folder.file("quiet"));
  struct sigaction action {};
  struct sigaction before {};
  action.sa_handler = [](int) { ++alarms; };
  sigaction(SIGALRM, &action, &before);
  const itimerval often{{0, 1000}, {0, 1000}}, never{};
  setitimer(ITIMER_REAL, &often, nullptr);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(wholeStory(folder.file("alarmed")), expected);
  setitimer(ITIMER_REAL, &never, nullptr);
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_GT(alarms, 0);
}

/// Somebody stops the process for a moment, again and again: no wall clock is looked at.
TEST(Process, BeingStoppedChangesNothing) {
  const Watchdog watchdog(120);
  const Folder folder;
  const std::string expected = wholeStory(folder.file("running"));
  const pid_t us = getpid();
  const pid_t other = fork();
  ASSERT_GE(other, 0);
  if (other == 0) {
    for (int i = 0; i < 10; ++i) {
      kill(us, SIGSTOP);
      usleep(20'000);
      kill(us, SIGCONT);
      usleep(10'000);
    }
    _exit(0);
  }
  int status = 0, rounds = 0;
  do {
    EXPECT_EQ(wholeStory(folder.file("stopped")), expected);
    ++rounds;
  } while (waitpid(other, &status, WNOHANG) == 0);
  EXPECT_GT(rounds, 0);
  EXPECT_EQ(status, 0);
}

/// Rounding upwards, and denormals taken for zero, as some audio hosts set them.
TEST(Process, TheFloatingPointModeChangesNothing) {
  const Folder folder;
  const std::string expected = wholeStory(folder.file("usual"));
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    ASSERT_EQ(std::fesetround(mode), 0);
    EXPECT_EQ(wholeStory(folder.file("rounded")), expected) << mode;
  }
  std::fesetround(FE_TONEAREST);
#ifdef __SSE2__
  constexpr unsigned kFlushAndDenormalsAreZero = 0x8040;
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | kFlushAndDenormalsAreZero);
  EXPECT_EQ(wholeStory(folder.file("flushed")), expected);
  _mm_setcsr(before);
#endif
}

/// Germany's, whose decimals have a comma; made here, as few machines have it.
TEST(Process, ALocaleWithCommasChangesNothing) {
  const Folder folder;
  const std::string make = "localedef -i de_DE -f UTF-8 " + folder.file("de_DE.UTF-8") + " >" +
                           folder.file("log") + " 2>&1";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << contentOf(folder.file("log"));
  const std::string expected = wholeStory(folder.file("usual"));
  g_setenv("LOCPATH", folder.path().c_str(), TRUE);
  ASSERT_TRUE(std::setlocale(LC_ALL, "de_DE.UTF-8"));
  EXPECT_STREQ(std::localeconv()->decimal_point, ",");
  EXPECT_EQ(wholeStory(folder.file("german")), expected);
  std::setlocale(LC_ALL, "C");
  g_unsetenv("LOCPATH");
}

/// A relative name is that of the folder at the start; another folder or umask later is no matter.
TEST(Process, AnotherFolderOrUmaskChangesNothing) {
  const Folder folder;
  const std::string expected = wholeStory(folder.file("usual"));
  const auto before = std::filesystem::current_path();
  const mode_t mask = umask(0777);
  std::filesystem::current_path(folder.path());
  Chain chain(std::string(testing::kQuickStages) + " ! regionwrite location=relative", kSmall);
  std::filesystem::current_path("/");
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(chain.pass(busyFrame(kSmall, i)));
  umask(mask);
  EXPECT_EQ(wholeStory(folder.file("after")), expected);
  std::filesystem::current_path(before);
  EXPECT_GT(std::filesystem::file_size(folder.file("relative")), 0u);
}

size_t addressSpace() {
  std::ifstream in("/proc/self/statm");
  size_t pages = 0;
  in >> pages;
  return pages * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

/// Frames that don't fit are an error on the bus; what follows fits and is processed. Ends with 0
/// where all of that held.
[[noreturn]] void runOutOfMemory(const char* line) {
  Chain chain(line, kSmall);
  int index = 0;
  bool isRight = testing::showObjects(chain, index);
  const Caps large{"GRAY8", 4096, 4096};
  BufferPtr frame = testing::paint(large, index, [](int x, int y) -> uint8_t {
    return static_cast<uint8_t>(x / 16 * 7 + y / 16 * 13);
  });
  const rlim_t limit = addressSpace() + (rlim_t{64} << 20);
  const rlimit tight{limit, RLIM_INFINITY}, loose{RLIM_INFINITY, RLIM_INFINITY};
  chain.setCaps(large);
  setrlimit(RLIMIT_AS, &tight);
  const GstFlowReturn flow = chain.push(std::move(frame));
  setrlimit(RLIMIT_AS, &loose);
  isRight = isRight && flow == GST_FLOW_ERROR;
  isRight = isRight && chain.complaint(GST_MESSAGE_ERROR).find("memory") != std::string::npos;
  chain.setCaps(kSmall);
  isRight = isRight && testing::showObjects(chain, index);
  std::fprintf(stderr, "%s: flow %s\n", line, gst_flow_get_name(flow));
  _exit(isRight ? 0 : 1);
}

TEST(ProcessDeathTest, FramesThatDoNotFitInMemoryAreAnError) {
  if (testing::heapBytes() == 0) GTEST_SKIP() << "no limit holds under this allocator";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(runOutOfMemory(testing::kQuickStages), ::testing::ExitedWithCode(0), "");
  EXPECT_EXIT(runOutOfMemory(testing::kFrameScopeStages), ::testing::ExitedWithCode(0), "");
  EXPECT_EXIT(runOutOfMemory(testing::kPaperStages), ::testing::ExitedWithCode(0), "");
  EXPECT_EXIT(runOutOfMemory(testing::kDifferenceStages), ::testing::ExitedWithCode(0), "");
}

/// No thread may be made any more: the frames are processed on those that there are, or it is an
/// error. As root the limit holds only for somebody else.
[[noreturn]] void runWithoutThreads() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_NPROC, &none);
  if (getuid() == 0 && setresuid(65534, 65534, 65534) != 0) _exit(77);
  Chain chain(testing::kQuickStages, {"GRAY8", 160, 120});
  int index = 0;
  _exit(testing::showObjects(chain, index) || !chain.complaint(GST_MESSAGE_ERROR).empty() ? 0 : 1);
}

/// What can't write beside the frames says so instead of making them wait.
[[noreturn]] void writeWithoutThreads() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_NPROC, &none);
  if (getuid() == 0 && setresuid(65534, 65534, 65534) != 0) _exit(77);
  const Chain chain("identity");
  GstElement* element = gst_element_factory_make("regionwrite", nullptr);
  GstBus* bus = gst_element_get_bus(chain.harness()->element);
  gst_element_set_bus(element, bus);
  g_object_set(element, "location", "/dev/null", nullptr);
  const bool hasFailed =
      gst_element_set_state(element, GST_STATE_PAUSED) == GST_STATE_CHANGE_FAILURE;
  const testing::MessagePtr message(gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR));
  GError* error = nullptr;
  if (message) gst_message_parse_error(message.get(), &error, nullptr);
  _exit(hasFailed && error && std::strstr(error->message, "no thread") ? 0 : 1);
}

TEST(ProcessDeathTest, WithoutAThreadRegionwriteDoesNotStart) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(writeWithoutThreads(), ::testing::ExitedWithCode(0), "");
}

TEST(ProcessDeathTest, WithoutThreadsTheFramesAreProcessed) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(runWithoutThreads(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace rg
