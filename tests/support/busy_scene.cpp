// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/busy_scene.hpp"

#include "core/base/pixel.hpp"
#include "gst/meta/result_meta.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <malloc.h>
#include <mutex>
#include <sstream>
#include <thread>

namespace rg::testing {
namespace {

uint32_t seed() {
  const char* text = std::getenv("RG_SEED");
  return text ? static_cast<uint32_t>(std::strtoul(text, nullptr, 10)) : 1;
}

/// FNV-1a over whole values.
class Checksum {
 public:
  template <class T>
  void add(T value) {
    const auto bits = static_cast<uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8)
      sum_ = (sum_ ^ (bits >> shift & 0xff)) * 0x100000001b3ULL;
  }
  template <class T>
  void addImage(const Image<T>& image) {
    for (int y = 0; y < image.size().height; ++y)
      for (int x = 0; x < image.size().width; ++x) add(image.at(x, y));
  }
  void addBox(const Box& box) {
    for (const int v : {box.x, box.y, box.width, box.height}) add(v);
  }
  [[nodiscard]] uint64_t value() const { return sum_; }

 private:
  uint64_t sum_ = 0xcbf29ce484222325ULL;
};

template <class Result>
void tellHead(std::ostream& out, const char* name, const Result& result) {
  out << name << ' ' << result.size.width << 'x' << result.size.height << " status "
      << static_cast<int>(result.status) << ' ';
}

void tellForeground(std::ostream& out, const background::Foreground& foreground) {
  tellHead(out, "mask", foreground);
  Checksum sum;
  sum.addImage(foreground.mask);
  for (const Box& area : foreground.areas) sum.addBox(area);
  out << foreground.areas.size() << " areas " << sum.value() << '\n';
}

void tellLabels(std::ostream& out, const segmentation::Labels& labels) {
  tellHead(out, "labels", labels);
  Checksum sum;
  sum.addImage(labels.ids);
  out << labels.count << ' ' << sum.value() << '\n';
}

void tellGraph(std::ostream& out, const graph::Graph& graph) {
  tellHead(out, "graph", graph);
  Checksum sum;
  for (const graph::Region& region : graph.regions) {
    sum.add(region.areaPx);
    sum.addBox(region.box);
  }
  for (const graph::Arc& arc : graph.arcs) {
    sum.add(arc.a.number());
    sum.add(arc.b.number());
    sum.add(arc.borderPx);
  }
  out << graph.regions.size() << " regions " << graph.arcs.size() << " arcs " << sum.value()
      << '\n';
}

void tellMotion(std::ostream& out, const motion::Motion& motion) {
  tellHead(out, "motion", motion);
  Checksum sum;
  for (const motion::RegionMotion& region : motion.regions) {
    sum.add(region.dx);
    sum.add(region.dy);
  }
  out << sum.value() << '\n';
}

void tellObject(std::ostream& out, const objects::Object& object, size_t name) {
  out << "  object " << name << " state " << static_cast<int>(object.state) << " at "
      << object.box.x << ',' << object.box.y << ' ' << object.box.width << 'x' << object.box.height
      << " area " << object.areaPx << " centre " << object.centroidX << ',' << object.centroidY
      << " speed " << object.speedX << ',' << object.speedY << " age " << object.ageFrames << '\n';
}

}  // namespace

int campaign(int count) {
  const char* times = std::getenv("RG_CAMPAIGN");
#ifdef __SANITIZE_ADDRESS__
  constexpr int kShare = 4;
#else
  constexpr int kShare = 1;
#endif
  return std::max(1, count * std::max(1, times ? std::atoi(times) : 1) / kShare);
}

Chance::Chance(uint32_t salt) : numbers_(seed() + 1000003 * salt) {
  std::printf("RG_SEED=%u\n", seed());
}

struct Watchdog::Impl {
  std::mutex mutex;
  std::condition_variable changed;
  bool isDone = false;
  std::thread thread;
};

Watchdog::Watchdog(int seconds) : impl_(std::make_unique<Impl>()) {
  impl_->thread = std::thread([seconds, impl = impl_.get()] {
    std::unique_lock lock(impl->mutex);
    if (impl->changed.wait_for(lock, std::chrono::seconds(seconds), [=] { return impl->isDone; }))
      return;
    std::fprintf(stderr, "watchdog: nothing came to an end in %d s\n", seconds);
    std::abort();
  });
}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->isDone = true;
  }
  impl_->changed.notify_one();
  impl_->thread.join();
}

