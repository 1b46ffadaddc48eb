// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/graph/graph.hpp"
#include "core/objects/merge/motion_evidence.hpp"
#include "core/objects/merge/region_comparison.hpp"
#include "core/objects/tracking/looks/object_pixels.hpp"
#include "kernels/motion_evidence.hpp"
#include "kernels/object_pixels.hpp"
#include "kernels/region_comparison.hpp"
#include "tests/kernels/divided.hpp"
#include "tests/kernels/regions.hpp"

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace rg::test {
namespace {

using objects::OwnMotionScratch;

int drawn(size_t i, uint32_t what, int most) {
  const auto range = static_cast<uint32_t>(2 * most + 1);
  return static_cast<int>(hashOf(static_cast<int>(i), most, what) % range) - most;
}

/// Two frames, and regions of the second one that move in all directions.
struct MovedRegions {
  Picture before;
  motion::Motion motion;

  MovedRegions(Size size, int fill, bool isGrey, uint32_t kinds, int sidePx) {
    loadScene(size, fill, 1, isGrey, before);
    const auto labels = std::make_shared<segmentation::Labels>();
    labels->size = size;
    labels->status = Status::Ok;
    labels->ids.resize(size);
    labels->count = numberPatches(kinds, sidePx, labels->ids);
    const auto picture = std::make_shared<Picture>();
    loadScene(size, fill, 2, isGrey, *picture);
    labels->picture = picture;
    const auto stage = graph::makeStage({std::make_shared<Executor>(1), {}});
    motion.size = size;
    motion.graph = *stage->process(labels, {Connectivity::Four});
    for (size_t i = 0; i < labels->count; ++i) {
      const int most = i % 4 == 0 ? 16 * size.width : 70;
      motion.regions.push_back({drawn(i, 1, most), drawn(i, 2, 50), 0, 0});
    }
  }
  [[nodiscard]] const Image<uint16_t>& ids() const { return motion.graph->labels->ids; }
  [[nodiscard]] size_t count() const { return motion.regions.size(); }
};

template <class Check>
void forMovedRegions(const Check& check) {
  forSizesAndFills([&](Size size, int fill) {
    for (const auto& [kinds, sidePx] : {std::pair{1u, 1}, {5u, 3}, {60u, 2}, {3u, 40}})
      check(MovedRegions(size, fill, kinds == 5, kinds, sidePx));
  });
}

/// What is tried of each region, and which of them move: none, or some, of which some cover what
/// lies outside and what others cover, too.
struct Trials {
  OwnMotionScratch s;
  std::vector<objects::OwnMotion> own;

  Trials(const MovedRegions& moved, const CameraMotion& camera, bool hidesAny, int everyRow) {
    const Size size = moved.motion.size;
    s.expected.resize(size);
    s.shown.resize({size.height, 1});
    warpByCamera(moved.before.luma(), camera, oneThread(), s.expected,
                 std::span(s.shown.row(0), static_cast<size_t>(size.height)));
    s.everyRow = everyRow;
    s.mostLevels = static_cast<uint8_t>(15 + 40 * everyRow);
    s.hidesAny = hidesAny;
    s.trials.resize(moved.count());
    for (size_t i = 0; i < moved.count(); ++i) {
      const int most = i % 5 == 4 ? size.width : 4;
      if (i % 3 != 2) s.trials[i].shift = {drawn(i, 3, most), drawn(i, 4, 3)};
      s.moves.push_back(hidesAny && i % 2 == 0 ? 1 : 0);
      own.push_back({{drawn(i, 5, most), drawn(i, 6, 5)}, 0});
    }
  }
  [[nodiscard]] std::vector<gpu::objects::ComparedRegion> listed(const graph::Graph& graph) const {
    std::vector<gpu::objects::ComparedRegion> list;
    for (size_t i = 0; i < own.size(); ++i)
      list.push_back(
          {s.trials[i].shift, own[i].shift, graph.regions[i].box, s.moves[i], s.mostLevels});
    return list;
  }
};

bool isSame(const OwnMotionScratch::Trial& a, const OwnMotionScratch::Trial& b) {
  const auto all = [](const OwnMotionScratch::Trial& t) {
    return std::tuple(t.shift.x, t.shift.y, t.sums.still, t.sums.moved, t.sums.pixels, t.seen);
  };
  return all(a) == all(b);
}

/// Returns how many pixels were compared.
uint64_t checkComparison(const MovedRegions& moved, const CameraMotion& camera, bool hidesAny,
                         int everyRow) {
  const Size size = moved.motion.size;
  Trials trials(moved, camera, hidesAny, everyRow);
  const auto regions = trials.listed(*moved.motion.graph);
  Plane<uint16_t> labels(moved.ids().view());
  Plane<uint8_t> luma(moved.motion.graph->picture->luma()),
      expected(std::as_const(trials.s.expected).view());
  const auto area = static_cast<size_t>(size.area());
  Guarded<uint32_t> hidden(Numbers(area, 0xA5A5A5A5), 0xA5A5A5A5);
  const size_t bandCount = regions.size() * OwnMotionScratch::kBands;
  std::vector<OwnMotionScratch::Sums> bands(bandCount, {7, 7, 7});
  Guarded<OwnMotionScratch::Trial> found(
      std::vector(regions.size(), OwnMotionScratch::Trial{{9, 9}, {}, 9}), {{8, 8}, {}, 8});
  gpu::objects::compareRegions(
      {labels, luma, expected, std::as_const(trials.s.shown).row(0)},
      {regions.data(), static_cast<int>(regions.size()), everyRow, hidesAny},
      {hidden.data(), bands.data(), found.data()}, nullptr);
  objects::compareRegions(moved.motion, trials.own, oneThread(), trials.s);
  found.expect(trials.s.trials, isSame);
  hidden.expectGuarded();
  uint64_t pixels = 0;
  for (const OwnMotionScratch::Trial& trial : trials.s.trials) pixels += trial.seen;
  return pixels;
}

Image<int16_t> someGains(Size grid) {
  Image<int16_t> gains(grid);
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x)
      gains.at(x, y) = static_cast<int16_t>(hashOf(x, y, 7) % 2 * (hashOf(x, y, 8) % 257));
  return gains;
}

/// Cells of which some are no background, and owners of these and of others.
struct SomeCells {
  objects::GroupGrid grid;
  std::vector<uint16_t> owner;

  SomeCells(Size frame, int stepPx, uint32_t tracks) {
    grid.stepPx = stepPx;
    grid.frame = frame;
    grid.grid = {(frame.width + stepPx - 1) / stepPx, (frame.height + stepPx - 1) / stepPx};
    for (int y = 0; y < grid.grid.height; ++y)
      for (int x = 0; x < grid.grid.width; ++x) {
        grid.group.push_back(static_cast<uint16_t>(hashOf(x / 4, y / 4, 1) % 4));
        owner.push_back(static_cast<uint16_t>(hashOf(x / 5, y / 2, 2) % (tracks + 1)));
      }
    grid.listRuns();
  }
  [[nodiscard]] std::vector<uint16_t> owned() const {
    std::vector<uint16_t> owners;
    for (size_t i = 0; i < owner.size(); ++i)
      owners.push_back(grid.group[i] == 0 ? uint16_t{0} : owner[i]);
    return owners;
  }
};

/// Returns how many pixels are owned.
uint64_t checkPixels(const MovedRegions& moved, int stepPx, uint32_t tracks) {
  const graph::Graph& graph = *moved.motion.graph;
  const SomeCells cells(graph.size, stepPx, tracks);
  std::vector<uint8_t> isBackground;
  for (size_t i = 0; i < moved.count(); ++i) isBackground.push_back(i % 3 == 1 ? 1 : 0);
  Image<uint16_t> expected;
  std::vector<objects::ObjectSums> sums(tracks);
  objects::ObjectPixelScratch scratch;
  objects::findObjectPixels(graph, isBackground, {cells.grid, cells.owner}, scratch,
                            {expected, sums});
  const std::vector<uint16_t> owners = cells.owned();
  Plane<uint16_t> labels(moved.ids().view()), slots(graph.size);
  const objects::ObjectSums other{1, 2, 3, 4, 5, 6, {7, 8}};
  Guarded<objects::ObjectSums> found(std::vector(tracks, other), other);
  Numbers firsts(tracks);
  gpu::objects::findObjectPixels({labels, isBackground.data(), owners.data(), stepPx,
                                  cells.grid.grid.width, inOrder(*graph.picture)},
                                 {slots, found.data(), firsts.data(), static_cast<int>(tracks)},
                                 nullptr);
  slots.expect(std::as_const(expected).view(), "slots");
  found.expect(sums, [](const auto& a, const auto& b) { return a == b; });
  uint64_t pixels = 0;
  for (const objects::ObjectSums& sum : sums) pixels += sum.count;
  return pixels;
}

}  // namespace

