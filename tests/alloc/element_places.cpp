// SPDX-License-Identifier: LGPL-2.1-or-later
// Whole chains: what comes behind a frame that failed in one element is what
// comes where that element was reset instead, and the others never saw the
// frame.
#include "gst/meta/result_meta.hpp"
#include "tests/alloc/places.hpp"
#include "tests/support/digest.hpp"
#include "tests/support/harness.hpp"

#include <cstdlib>
#include <map>
#include <memory>
#include <sys/wait.h>
#include <unistd.h>

namespace rg::testing {
namespace {

constexpr int kFrames = 16;
constexpr int kFailing[] = {0, 1, 7, 12};
const Caps kCaps{"I420", 64, 48}, kOtherCaps{"I420", 80, 40};

struct Scenario {
  const char* name;
  std::string line;
  int pan = 0;  ///< Pixels a frame.
};

std::vector<Scenario> scenarios() {
  const std::string graphs = "srg threads=1 ! prmmotion threads=1 ! mrfmerge threads=1";
  const std::string still = "bgremove threads=1 ! hsvsegment threads=1 min-area=12 ! " + graphs;
  std::vector<Scenario> all{
      {"writing", still + " ! regionwrite location=/dev/null contours=true"},
      {"masks behind a latency", still + " latency=0.12 ! regionmask source=objects"},
      {"a pan",
       "hsvsegment threads=1 min-area=12 ! " + graphs +
           " ! regionwrite location=/dev/null format=graph",
       1},
      {"areas by the paper",
       "bgremove threads=1 method=paper training-frames=3 "
       "areas-of-interest=\"0.1,0.1 0.9,0.1 "
       "0.9,0.9 0.1,0.9\" ! hsvsegment threads=1 scope=areas ! " +
           graphs},
      {"all in one", "regiontrack threads=1"}};
#ifdef REGIONGRAPH_HAS_OVERLAY
  all.push_back({"drawing", still + " ! regionoverlay contours=true vectors=true "
                                    "graph=true grid=true background=black"});
#endif
  return all;
}

/// A wall with a thing that walks through and one that stops.
BufferPtr frameAt(const Caps& caps, int time, int pan) {
  const int walker = 3 * time - 6, parker = 50 - 2 * std::min(time, 8);
  return paint(caps, time, [=](int px, int y) -> uint8_t {
    const int x = px + pan * time;
    if (px >= walker && px < walker + 12 && y >= 6 && y < 22)
      return static_cast<uint8_t>(200 + (px - walker) % 5 * 8);
    if (px >= parker && px < parker + 14 && y >= 26 && y < 38)
      return static_cast<uint8_t>(30 + (y - 26) % 4 * 8);
    return static_cast<uint8_t>(90 + (x / 5 * 7 + y / 6 * 11) % 60);
  });
}

template <class Payload>
void addResult(GstBuffer* buffer, Digest& digest) {
  const auto result = findResult<Payload>(buffer);
  digest.add(result ? digestOf(*result) : 0);
}

/// The frames that came out, by their times.
using Shown = std::map<GstClockTime, uint64_t>;

void collect(Chain& chain, Shown& shown) {
  while (GstBuffer* pulled = gst_harness_try_pull(chain.harness())) {
    const BufferPtr buffer(pulled);
    Digest digest;
    addResult<background::Foreground>(pulled, digest);
    addResult<segmentation::Labels>(pulled, digest);
    addResult<graph::Graph>(pulled, digest);
    addResult<motion::Motion>(pulled, digest);
    addResult<objects::Objects>(pulled, digest);
    for (const uint8_t byte : bytesOf(pulled)) digest.add(byte);
    shown[GST_BUFFER_PTS(pulled)] = digest.value();
  }
}

void pushFrames(Chain& chain, const Scenario& scenario, int first, int last, Shown& shown,
                const Caps& caps = kCaps) {
  for (int i = first; i < last; ++i) {
    chain.push(frameAt(caps, i, scenario.pan));
    collect(chain, shown);
  }
}

/// All frames from `first` on, and those that are held.
Shown finish(Chain& chain, const Scenario& scenario, int first, const Caps& caps = kCaps) {
  Shown shown;
  pushFrames(chain, scenario, first, kFrames, shown, caps);
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  collect(chain, shown);
  shown.erase(shown.begin(),
              shown.lower_bound(static_cast<GstClockTime>(first) * 40 * GST_MSECOND));
  return shown;
}

/// An object's name without the number that tells it from others of its kind.
std::string kindOf(gpointer object) {
  std::string name = GST_OBJECT_NAME(object);
  name.erase(name.find_last_not_of("0123456789") + 1);
  return name;
}

/// The kind of the element that posted an error; empty where there is none.
std::string culprit(Chain& chain) {
  const MessagePtr error = chain.message(GST_MESSAGE_ERROR);
  return error ? kindOf(GST_MESSAGE_SRC(error.get())) : std::string();
}

GstElement* findElement(const Chain& chain, const std::string& kind) {
  GstIterator* all = gst_bin_iterate_recurse(GST_BIN(chain.harness()->element));
  GValue item = G_VALUE_INIT;
  const auto isOther = [](gconstpointer value, gconstpointer wanted) {
    void* element = g_value_get_object(static_cast<const GValue*>(value));
    return kindOf(element) == *static_cast<const std::string*>(wanted) ? 0 : 1;
  };
  GstElement* found = nullptr;
  if (gst_iterator_find_custom(all, isOther, &item, const_cast<std::string*>(&kind))) {
    found = GST_ELEMENT(g_value_dup_object(&item));
    g_value_unset(&item);
  }
  gst_iterator_free(all);
  return found;
}

struct Unref {
  void operator()(gpointer object) const { gst_object_unref(object); }
};
using PadPtr = std::unique_ptr<GstPad, Unref>;

/// Has an element lose the next frame.
void loseFrame(GstElement* element) {
  const PadPtr pad(gst_element_get_static_pad(element, "sink"));
  gst_pad_add_probe(
      pad.get(), GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad* probed, GstPadProbeInfo* info, gpointer) {
        gst_pad_remove_probe(probed, info->id);
        return GST_PAD_PROBE_DROP;
      },
      nullptr, nullptr);
}

/// Resets an element by another stream, of which those behind it never hear.
void resetAlone(GstElement* element) {
  const PadPtr sink(gst_element_get_static_pad(element, "sink"));
  const PadPtr src(gst_element_get_static_pad(element, "src"));
  gst_pad_add_probe(
      src.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM,
      [](GstPad*, GstPadProbeInfo* info, gpointer) {
        const bool isStart = GST_EVENT_TYPE(info->data) == GST_EVENT_STREAM_START;
        return isStart ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
      },
      nullptr, nullptr);
  gst_pad_send_event(sink.get(), gst_event_new_stream_start("another"));
}

/// What comes behind frame `failing` where it never reached `resetElement`, and
/// that was reset.
Shown expectedBehind(const Scenario& scenario, int failing, const std::string& resetElement) {
  Chain chain(scenario.line, kCaps);
  Shown before;
  pushFrames(chain, scenario, 0, failing, before);
  if (resetElement.empty()) {
    pushFrames(chain, scenario, failing, failing + 1, before);
    return finish(chain, scenario, failing + 1);
  }
  GstElement* element = findElement(chain, resetElement);
  if (!element) return {};
  loseFrame(element);
  pushFrames(chain, scenario, failing, failing + 1, before);
  resetAlone(element);
  gst_object_unref(element);
  return finish(chain, scenario, failing + 1);
}

Outcome compare(const Shown& shown, const Shown& expected) {
  return !shown.empty() && shown == expected ? Outcome::Graceful : Outcome::Wrong;
}

/// Expectations by the element that failed; made when they are first asked for.
class Expectations {
 public:
  explicit Expectations(std::function<Shown(const std::string&)> make) : make_(std::move(make)) {}
  const Shown& of(const std::string& culprit) {
    const auto known = made_.find(culprit);
    return known != made_.end() ? known->second : made_[culprit] = make_(culprit);
  }

