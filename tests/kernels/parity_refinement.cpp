// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/refinement/motion_consensus.hpp"
#include "core/motion/refinement/motion_fit.hpp"
#include "core/motion/refinement/refinement_rules.hpp"
#include "kernels/motion_refinement.hpp"
#include "tests/kernels/matched_regions.hpp"
#include "tests/kernels/parity.hpp"

#include <tuple>
#include <vector>

namespace rg::test {
namespace {

using motion::MotionFit;
using motion::MotionPrior;
using motion::RefinedRegion;
using motion::RegionMotion;
using motion::SeenMotion;

constexpr int kReach = 7;

auto numbersOf(const motion::Information& i) {
  return std::tuple(i.xx, i.xy, i.yy);
}
auto numbersOf(const MotionFit& fit) {
  return std::tuple(fit.at, fit.slopes, numbersOf(fit.information), fit.misfit, fit.pixels,
                    fit.seen);
}
auto numbersOf(const RegionMotion& m) {
  return std::tuple(m.dx, m.dy, m.sad, m.reliability);
}

/// −most … most.
int draw(int a, int b, uint32_t what, int most) {
  return static_cast<int>(hashOf(a, b, what) % static_cast<uint32_t>(2 * most + 1)) - most;
}

/// The planes on both sides.
struct Planes {
  motion::PaddedLuma before, smoothBefore, smoothNow;
  Plane<uint8_t> now;
  DeviceLuma previous, smoothPrevious, smooth;

  explicit Planes(const MovedPicture& moved)
      : before(padded(moved.before, false)),
        smoothBefore(padded(moved.before, true)),
        smoothNow(padded(moved.now, true)),
        now(moved.now.view()),
        previous(before, moved.now.size()),
        smoothPrevious(smoothBefore, moved.now.size()),
        smooth(smoothNow, moved.now.size()) {
    Plane<uint8_t> earlier(moved.before.view());
    gpu::motion::padLuma(earlier, previous.view, nullptr);
    gpu::motion::padSmooth(earlier, smoothPrevious.view, nullptr);
    gpu::motion::padSmooth(now, smooth.view, nullptr);
  }
  static motion::PaddedLuma padded(const Image<uint8_t>& luma, bool isSmooth) {
    motion::PaddedLuma made;
    if (isSmooth)
      made.buildSmooth(luma, kReach, oneThread());
    else
      made.build(luma, kReach, oneThread());
    return made;
  }
  gpu::motion::SeenPlanes there() {
    const ImageView<uint8_t> rows = smooth.rows;
    return {{now, previous.view},
            {{rows.row(kReach) + kReach, now.view().size, rows.strideBytes}, smoothPrevious.view}};
  }
  [[nodiscard]] motion::FitPlane here(const MovedPicture& moved, bool isSmooth) const {
    return isSmooth ? motion::FitPlane{smoothNow.inside(), &smoothBefore}
                    : motion::FitPlane{moved.now, &before};
  }
};

/// Whole vectors and limits of all kinds; one region has no parts, one has not been found.
struct Refined {
  Regions parts;
  std::vector<RefinedRegion> regions;
  std::vector<gpu::motion::FitState> states;