BufferPtr busyFrame(const Caps& caps, int index) {
  constexpr int kThings = 3;
  const int side = std::max(1, std::min(caps.width, caps.height) / 4);
  const int step = std::max(1, caps.width / 32);
  const int lap = caps.width + side;
  return paint(caps, index, [=](int x, int y) -> uint8_t {
    const auto px = static_cast<uint32_t>(x), py = static_cast<uint32_t>(y);
    uint32_t value = 70 + mixHash(px / 6, py / 6, 7) % 24;
    for (int i = 0; i < kThings && index >= kFirstBusy; ++i) {
      const int way = (index * step + i * lap / kThings) % lap;
      const int left = (i == 1 ? lap - way : way) - side, top = i * caps.height / kThings;
      if (x < left || x >= left + side || y < top || y >= top + side) continue;
      value =
          170 + static_cast<uint32_t>(i) * 25 +
          mixHash(static_cast<uint32_t>(x - left) / 3, static_cast<uint32_t>(y - top) / 3, 99) % 30;
    }
    return static_cast<uint8_t>(value);
  });
}

int objectsOn(GstBuffer* buffer) {
  const auto objects = buffer ? findResult<objects::Objects>(buffer) : nullptr;
  if (!objects) return 0;
  return static_cast<int>(
      std::count_if(objects->objects.begin(), objects->objects.end(),
                    [](const objects::Object& object) { return objects::isListed(object.state); }));
}

bool showObjects(Chain& chain, int& index) {
  constexpr int kMost = 40;
  for (const int end = index + kMost; index < end;)
    if (const BufferPtr out = chain.pass(busyFrame(chain.caps(), index++));
        out && objectsOn(out.get()) > 0)
      return true;
  return false;
}

std::string Story::tell(GstBuffer* buffer) {
  std::ostringstream out;
  if (!buffer) return "no frame\n";
  if (const auto foreground = findResult<background::Foreground>(buffer))
    tellForeground(out, *foreground);
  if (const auto labels = findResult<segmentation::Labels>(buffer)) tellLabels(out, *labels);
  if (const auto graph = findResult<graph::Graph>(buffer)) tellGraph(out, *graph);
  if (const auto motion = findResult<motion::Motion>(buffer)) tellMotion(out, *motion);
  const auto objects = findResult<objects::Objects>(buffer);
  if (!objects) return out.str();
  tellHead(out, "objects", *objects);
  Checksum sum;
  sum.addImage(objects->slots);
  for (const objects::GroupIndex group : objects->regionGroup) sum.add(group.index());
  out << "camera " << objects->cameraDx << ',' << objects->cameraDy << ' ' << sum.value() << '\n';
  for (const objects::Object& object : objects->objects)
    tellObject(out, object, names_.try_emplace(object.id, names_.size() + 1).first->second);
  return out.str();
}

size_t heapBytes() {
  malloc_trim(0);
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

bool sendCaps(Chain& chain, const std::string& text) {
  GstCaps* caps = gst_caps_from_string(text.c_str());
  const bool isSent = caps && gst_caps_is_fixed(caps) &&
                      gst_harness_push_event(chain.harness(), gst_event_new_caps(caps));
  if (caps) gst_caps_unref(caps);
  return isSent;
}

void expectPlateau(const std::vector<size_t>& levels, size_t slackBytes) {
  ASSERT_FALSE(levels.empty());
  const auto early = static_cast<std::ptrdiff_t>(levels.size() / 3 + 1);
  EXPECT_LE(levels.back(), *std::max_element(levels.begin(), levels.begin() + early) + slackBytes);
}

void beginStream(Chain& chain, const char* streamId) {
  gst_harness_push_event(chain.harness(), gst_event_new_stream_start(streamId));
  chain.setCaps(chain.caps());
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(chain.harness(), gst_event_new_segment(&segment));
}

void flush(Chain& chain) {
  gst_harness_push_event(chain.harness(), gst_event_new_flush_start());
  gst_harness_push_event(chain.harness(), gst_event_new_flush_stop(TRUE));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(chain.harness(), gst_event_new_segment(&segment));
}

}  // namespace rg::testing
