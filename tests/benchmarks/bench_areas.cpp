// SPDX-License-Identifier: LGPL-2.1-or-later
// Areas against the whole frame for 1 to 13 things, as in tables 1 and 2 of the paper: bgremove
// method=frame-difference by search=areas and search=frame, hsvsegment by scope=areas and
// scope=frame. Both sides see the same frames in turn.
#include "core/background/background.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/pixel.hpp"
#include "core/segmentation/segmentation.hpp"
#include "tests/benchmarks/options.hpp"
#include "tests/support/same_regions.hpp"
#include "tests/support/value_of.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>

namespace rg::bench {
namespace {

constexpr int kWarmUp = 40;
constexpr Size kThing{40, 40};

/// What the paper measured, in ms.
struct PaperRow {
  int things, motionAreas, motionFrame, colourAreas, colourFrame;
};
constexpr PaperRow kPaper[] = {{1, 29, 308, 339, 693},  {3, 34, 312, 353, 710},
                               {5, 41, 320, 369, 726},  {7, 48, 329, 385, 736},
                               {10, 52, 338, 409, 747}, {13, 57, 345, 430, 762}};

int bounce(int start, int step, int time, int most) {
  const int p = (start + step * time) % (2 * most);
  return p < most ? p : 2 * most - p;
}

/// Things of two colours that cross a patterned wall; every pixel has noise of two grey levels.
class Scene {
 public:
  Scene(Size size, int things) : size_(size), bytes_(static_cast<size_t>(3 * size.area())) {
    for (int i = 0; i < things; ++i) things_.push_back(Box{});
  }

  void draw(int time) {
    for (size_t i = 0; i < things_.size(); ++i) {
      const int n = static_cast<int>(i);
      things_[i] = {bounce(97 * n, 2 + n % 4, time, size_.width - kThing.width),
                    bounce(61 * n, 1 + n % 3, time, size_.height - kThing.height), kThing.width,
                    kThing.height};
    }
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x) put(x, y, wallAt(x, y), time);
    for (size_t i = 0; i < things_.size(); ++i) drawThing(i, time);
  }

  [[nodiscard]] Frame view() const {
    const PlaneMemory plane{bytes_.data(), bytes_.size(), 3 * size_.width};
    return *Frame::make({PixelFormat::Bgr, size_}, std::array{plane});
  }

 private:
  using Colour = std::array<int, 3>;

  [[nodiscard]] static Colour wallAt(int x, int y) {
    const uint32_t hash = mixHash(static_cast<uint32_t>(x / 40), static_cast<uint32_t>(y / 30), 5);
    return {70 + static_cast<int>(hash % 60), 80 + static_cast<int>(hash >> 8 & 63),
            70 + static_cast<int>(hash >> 16 & 63)};
  }

  void drawThing(size_t i, int time) {
    const Box& box = things_[i];
    const int n = static_cast<int>(i);
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x) {
        const bool isUpper = y < box.y + box.height / 2;
        put(x, y, isUpper ? Colour{30, 20 + 15 * n, 225} : Colour{230, 30, 15 * n}, time);
      }
  }

  void put(int x, int y, const Colour& colour, int time) {
    const uint32_t hash =
        mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(time));
    uint8_t* to = bytes_.data() + (int64_t{y} * size_.width + x) * 3;
    const int noise = static_cast<int>(hash % 5) - 2;
    for (size_t c = 0; c < 3; ++c) to[c] = static_cast<uint8_t>(colour[c] + noise);
  }

  Size size_;
  std::vector<uint8_t> bytes_;
  std::vector<Box> things_;
};

bool isSame(const background::Foreground& a, const background::Foreground& b) {
  bool isSame = a.areas == b.areas;
  for (int y = 0; y < a.size.height; ++y)
    isSame =
        isSame && std::memcmp(a.mask.row(y), b.mask.row(y), static_cast<size_t>(a.size.width)) == 0;
  return isSame;
}

/// Least times over the frames, and what both sides agreed on.
struct Figures {
  double motionAreas = 0, motionFrame = 0, colourAreas = 0, colourFrame = 0;
  int frames = 0, sameFrames = 0;
  test::RegionMatch regions;
};

class Comparison {
 public:
  explicit Comparison(const Options& options)
      : context_{std::make_shared<const Executor>(options.threads), nullptr},
        scene_(options.size, options.regions),
        frames_(options.frames) {}

  Figures run() {
    for (int time = 0; time < kWarmUp + frames_; ++time) {
      if (time == kWarmUp) clear();
      step(time);
    }
    figures_.motionAreas = least(motionAreas_);
    figures_.motionFrame = least(motionFrame_);
    figures_.colourAreas = least(colourAreas_);
    figures_.colourFrame = least(colourFrame_);
    return figures_;
  }