  explicit Refined(const Regions& matched) : parts(matched) {
    parts.starts.push_back(parts.starts.back());
    for (int i = 0; i < parts.count(); ++i) {
      RefinedRegion region;
      region.centroid = {20 + draw(i, 1, 7, 20), 20 + draw(i, 1, 8, 20)};
      region.at = {draw(i, 1, 1, 2) * motion::kFine, draw(i, 1, 2, 2) * motion::kFine};
      region.limit = i % 2 == 0 ? motion::kMostLimit : 900 + draw(i, 1, 9, 800);
      for (const motion::MatchedPart& part : parts.of(i))
        region.pixels += static_cast<int>(part.pixels());
      region.reliability = i % 4 == 3 ? 0 : 128 + draw(i, 1, 3, 128);
      region.isFound = i == 2 ? 0 : 1;
      regions.push_back(region);
    }
    states.resize(regions.size());
  }
  gpu::motion::RefinedRegions view() { return {parts.view(), regions.data(), states.data()}; }
  [[nodiscard]] motion::FitRegion fitted(size_t i) const {
    return {parts.of(static_cast<int>(i)), regions[i].centroid, regions[i].limit};
  }
};

template <class Check>
void forRefined(const Check& check) {
  forMoved([&](const MovedPicture& moved, const Regions& regions) {
    Planes planes(moved);
    Refined refined(regions);
    check(moved, planes, refined);
  });
}

/// What a region's pixels alone say.
struct OwnFit {
  MotionFit fit;
  bool isSmooth = false;
};
OwnFit fitAlone(const MovedPicture& moved, const Planes& planes, const Refined& refined, size_t i) {
  OwnFit own;
  MotionFit start;
  start.at = own.fit.at = refined.regions[i].at;
  int64_t known = -1;
  for (const bool isSmooth : {false, true}) {
    if (refined.regions[i].pixels == 0) continue;
    const MotionFit fit = motion::fitMotion(refined.fitted(i), planes.here(moved, isSmooth), start,
                                            {}, motion::kTrialSteps);
    if (motion::leastInformation(fit.information) <= known) continue;
    known = motion::leastInformation(fit.information);
    own = {fit, isSmooth};
  }
  return own;
}

}  // namespace

void parity_fitAlone() {
  int moved = 0, smooth = 0;
  forRefined([&](const MovedPicture& picture, Planes& planes, Refined& refined) {
    const size_t count = refined.regions.size();
    std::vector<SeenMotion> own(count, {{5, 5}, {5, 5, 5}});
    std::vector<int32_t> trust(count, 5);
    std::vector<motion::MotionBelief> beliefs(count, {{5, 5}, 5});
    std::vector<MotionPrior> priors(count, {{5, 5}, 5});
    gpu::motion::fitAlone(refined.view(), planes.there(),
                          {own.data(), trust.data(), beliefs.data(), priors.data()}, nullptr);
    for (size_t i = 0; i < count; ++i) {
      const RefinedRegion& region = refined.regions[i];
      SeenMotion expected;
      if (region.isFound != 0) {
        const OwnFit fit = fitAlone(picture, planes, refined, i);
        ASSERT_EQ(numbersOf(refined.states[i].own), numbersOf(fit.fit)) << i;
        ASSERT_EQ(refined.states[i].isSmooth != 0, fit.isSmooth) << i;
        expected = motion::seenMotion(fit.fit, region.reliability);
        moved += fit.fit.at != region.at;
        smooth += fit.isSmooth;
      }
      ASSERT_EQ(own[i].at, expected.at) << i;
      ASSERT_EQ(numbersOf(own[i].information), numbersOf(expected.information)) << i;
      ASSERT_EQ(trust[i], motion::ownTrustOf(expected)) << i;
      ASSERT_EQ(std::tuple(beliefs[i].at, beliefs[i].trust), std::tuple(expected.at, trust[i]));
      ASSERT_EQ(std::tuple(priors[i].at, priors[i].weight), std::tuple(Point{}, int64_t{0})) << i;
    }
  });
  EXPECT_GT(moved, 0);
  EXPECT_GT(smooth, 0);
}

/// A region with more neighbours than count, one with none, others with a few.
void parity_findConsensus() {
  for (const int count : {1, 2, 9, 60}) {
    graph::Graph graph;
    std::vector<SeenMotion> own;
    for (int i = 0; i < count; ++i) {
      graph::Region region;
      const auto level = [&](uint32_t what) { return static_cast<uint8_t>(hashOf(i, 2, what)); };
      region.colour = {level(1), level(2), level(3)};
      graph.regions.push_back(region);
      // Up to as many bits as there may be, whose products are too wide.
      const int known = i % 3 == 0 ? 0 : 1 << (i % 30);
      // Equal ones: the first of them counts.
      own.push_back({{draw(i / 4, 3, 1, 900), draw(i / 4, 3, 2, 900)},
                     {known, draw(i, 3, 4, 1 + known / 4), known / 2}});
      for (int k = 0; k < i && i < count - 1; ++k)
        if (k == 0 || hashOf(i, k, 5) % 6 == 0)
          graph.arcs.push_back({segmentation::RegionLabel::ofIndex(static_cast<size_t>(k)),
                                segmentation::RegionLabel::ofIndex(static_cast<size_t>(i)),
                                1 + hashOf(i, k, 6) % 90, hashOf(i, k, 7) % 3000});
    }
    motion::MotionConsensus consensus;
    const auto expected = consensus.run(graph, own, oneThread());

    motion::MotionNeighbours neighbours;
    neighbours.find(graph);
    std::vector<int32_t> trust;
    std::vector<motion::MotionBelief> beliefs, scratch(own.size());
    for (const SeenMotion& seen : own) {
      trust.push_back(motion::ownTrustOf(seen));
      beliefs.push_back({seen.at, trust.back()});
    }
    Guarded<MotionPrior> priors(std::vector<MotionPrior>(own.size()), {{7, 7}, 7});
    gpu::motion::findConsensus(
        {neighbours.starts().data(), neighbours.counts().data(), neighbours.list().data()},
        {own.data(), trust.data(), beliefs.data(), priors.data()}, scratch.data(), count, nullptr);
    priors.expect({expected.begin(), expected.end()}, [](const auto& a, const auto& b) {
      return a.at == b.at && a.weight == b.weight;
    });
    EXPECT_EQ(expected[0].weight > 0, count > 2);
  }
}

void parity_fitTogether() {
  int theirs = 0, mine = 0;
  forRefined([&](const MovedPicture& moved, Planes& planes, Refined& refined) {
    const size_t count = refined.regions.size();
    std::vector<MotionPrior> priors(count);
    std::vector<RegionMotion> found(count), expected(count);
    for (size_t i = 0; i < count; ++i) {
      const auto n = static_cast<int>(i);
      const RefinedRegion& region = refined.regions[i];
      const OwnFit own = fitAlone(moved, planes, refined, i);
      refined.states[i].own = own.fit;
      refined.states[i].isSmooth = own.isSmooth ? 1 : 0;
      if (i % 3 != 1)
        priors[i] = {{own.fit.at.x + draw(n, 6, 1, 400), own.fit.at.y + draw(n, 6, 2, 400)},
                     1 + static_cast<int64_t>(hashOf(n, 6, 3) % 5000)};
      found[i] = expected[i] = {7, -7, 77, static_cast<uint16_t>(region.reliability)};
      if (region.isFound == 0) continue;
      MotionFit fit = own.fit;
      if (region.pixels > 0) {
        const motion::FitPlane plane = planes.here(moved, own.isSmooth);
        fit = motion::fitMotion(refined.fitted(i), plane, own.fit, priors[i], motion::kOwnSteps);
        MotionFit start;
        start.at = priors[i].at;
        const MotionFit other =
            motion::fitMotion(refined.fitted(i), plane, start, priors[i], motion::kPriorSteps);
        const bool isTheirs =
            motion::asksForFit(own.fit, priors[i]) &&
            motion::isTheirsBetter(own.fit, fit, other, priors[i], region.reliability);
        if (isTheirs) fit = other;
        ++(isTheirs ? theirs : mine);
      }
      motion::takeOver(region, fit, priors[i], expected[i]);
    }
    gpu::motion::fitTogether(refined.view(), planes.there(), priors.data(), found.data(), nullptr);
    for (size_t i = 0; i < count; ++i) ASSERT_EQ(numbersOf(found[i]), numbersOf(expected[i])) << i;
  });
  EXPECT_GT(theirs, 0);
  EXPECT_GT(mine, 0);
}

}  // namespace rg::test
