// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames through each chain while other threads set and read every property and ask for the
// latency, in an order that a printed seed decides. Run under ThreadSanitizer by tests/campaign.sh.
#include "core/base/memory/executor.hpp"
#include "core/base/pixel.hpp"
#include "tests/fuzz/moving_scene.hpp"
#include "tests/fuzz/set_property.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iterator>
#include <string>
#include <string_view>
#include <thread>

namespace rg::stress {
namespace {

using testing::Caps;
using testing::Chain;

/// Threads of a frame, and threads that hand frames on.
constexpr const char* kChains[] = {
    "bgremove threads=2 ! hsvsegment threads=2 ! srg threads=2 ! prmmotion threads=2 ! "
    "mrfmerge threads=2 ! regionwrite location=/dev/null",
    "bgremove threads=1 ! hsvsegment threads=1 ! srg threads=1 ! prmmotion threads=1 ! "
    "mrfmerge threads=1 ! regionwrite location=/dev/null",
    "hsvsegment threads=1 ! srg threads=1 ! prmmotion threads=1 ! mrfmerge threads=1 ! "
    "regionmask source=objects",
    "regiontrack threads=1 ! regionoverlay",
};

constexpr char kUsage[] =
    "usage: stress [--pushes N] [--size WxH] [--seed S] [--chain LINE]\n"
    "       stress --races N\n"
    "  --pushes  frames to each chain (default 3000)\n"
    "  --chain   only those whose line begins so, as \"bgremove threads=1\"\n"
    "  --races   only so many tasks of an executor that race, which ThreadSanitizer must tell\n";

constexpr guint kMostShift = 2;
constexpr int kTurnsOfFrame = 2;  // Properties set, elements asked.

struct Options {
  int pushes = 3000;
  int width = 64, height = 48;
  uint32_t seed = static_cast<uint32_t>(std::time(nullptr));
  std::string chain;  ///< What their lines begin with.
  int races = 0;
};

/// Bytes without end, for what takes bytes.
class Random {
 public:
  explicit Random(uint32_t seed) : seed_(seed) {}
  /// Valid until the next call.
  fuzz::Bytes bytes() {
    for (uint8_t& byte : block_) byte = static_cast<uint8_t>(mixHash(seed_, ++count_, 7) >> 11);
    return {block_, sizeof block_};
  }

 private:
  uint32_t seed_, count_ = 0;
  uint8_t block_[96] = {};
};

void readProperties(GstElement* element) {
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
  for (guint i = 0; i < count; ++i) {
    if ((specs[i]->flags & G_PARAM_READABLE) == 0) continue;
    GValue value = G_VALUE_INIT;
    g_value_init(&value, specs[i]->value_type);
    g_object_get_property(G_OBJECT(element), specs[i]->name, &value);
    g_value_unset(&value);
  }
  g_free(specs);
}

/// Drops what has come out, of which it returns the number.
uint64_t countOut(const Chain& chain) {
  uint64_t out = 0;
  while (const testing::BufferPtr buffer{gst_harness_try_pull(chain.harness())}) ++out;
  return out;
}

/// Exhaustive searches of wide ranges, as the default is, take no lock, and under ThreadSanitizer
/// most of the time.
void narrowSearch(GstElement* element) {
  GObject* object = G_OBJECT(element);
  if (g_object_class_find_property(G_OBJECT_GET_CLASS(element), "max-shift") == nullptr) return;
  guint range = 0;
  g_object_get(object, "max-shift", &range, nullptr);
  if (range == 0 || range > kMostShift) g_object_set(object, "max-shift", kMostShift, nullptr);
}

/// Lets a thread be ahead of the frames by no more than so many turns for each: one that never
/// waits takes the locks from the frames, of which there are then few.
class Pace {
 public:
  explicit Pace(int turnsOfFrame) : turnsOfFrame_(turnsOfFrame) {}
  void addFrame() { ++frames_; }
  void end() { isOver_ = true; }
  /// False once it is over.
  [[nodiscard]] bool wait(int64_t turn) const {
    while (!isOver_ && turn > turnsOfFrame_ * frames_)
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    return !isOver_;
  }