 private:
  const std::function<Shown(const std::string&)> make_;
  std::map<std::string, Shown> made_;
};

Place streaming(const Scenario& scenario, int failing) {
  const auto expectations = std::make_shared<Expectations>(
      [=](const std::string& element) { return expectedBehind(scenario, failing, element); });
  return {std::string(scenario.name) + ", frame " + std::to_string(failing),
          [=](const Fault& fault) {
            Chain chain(scenario.line, kCaps);
            Shown before;
            pushFrames(chain, scenario, 0, failing, before);
            BufferPtr frame = frameAt(kCaps, failing, scenario.pan);
            armMemory(fault);
            chain.push(std::move(frame));
            if (!disarm()) return Outcome::NotReached;
            const std::string element = culprit(chain);
            return compare(finish(chain, scenario, failing + 1), expectations->of(element));
          }};
}

/// A change of size with things in view; the caps are sent again with the next
/// frame.
Place changing(const Scenario& scenario) {
  const auto run = [=](const Fault& fault, bool& hasFailed) {
    Chain chain(scenario.line, kCaps);
    Shown before;
    pushFrames(chain, scenario, 0, 8, before);
    GstCaps* caps = gst_caps_from_string(kOtherCaps.text().c_str());
    armMemory(fault);
    gst_harness_push_event(chain.harness(), gst_event_new_caps(caps));
    hasFailed = disarm();
    gst_caps_unref(caps);
    return finish(chain, scenario, 8, kOtherCaps);
  };
  const auto expected = std::make_shared<Shown>();
  return {std::string(scenario.name) + ", new caps", [=](const Fault& fault) {
            bool hasFailed = false;
            if (expected->empty()) *expected = run({}, hasFailed);
            const Shown shown = run(fault, hasFailed);
            return hasFailed ? compare(shown, *expected) : Outcome::NotReached;
          }};
}

/// From NULL to PLAYING, which may fail, and once more.
Place starting(const Scenario& scenario) {
  const auto run = [=](const Fault& fault, bool& hasFailed) {
    Chain chain(scenario.line, kCaps);
    GstElement* element = chain.harness()->element;
    gst_element_set_state(element, GST_STATE_NULL);
    armMemory(fault);
    gst_element_set_state(element, GST_STATE_PLAYING);
    hasFailed = disarm();
    gst_element_set_state(element, GST_STATE_NULL);
    if (gst_element_set_state(element, GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE)
      return Shown{};
    gst_harness_push_event(chain.harness(), gst_event_new_stream_start("once-more"));
    chain.setCaps(kCaps);
    return finish(chain, scenario, 0);
  };
  const auto expected = std::make_shared<Shown>();
  return {std::string(scenario.name) + ", start", [=](const Fault& fault) {
            bool hasFailed = false;
            if (expected->empty()) *expected = run({}, hasFailed);
            const Shown shown = run(fault, hasFailed);
            return hasFailed ? compare(shown, *expected) : Outcome::NotReached;
          }};
}

enum Verdict : int { kNotReached = 3, kGraceful = 4, kWrong = 5 };

int runWithFewThreads(const Fault& fault) {
  const Scenario scenario{"threads", "regiontrack threads=2"};
  armThreads(fault);
  Chain chain(scenario.line, kCaps);
  const Shown shown = finish(chain, scenario, 0);
  if (!disarm()) return kNotReached;
  Chain serial("regiontrack threads=1", kCaps);
  const Shown expected = finish(serial, scenario, 0);
  return !shown.empty() && shown == expected ? kGraceful : kWrong;
}

/// In a child each: a process starts its threads only once.
Place threads() {
  return {"threads", [](const Fault& fault) {
            const pid_t child = fork();
            if (child == 0) _exit(runWithFewThreads(fault));
            int status = 0;
            if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status))
              std::abort();  // Counted as a crash.
            switch (WEXITSTATUS(status)) {
              case kNotReached:
                return Outcome::NotReached;
              case kGraceful:
                return Outcome::Graceful;
              default:
                return Outcome::Wrong;
            }
          }};
}

}  // namespace

std::vector<Place> elementPlaces() {
  gst_init(nullptr, nullptr);
  registerElements();
  std::vector<Place> places{threads()};
  for (const Scenario& scenario : scenarios()) {
    places.push_back(starting(scenario));
    places.push_back(changing(scenario));
    for (const int failing : kFailing) places.push_back(streaming(scenario, failing));
  }
  return places;
}

}  // namespace rg::testing