void parity_compareRegions() {
  uint64_t all = 0, seen = 0, some = 0;
  forMovedRegions([&](const MovedRegions& moved) {
    const CameraMotion shift(Point{21, -13});
    constexpr int64_t kOne = CameraMotion::kOne;
    const CameraMotion zoom({kOne + kOne / 50, kOne / 90, 0, 0, kOne, 2 * kOne, 0, 0, kOne}, {});
    all += checkComparison(moved, shift, false, 1);
    seen += checkComparison(moved, shift, true, 1);
    some += checkComparison(moved, shift, false, 3);
    (void)checkComparison(moved, zoom, true, 2);
  });
  EXPECT_LT(seen, all);
  EXPECT_LT(some, all);
  EXPECT_GT(std::min(seen, some), 0u);
}

void parity_carryEvidence() {
  int64_t all = 0;
  forMovedRegions([&](const MovedRegions& moved) {
    const Size size = moved.motion.size, grid = objects::evidenceGridOf(size);
    const size_t count = moved.count();
    const Image<int16_t> gains = someGains(grid);
    Image<int16_t> expected(grid);
    std::vector<int64_t> sums(count, 0);
    std::vector<uint32_t> samples(count, 0);
    const objects::KnownEvidence known{moved.motion, moved.before, gains, 183};
    objects::carryEvidence(known, oneThread(), {expected, sums, samples});
    Plane<uint16_t> labels(moved.ids().view());
    Plane<uint8_t> luma(moved.motion.graph->picture->luma()), before(moved.before.luma());
    Plane<int16_t> from(gains.view()), to(grid);
    Guarded<int64_t> foundSums(std::vector<int64_t>(count, -5), -6);
    Guarded<uint32_t> foundSamples(Numbers(count, 5), 6);
    gpu::objects::carryEvidence({labels, luma, before, moved.motion.regions.data(),
                                 static_cast<int>(count), from, known.left},
                                {to, foundSums.data(), foundSamples.data()}, nullptr);
    to.expect(std::as_const(expected).view(), "carried");
    const auto isEqual = [](const auto& a, const auto& b) { return a == b; };
    foundSums.expect(sums, isEqual);
    foundSamples.expect(samples, isEqual);
    for (const int64_t sum : sums) all += sum;
  });
  EXPECT_GT(all, 0);
}

void parity_addEvidence() {
  forMovedRegions([](const MovedRegions& moved) {
    const Size grid = objects::evidenceGridOf(moved.motion.size);
    const Image<int16_t> gains = someGains(grid);
    std::vector<int16_t> density;
    for (size_t i = 0; i < moved.count(); ++i)
      density.push_back(static_cast<int16_t>(drawn(i, 9, 256)));
    Image<int16_t> expected(grid);
    objects::addEvidence(*moved.motion.graph, density, gains, oneThread(), expected);
    Plane<uint16_t> labels(moved.ids().view());
    Plane<int16_t> from(gains.view()), to(grid);
    gpu::objects::addEvidence(labels, density.data(), from, to, nullptr);
    to.expect(std::as_const(expected).view(), "sum");
  });
}

void parity_findObjectPixels() {
  uint64_t pixels = 0;
  forMovedRegions([&](const MovedRegions& moved) {
    for (const auto& [stepPx, tracks] : {std::pair{1, 3u}, {3, 1u}, {7, 60u}})
      pixels += checkPixels(moved, stepPx, tracks);
  });
  EXPECT_GT(pixels, 0u);
}

}  // namespace rg::test