 private:
  const int turnsOfFrame_;
  std::atomic<int64_t> frames_ = 1;
  std::atomic<bool> isOver_ = false;
};

/// Pushes frames through a chain until it has had `pushes` of them, all of which must come out or
/// be refused with an error.
void run(const char* line, const Options& options) {
  const Caps caps{"I420", options.width, options.height};
  Chain chain(line, caps);
  std::vector<GstElement*> elements;
  fuzz::listElements(chain.harness()->element, elements);
  for (GstElement* element : elements) narrowSearch(element);
  Pace pace(kTurnsOfFrame);
  std::thread setter([&] {
    Random random(options.seed);
    for (int64_t turn = 0; pace.wait(turn); ++turn) {
      fuzz::Bytes bytes = random.bytes();
      GstElement* element = bytes.pick(elements);
      fuzz::setRandomProperty(element, bytes);
      narrowSearch(element);
    }
  });
  std::thread getter([&] {
    for (int64_t turn = 0; pace.wait(turn); ++turn) {
      readProperties(elements[static_cast<size_t>(turn) % elements.size()]);
      gst_harness_query_latency(chain.harness());
    }
  });
  Random random(options.seed + 1);
  fuzz::Bytes bytes = random.bytes();
  fuzz::MovingScene scene = fuzz::MovingScene::from(bytes);
  const GstVideoInfo info = caps.info();
  uint64_t out = 0, refused = 0, untold = 0;
  for (int i = 0; i < options.pushes; ++i) {
    testing::BufferPtr buffer = fuzz::paintScene(scene, info);
    scene.advance();
    pace.addFrame();
    if (i % 200 == 199) {
      bytes = random.bytes();
      scene = fuzz::MovingScene::from(bytes);
    }
    GST_BUFFER_PTS(buffer.get()) = static_cast<GstClockTime>(i) * 40 * GST_MSECOND;
    if (chain.push(std::move(buffer)) != GST_FLOW_OK) {
      ++refused;  // Of scope=foreground without bgremove, say.
      untold += chain.complaint(GST_MESSAGE_ERROR).empty();
    }
    out += countOut(chain);
    while (chain.message(GST_MESSAGE_ANY)) {
    }
  }
  pace.end();
  setter.join();
  getter.join();
  gst_harness_push_event(chain.harness(), gst_event_new_eos());  // What is held back comes, too.
  out += countOut(chain);
  std::printf("%d pushed, %" PRIu64 " came out, %" PRIu64 " refused: %.40s ...\n", options.pushes,
              out, refused, line);
  std::fflush(stdout);
  if (out + refused != static_cast<uint64_t>(options.pushes) || untold > 0) std::exit(1);
}

/// Each writes what the others write, after a while in which another thread can join.
void race(int tasks) {
  int64_t sum = 0;
  Executor(2).forEach(tasks, [&](int i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    sum += i;
  });
  std::printf("%d tasks raced: %" PRId64 "\n", tasks, sum);
}

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    if (i + 1 == argc) return false;
    const char* value = argv[i + 1];
    bool isRead = false;
    if (name == "--races") isRead = std::sscanf(value, "%d", &options.races) == 1;
    if (name == "--pushes") isRead = std::sscanf(value, "%d", &options.pushes) == 1;
    if (name == "--seed") isRead = std::sscanf(value, "%" SCNu32, &options.seed) == 1;
    if (name == "--size")
      isRead = std::sscanf(value, "%dx%d", &options.width, &options.height) == 2;
    if (name == "--chain") {
      options.chain = value;
      isRead = std::any_of(std::begin(kChains), std::end(kChains),
                           [&](std::string_view line) { return line.starts_with(value); });
    }
    if (!isRead) return false;
  }
  return true;
}

}  // namespace
}  // namespace rg::stress

int main(int argc, char** argv) {
  using namespace rg;
  stress::Options options;
  if (!stress::parse(argc, argv, options)) {
    std::fputs(stress::kUsage, stderr);
    return 2;
  }
  if (options.races > 0) {
    stress::race(options.races);
    return 0;
  }
  std::printf("seed %" PRIu32 "\n", options.seed);
  gst_init(nullptr, nullptr);
  testing::registerElements();
  for (const std::string_view line : stress::kChains)
    if (line.starts_with(options.chain)) stress::run(line.data(), options);
  return 0;
}
