// SPDX-License-Identifier: LGPL-2.1-or-later
// Many frames of several kinds of scenes through the whole chain, as fast as they go: what is in
// use of the heap must not grow. Prints the slope for each scene; fails where it is too steep.
//
// usage: soak [--frames N] [--warm-up N] [--size WxH] [--scene NAME] [--lose BYTES]
//   --frames   in all (default 20000)
//   --warm-up  so many of them come before the first point (default: a fifth). Larger frames need
//              longer: what a vector has grown to for one busy frame, it keeps.
//   --lose     so many bytes in each round of the scenes, to see that it is found
#include "core/base/pixel.hpp"
#include "tests/fuzz/moving_scene.hpp"
#include "tests/stress/heap_count.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace rg::stress {
namespace {

using testing::Caps;
using testing::Chain;

// The harness says that it is live, where up to 4 MiB of lines wait for the writer: how many
// depends on what else the machine does. drop=false waits for each.
constexpr char kChain[] =
    "bgremove threads=1 ! hsvsegment threads=1 ! srg threads=1 ! prmmotion threads=1 ! "
    "mrfmerge threads=1 ! regionwrite location=/dev/null contours=true drop=false";
constexpr char kMovingChain[] =
    "hsvsegment threads=1 ! srg threads=1 ! prmmotion threads=1 ! mrfmerge threads=1 ! "
    "regionwrite location=/dev/null contours=true drop=false";
constexpr int kMostScenes = 10;     // Among ever other ones one always needs most so far.
constexpr int kRestFrames = 75;     // After 50 whoever isn't seen has ended.
constexpr size_t kShare = 8;        // Of all points, those that are compared with one.
constexpr double kMostSlope = 1.0;  // Bytes in 1000 frames.

struct Options {
  int frames = 20000;
  int warmUp = -1;  ///< A fifth.
  int width = 64, height = 48;
  std::string scene;
  int lostBytes = 0;
};

/// Bytes that describe a scene (fuzz::MovingScene): things, then the ground.
fuzz::MovingScene describe(uint32_t seed, uint8_t things, uint8_t noise, uint8_t pan) {
  std::vector<uint8_t> bytes{things};
  for (uint32_t i = 0; i < things * 8u; ++i)
    bytes.push_back(static_cast<uint8_t>(mixHash(seed, i, 1) >> 7));
  bytes.insert(bytes.end(), {90, 31, noise, pan, 0});
  fuzz::Bytes source(bytes.data(), bytes.size());
  return fuzz::MovingScene::from(source);
}

/// A scene is remade every so many frames, as things leave the picture.
struct Kind {
  const char* name;
  const char* chain;
  int lifeFrames;
  uint8_t things, noise, pan;
};
constexpr uint8_t kCalm = 6;  // Grey levels of noise.
constexpr Kind kKinds[] = {
    {"typical", kChain, 150, 4, kCalm, 0}, {"noise", kChain, 150, 4, 255, 0},
    {"cuts", kChain, 8, 6, kCalm, 0},      {"pan", kMovingChain, 150, 4, kCalm, 12},
    {"empty", kChain, 150, 0, kCalm, 0},
};

/// The median of the slopes between points that are at most a share of all apart, in bytes a frame.
/// What grows again and again is between most of these; the steps of vectors that have seen their
/// busiest frame, which get rarer but never end, are between few. Between all points, as Theil and
/// Sen take them, a single step halfway would be between most.
double slopeOf(const std::vector<std::pair<double, double>>& points) {
  const size_t reach = std::max<size_t>(1, points.size() / kShare);
  std::vector<double> slopes;
  for (size_t i = 0; i < points.size(); ++i)
    for (size_t j = i + 1; j < points.size() && j <= i + reach; ++j)
      slopes.push_back((points[j].second - points[i].second) / (points[j].first - points[i].first));
  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  std::nth_element(slopes.begin(), middle, slopes.end());
  return *middle;
}

/// Bytes that nobody will find again.
void lose(int bytes) {
  [[maybe_unused]] static void* volatile last;
  last = ::operator new(static_cast<size_t>(bytes));
}

bool run(const Kind& kind, const Options& options) {
  const Caps caps{"I420", options.width, options.height};
  const GstVideoInfo info = caps.info();
  Chain chain(kind.chain, caps);
  // What is in use goes up and down with the things in view, so a round of scenes ends with a calm
  // and empty one, and a point is the least of that: what is never given back is in that too. The
  // warm-up is at least two rounds.
  const int warmUp = options.warmUp < 0 ? options.frames / 5 : options.warmUp;
  const int scenes = std::clamp((warmUp / 2 - kRestFrames) / kind.lifeFrames, 1, kMostScenes);
  const int restFrom = scenes * kind.lifeFrames, round = restFrom + kRestFrames;
  std::vector<std::pair<double, double>> points;
  // It lies on the heap that it measures.
  points.reserve(static_cast<size_t>((options.frames - warmUp) / round) + 1);
  constexpr size_t kNone = std::numeric_limits<size_t>::max();
  size_t least = kNone;
  fuzz::MovingScene scene = describe(0, kind.things, kind.noise, kind.pan);
  for (int i = 0; i < options.frames; ++i) {
    const int at = i % round;
    if (at == restFrom)
      scene = describe(0, 0, kCalm, 0);
    else if (at < restFrom && at % kind.lifeFrames == 0)
      scene =
          describe(static_cast<uint32_t>(at / kind.lifeFrames), kind.things, kind.noise, kind.pan);
    testing::BufferPtr buffer = fuzz::paintScene(scene, info);
    scene.advance();
    GST_BUFFER_PTS(buffer.get()) = static_cast<GstClockTime>(i) * 40 * GST_MSECOND;
    if (!chain.pass(std::move(buffer))) return false;
    while (chain.message(GST_MESSAGE_ANY)) {
    }
    if (options.lostBytes && at == 0) lose(options.lostBytes);
    if (i < warmUp || at < restFrom) continue;
    least = std::min(least, bytesInUse());
    if (at == round - 1) points.emplace_back(i, std::exchange(least, kNone));
  }
  if (points.size() < 2) {
    std::printf("%s: --frames %d is too few, %d at least\n", kind.name, options.frames,
                warmUp + 2 * round);
    return false;
  }
  const double slope = 1000 * slopeOf(points);
  const bool isFlat = std::abs(slope) < kMostSlope;
  std::printf("%-8s %d frames of %dx%d: %.0f bytes in use, %+.3f bytes in 1000 frames%s\n",
              kind.name, options.frames, options.width, options.height, points.back().second, slope,
              isFlat ? "" : ": TOO MUCH");
  std::fflush(stdout);
  return isFlat;
}

}  // namespace
}  // namespace rg::stress

int main(int argc, char** argv) {
  using namespace rg;
  stress::Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--frames") == 0) options.frames = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--warm-up") == 0) options.warmUp = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--scene") == 0) options.scene = argv[i + 1];
    if (std::strcmp(argv[i], "--lose") == 0) options.lostBytes = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--size") == 0 &&
        std::sscanf(argv[i + 1], "%dx%d", &options.width, &options.height) != 2)
      return 2;
  }
  gst_init(nullptr, nullptr);
  testing::registerElements();
  bool isFlat = true;
  for (const stress::Kind& kind : stress::kKinds)
    if (options.scene.empty() || options.scene == kind.name) isFlat &= stress::run(kind, options);
  return isFlat ? 0 : 1;
}