 private:
  /// What a frame takes when nothing else runs on the machine.
  static double least(const std::vector<double>& ms) {
    return *std::min_element(ms.begin(), ms.end());
  }

  void clear() {
    figures_ = {};
    for (auto* list : {&motionAreas_, &motionFrame_, &colourAreas_, &colourFrame_}) list->clear();
  }

  template <class Step>
  static auto timed(std::vector<double>& ms, Step step) {
    const auto start = std::chrono::steady_clock::now();
    auto result = step();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    ms.push_back(took.count());
    return result;
  }

  void step(int time) {
    scene_.draw(time);
    const auto picture = pictures_.take();
    picture->load(scene_.view(), *context_.cpu);
    const FrameTime at{time * int64_t{40'000'000}, true};
    const auto find = [&](background::Stage& stage, background::SearchScope search) {
      background::Params params;
      params.method = background::Method::FrameDifference;
      params.search = search;
      return valueOf(stage.process(picture, params, at));
    };
    const auto whole =
        timed(motionFrame_, [&] { return find(*inFrame_, background::SearchScope::Frame); });
    const auto found =
        timed(motionAreas_, [&] { return find(*inAreas_, background::SearchScope::Areas); });
    const auto divide = [&](segmentation::Scope scope) {
      segmentation::Params params;
      params.scope = scope;
      return valueOf(segmentation_->process(picture, found, params));
    };
    const auto all = timed(colourFrame_, [&] { return divide(segmentation::Scope::Frame); });
    const auto part = timed(colourAreas_, [&] { return divide(segmentation::Scope::Areas); });
    ++figures_.frames;
    figures_.sameFrames += isSame(*whole, *found);
    const test::RegionMatch match = test::matchRegions(*part, *all);
    figures_.regions.whole += match.whole;
    figures_.regions.same += match.same;
  }

  Context context_;
  Scene scene_;
  int frames_;
  Pool<Picture> pictures_;
  std::unique_ptr<background::Stage> inFrame_ = background::makeStage(context_);
  std::unique_ptr<background::Stage> inAreas_ = background::makeStage(context_);
  std::unique_ptr<segmentation::Stage> segmentation_ = segmentation::makeStage(context_);
  std::vector<double> motionAreas_, motionFrame_, colourAreas_, colourFrame_;
  Figures figures_;
};

void printTable(const char* title, const std::vector<std::array<double, 4>>& rows) {
  std::printf("%s\n%7s %9s %9s %7s | paper %6s %6s %6s\n", title, "things", "areas ms", "frame ms",
              "ratio", "areas", "frame", "ratio");
  for (size_t i = 0; i < rows.size(); ++i)
    std::printf("%7d %9.3f %9.3f %7.2f |       %6.0f %6.0f %6.2f\n", kPaper[i].things, rows[i][0],
                rows[i][1], rows[i][0] / rows[i][1], rows[i][2], rows[i][3],
                rows[i][2] / rows[i][3]);
}

int run(const Options& given) {
  Options options = given;
  std::vector<std::array<double, 4>> motion, colour;
  Figures sum;
  for (const PaperRow& paper : kPaper) {
    options.regions = paper.things;
    const Figures figures = Comparison(options).run();
    motion.push_back({figures.motionAreas, figures.motionFrame,
                      static_cast<double>(paper.motionAreas),
                      static_cast<double>(paper.motionFrame)});
    colour.push_back({figures.colourAreas, figures.colourFrame,
                      static_cast<double>(paper.colourAreas),
                      static_cast<double>(paper.colourFrame)});
    sum.frames += figures.frames;
    sum.sameFrames += figures.sameFrames;
    sum.regions.whole += figures.regions.whole;
    sum.regions.same += figures.regions.same;
  }
  printTable("bgremove method=frame-difference (table 1; the paper adds 150 ms to both sides)",
             motion);
  std::printf("same foreground in %d of %d frames\n\n", sum.sameFrames, sum.frames);
  printTable("hsvsegment (table 2)", colour);
  std::printf("same regions inside the areas: %u of %u\n", sum.regions.same, sum.regions.whole);
  std::printf("motion_ratio_of_1=%.3f\n", motion[0][0] / motion[0][1]);
  std::printf("colour_ratio_of_1=%.3f\n", colour[0][0] / colour[0][1]);
  return sum.sameFrames == sum.frames ? 0 : 1;
}

}  // namespace
}  // namespace rg::bench

int main(int argc, char** argv) {
  return rg::bench::runProgram({argv, static_cast<size_t>(argc)}, rg::bench::run);
}
