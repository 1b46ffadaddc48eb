// SPDX-License-Identifier: LGPL-2.1-or-later
// How much later a frame leaves because its lines are written: regionwrite in a live pipeline, with
// what it writes to fast, full, gone or standing still. Times are of one push of a frame with 20
// objects through the element alone, against identity.
//
// usage: bench-writing [FRAMES]      default 5000
#include "tests/benchmarks/timing.hpp"
#include "tests/support/harness.hpp"
#include "tests/support/results.hpp"

#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace rg::bench {
namespace {

constexpr Size kSize{640, 480};
const testing::Caps kCaps{"GRAY8", kSize.width, kSize.height};

std::shared_ptr<objects::Objects> twentyObjects() {
  std::vector<objects::Object> list;
  for (int i = 0; i < 20; ++i)
    list.push_back(testing::object(static_cast<uint64_t>(i) + 1, {30 * i, 20 * i, 24, 48}));
  return testing::objects(kSize, std::move(list));
}

void measure(const char* what, const std::string& line, int frames) {
  testing::Chain chain(line, kCaps);
  gst_harness_set_drop_buffers(chain.harness(), TRUE);
  const auto objects = twentyObjects();
  const testing::BufferPtr pixels = testing::paint(kCaps, 0, testing::square(1, 1, 5));
  std::vector<double> microseconds;
  for (int i = -100; i < frames; ++i) {
    testing::BufferPtr frame(gst_buffer_copy(pixels.get()));
    GST_BUFFER_PTS(frame.get()) = static_cast<GstClockTime>(i + 100) * 40 * GST_MSECOND;
    attachResult<objects::Objects>(frame.get(), objects);
    const double before = nowMs(Clock::Wall);
    if (chain.push(std::move(frame)) != GST_FLOW_OK) std::exit(1);
    if (i >= 0) microseconds.push_back(1000 * (nowMs(Clock::Wall) - before));
  }
  guint64 dropped = 0;
  if (line != "identity") {
    GstElement* element = chain.element("regionwrite");
    g_object_get(element, "dropped", &dropped, nullptr);
    gst_object_unref(element);
  }
  std::printf("%-24s %10.1f %10.1f %10.1f %10" G_GUINT64_FORMAT "\n", what, median(microseconds),
              percentile99(microseconds),
              *std::max_element(microseconds.begin(), microseconds.end()), dropped);
}

void run(int frames) {
  char name[] = "/tmp/bench-writing-XXXXXX";
  const std::filesystem::path folder = mkdtemp(name);
  const std::string pipe = folder / "pipe", file = folder / "file";
  if (mkfifo(pipe.c_str(), 0600) != 0) std::exit(1);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  std::printf("%-24s %10s %10s %10s %10s\n", "us a frame", "median", "99 %", "worst", "dropped");
  measure("no writer", "identity", frames);
  measure("a file", "regionwrite location=" + file, frames);
  measure("a file, drop=false", "regionwrite drop=false location=" + file, frames);
  measure("a full disk", "regionwrite location=/dev/full", frames);
  measure("a reader that stands", "regionwrite location=" + pipe, frames);
  close(reader);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace rg::bench

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  rg::testing::registerElements();
  const int frames = argc > 1 ? std::atoi(argv[1]) : 5000;
  if (frames < 1) {
    std::fprintf(stderr, "usage: bench-writing [FRAMES]\n");
    return 2;
  }
  rg::bench::run(frames);
  return 0;
}
