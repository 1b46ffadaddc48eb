// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/dispatcher.hpp"
#include "kernels/bit_mask.hpp"
#include "kernels/cast_shadows.hpp"
#include "kernels/displaced_things.hpp"
#include "kernels/exposure.hpp"
#include "kernels/ghosts.hpp"
#include "kernels/histogram.hpp"
#include "kernels/light_switch.hpp"
#include "kernels/mask_cleaning.hpp"
#include "kernels/mask_contour.hpp"
#include "kernels/mask_gaps.hpp"
#include "kernels/scene_watch.hpp"
#include "kernels/shadow.hpp"
#include "kernels/swaying_parts.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace rg::gpu::background {
namespace {

using rg::background::BorderEvidence, rg::background::BorderLayer;
using rg::background::ConsensusBackground, rg::background::ConsensusRate;
using rg::background::ContourSums, rg::background::FaintEvidence, rg::background::GainSums;
using rg::background::JudgedPicture, rg::background::LevelMap, rg::background::LevelMaps;
using rg::background::LitPoints, rg::background::ShiftedSums, rg::background::ShownModel;
using rg::background::SmoothPicture, rg::background::StillPixels, rg::background::Tolerance;
using rg::background::Verdicts, rg::background::VividPoints;
using Cpu = rg::background::Operations;

class GpuOperations final : public Cpu, private Dispatcher {
 public:
  GpuOperations(GpuDevice& device, const Executor& executor) : Cpu(executor), Dispatcher(device) {}
  void smooth(const Picture& picture, SmoothPicture& out) override {
    run(
        [&] {
          const Planes from = on().read(picture);
          background::smooth(from, on().write(out, from.size(), from.channels), stream());
        },
        [&] { Cpu::smooth(picture, out); }, Writes{out});
  }
  void smoothAndJudge(const Picture& picture, const ConsensusBackground& model,
                      const Tolerance& tolerance, const JudgedPicture& out) override {
    run(
        [&] {
          const Planes from = on().read(picture);
          background::smoothAndJudge(from, on().read(model), tolerance,
                                     {on().write(out.picture, from.size(), from.channels),
                                      on().write(out.verdicts, from.size())},
                                     stream());
        },
        [&] { Cpu::smoothAndJudge(picture, model, tolerance, out); }, Reads{model},
        Writes{out.picture}, Writes{out.verdicts});
  }
  void judge(const SmoothPicture& picture, const ConsensusBackground& model,
             const Tolerance& tolerance, Verdicts& out) override {
    run(
        [&] {
          background::judge(on().read(picture), on().read(model), tolerance,
                            on().write(out, picture.size()), stream());
        },
        [&] { Cpu::judge(picture, model, tolerance, out); }, Reads{picture}, Reads{model},
        Writes{out});
  }
  void fillFrom(const SmoothPicture& picture, ConsensusBackground& model) override {
    model.channels = picture.channels;
    run([&] { background::fillFrom(on().read(picture), on().write(model), stream()); },
        [&] { Cpu::fillFrom(picture, model); }, Reads{picture}, Writes{model});
  }
  void learn(const SmoothPicture& picture, const rg::background::LearntFrame& seen,
             const ConsensusRate& rate, ConsensusBackground& model) override {
    run(
        [&] {
          const LearntFrame masks{on().read(seen.foreground), on().read(seen.near),
                                  on().read(seen.raw), on().read(seen.previousNear),
                                  on().read(seen.previousRaw)};
          background::learn(on().read(picture), masks, rate, on().change(model), stream());
        },
        [&] { Cpu::learn(picture, seen, rate, model); }, Reads{picture}, Reads{seen.foreground},
        Reads{seen.near}, Reads{seen.raw}, Reads{seen.previousNear}, Reads{seen.previousRaw},
        Changes{model});
  }
  void replaceWhere(const BitMask& places, const SmoothPicture& picture,
                    ConsensusBackground& model) override {
    run(
        [&] {
          background::replaceWhere(on().read(places), on().read(picture), on().change(model),
                                   stream());
        },
        [&] { Cpu::replaceWhere(places, picture, model); }, Reads{places}, Reads{picture},
        Changes{model});
  }
  void paintModel(const ConsensusBackground& model, ShownModel& out) override {
    run(
        [&] {
          background::paintModel(on().read(model),
                                 on().write(out, model.noise.size(), model.channels), stream());
        },
        [&] { Cpu::paintModel(model, out); }, Reads{model}, Writes{out});
  }
  void paintModelAt(const BitMask& places, const ConsensusBackground& model,
                    ShownModel& out) override {
    run(
        [&] {
          background::paintModelAt(on().read(places), on().read(model),
                                   on().write(out, places.size(), model.channels), stream());
        },
        [&] { Cpu::paintModelAt(places, model, out); }, Reads{places}, Reads{model}, Writes{out});
  }

  uint32_t countSet(const BitMask& mask) override {
    return ask<uint32_t>(
        [&](uint32_t* count) { rg::gpu::countSet(on().read(mask), count, stream()); },
        [&] { return Cpu::countSet(mask); }, Reads{mask});
  }
  bool isDarkerThan(const SmoothPicture& picture, int level) override {
    return isDark(ask<LitPoints>(
        [&](LitPoints* points) { countLit(on().read(picture), level, points, stream()); },
        [&] { return rg::background::countLit(picture, level); }, Reads{picture}));
  }
  bool isEverywhere(const BitMask& mask) override {
    return rg::background::isEverywhere(
        ask<int>([&](int* full) { countFullFields(on().read(mask), full, stream()); },
                 [&] { return rg::background::countFullFields(mask); }, Reads{mask}));
  }
  bool hasSwitchedColour(const SmoothPicture& picture, const ConsensusBackground& model) override {
    if (picture.channels == 1) return false;
    return rg::background::hasSwitchedColour(ask<VividPoints>(
        [&](VividPoints* points) {
          countVivid(on().read(picture), on().read(model), points, stream());
        },
        [&] { return rg::background::countVivid(picture, model); }, Reads{picture}, Reads{model}));
  }
  rg::background::Shift findShift(const SmoothPicture& picture, const ConsensusBackground& model,
                                  Point centre) override {
    const auto onDevice = [&](ShiftedSums* sums) {
      sumShifted(on().read(picture), on().read(model), centre, sums, stream());
    };
    const auto onCpu = [&] { return rg::background::sumShifted(picture, model, centre); };
    return bestShift(ask<ShiftedSums>(onDevice, onCpu, Reads{picture}, Reads{model}), centre);
  }
  void shiftPicture(Point shift, SmoothPicture& spare, SmoothPicture& picture) override {
    run(
        [&] {
          const Planes from = on().read(picture);
          background::shiftPicture(shift, from, on().write(spare, from.size(), from.channels),
                                   stream());
          std::swap(spare, picture);
        },
        [&] { Cpu::shiftPicture(shift, spare, picture); }, Writes{spare}, Changes{picture});
  }
  Histogram countLevels(const Image<uint8_t>& plane) override {
    return ask<Histogram>(
        [&](Histogram* levels) {
          rg::gpu::countLevels(plane.readOn(device()), levels->data(), stream());
        },
        [&] { return Cpu::countLevels(plane); }, Reads{plane});
  }
  LevelMaps matchLight(const ShownModel& shown, const SmoothPicture& picture) override {
    LevelMaps maps{};
    for (size_t c = 0; c < static_cast<size_t>(picture.channels); ++c)
      maps[c] = rg::background::matchLevels(countLevels(shown[c]), countLevels(picture.planes[c]));
    return maps;
  }
  uint32_t countApart(const ShownModel& shown, const SmoothPicture& picture, const LevelMaps& maps,
                      const ConsensusBackground& model, const Tolerance& tolerance) override {
    return ask<uint32_t>(
        [&](uint32_t* pixels) {
          background::countApart({on().read(shown, picture.channels), on().read(picture)}, maps,
                                 on().read(model), tolerance, pixels, stream());
        },
        [&] { return Cpu::countApart(shown, picture, maps, model, tolerance); }, Reads{shown},
        Reads{picture}, Reads{model});
  }
  void relight(const LevelMaps& maps, ConsensusBackground& model) override {
    run([&] { background::relight(maps, on().change(model), stream()); },
        [&] { Cpu::relight(maps, model); }, Changes{model});
  }
  int findGain(const SmoothPicture& picture, const ConsensusBackground& model) override {
    return medianGain(ask<GainSums>(
        [&](GainSums* sums) { sumGains(on().read(picture), on().read(model), sums, stream()); },
        [&] { return rg::background::sumGains(picture, model); }, Reads{picture}, Reads{model}));
  }
  void mapLevels(const LevelMap& map, SmoothPicture& picture) override {
    run([&] { background::mapLevels(map, on().change(picture), stream()); },
        [&] { Cpu::mapLevels(map, picture); }, Changes{picture});
  }

  void keepMajority(const BitMask& mask, int radius, int share, BitMask& out) override {
    run(
        [&] {
          background::keepMajority(on().read(mask), radius, share, on().write(out, mask.size()),
                                   stream());
        },
        [&] { Cpu::keepMajority(mask, radius, share, out); }, Reads{mask}, Writes{out});
  }
  void keepSupported(BitMask& mask, const BitMask& strong, uint32_t leastPx) override {
    run(
        [&] {
          const ComponentsView found = components(mask.size());
          const BitView support = on().read(strong);
          background::keepSupported(on().change(mask), support, leastPx, found, stream());
        },
        [&] { Cpu::keepSupported(mask, strong, leastPx); }, Changes{mask}, Reads{strong});
  }
  void dropSwaying(const SmoothPicture& picture, const ConsensusBackground& model,
                   const Tolerance& tolerance, BitMask& mask) override {
    run(
        [&] {
          const Size size = mask.size();
          const SwayView view{scratchMask(size), components(size),
                              scratch().take<rg::background::PartCount>(mostRuns(size))};
          background::dropSwaying(on().read(picture), on().read(model), tolerance, view,
                                  on().change(mask), stream());
        },
        [&] { Cpu::dropSwaying(picture, model, tolerance, mask); }, Reads{picture}, Reads{model},
        Changes{mask});
  }
  void fillHoles(BitMask& mask, uint32_t mostPx) override {
    run(
        [&] {
          background::fillHoles(on().change(mask), mostPx, components(mask.size()), stream());
        },
        [&] { Cpu::fillHoles(mask, mostPx); }, Changes{mask});
  }
  void dropSmallParts(BitMask& mask, uint32_t leastPx) override {
    run(
        [&] {
          background::dropSmallParts(on().change(mask), leastPx, components(mask.size()), stream());
        },
        [&] { Cpu::dropSmallParts(mask, leastPx); }, Changes{mask});
  }
  void fillUnedged(const SmoothPicture& picture, int mostStep, uint32_t mostPx,
                   BitMask& mask) override {
    run(
        [&] {
          const Size size = mask.size();
          const GapView view{scratchMask(size), scratchMask(size), components(size),
                             scratch().take<GapContour>(mostRuns(size))};
          rg::gpu::fillUnedged(on().read(picture).planes[0], mostStep, mostPx, view,
                               on().change(mask), stream());
        },
        [&] { Cpu::fillUnedged(picture, mostStep, mostPx, mask); }, Reads{picture.planes[0]},
        Changes{mask});
  }
  void growFaint(const FaintEvidence& evidence, BitMask& mask) override {
    run(
        [&] {
          const Size size = mask.size();
          const ContourView view{scratchMask(size), scratchMask(size), scratchMask(size)};
          background::growFaint(on().read(evidence.picture), on().read(evidence.model),
                                on().read(evidence.faint), view, on().change(mask), stream());
        },
        [&] { Cpu::growFaint(evidence, mask); }, Reads{evidence.picture}, Reads{evidence.model},
        Reads{evidence.faint}, Writes{evidence.shown}, Changes{mask});
  }
  void trimBorder(const BorderEvidence& evidence, BorderLayer layer, BitMask& mask) override {
    run(
        [&] {
          const BitTarget before = copyOf(on().read(mask));
          const BorderView view{on().read(evidence.picture), on().read(evidence.smoothed).planes[0],
                                on().read(evidence.model),
                                on().read(evidence.shown, evidence.model.channels),
                                evidence.tolerance};
          background::trimBorder(view, layer, before, on().change(mask), stream());
        },
        [&] { Cpu::trimBorder(evidence, layer, mask); }, Reads{evidence.smoothed},
        Reads{evidence.model}, Reads{evidence.shown}, Changes{mask});
  }
  void thicken(const BitMask& mask, int margin, BitMask& out) override {
    run([&] { rg::gpu::thicken(on().read(mask), margin, on().write(out, mask.size()), stream()); },
        [&] { Cpu::thicken(mask, margin, out); }, Reads{mask}, Writes{out});
  }
  void remove(const BitMask& b, BitMask& a) override {
    run([&] { rg::gpu::remove(on().read(b), on().change(a), stream()); },
        [&] { Cpu::remove(b, a); }, Reads{b}, Changes{a});
  }
  void keepOnly(const BitMask& b, BitMask& a) override {
    run([&] { rg::gpu::keepOnly(on().read(b), on().change(a), stream()); },
        [&] { Cpu::keepOnly(b, a); }, Reads{b}, Changes{a});
  }

  void followStill(const SmoothPicture& picture, const ConsensusBackground& model,
                   const Tolerance& tolerance, const BitMask& foreground, uint16_t mostAge,
                   StillPixels& still) override {
    run(
        [&] {
          const Planes from = on().read(picture);
          background::followStill(from, on().read(model), tolerance, on().read(foreground), mostAge,
                                  on().change(still, from.channels), stream());
          // The device knows no rows that it may skip: the CPU must not either.
          std::fill(still.freshRows.begin(), still.freshRows.end(), rg::background::kFreshFrames);
        },
        [&] { Cpu::followStill(picture, model, tolerance, foreground, mostAge, still); },
        Reads{picture}, Reads{model}, Reads{foreground}, Changes{still});
  }
  void findGhosts(const SmoothPicture& picture, const ConsensusBackground& model,
                  const BitMask& foreground, StillPixels& still, int leastAge,
                  BitMask& ghosts) override {
    run(
        [&] {
          const Size size = foreground.size();
          const GhostView view{scratchMask(size), components(size),
                               scratch().take<ContourSums>(mostRuns(size))};
          const Planes from = on().read(picture);
          background::findGhosts(from, on().read(model), on().read(foreground),
                                 on().change(still, from.channels), leastAge, view,
                                 on().write(ghosts, size), stream());
        },
        [&] { Cpu::findGhosts(picture, model, foreground, still, leastAge, ghosts); },
        Reads{picture}, Reads{model}, Reads{foreground}, Changes{still}, Writes{ghosts});
  }
  void addAged(const BitMask& foreground, const StillPixels& still, int64_t leastAge,
               BitMask& ghosts) override {
    run(
        [&] {
          background::addAged(on().read(foreground), on().read(still), ageOf(leastAge),
                              on().change(ghosts), stream());
        },
        [&] { Cpu::addAged(foreground, still, leastAge, ghosts); }, Reads{foreground}, Reads{still},
        Changes{ghosts});
  }
  void addDisplaced(const SmoothPicture& picture, const ConsensusBackground& model,
                    const BitMask& foreground, const StillPixels& still, int64_t leastAge,
                    BitMask& moved) override {
    run(
        [&] {
          constexpr int64_t kHistograms =
              int64_t{2} * rg::background::kMostDisplaced * rg::background::kColours;
          const DisplacedView view{components(foreground.size()),
                                   scratch().take<uint32_t>(mostRuns(foreground.size())),
                                   scratch().take<uint32_t>(kHistograms),
                                   scratch().take<uint32_t>(rg::background::kMostDisplaced)};
          background::addDisplaced(on().read(picture), on().read(model), on().read(foreground),
                                   on().read(still), ageOf(leastAge), view, on().change(moved),
                                   stream());
        },
        [&] { Cpu::addDisplaced(picture, model, foreground, still, leastAge, moved); },
        Reads{picture}, Reads{model}, Reads{foreground}, Reads{still}, Changes{moved});
  }

  void findShadows(const SmoothPicture& picture, const ShownModel& shown, const BitMask& mask,
                   BitMask& shadow) override {
    run([&] { findShadowsOnDevice(picture, shown, mask, shadow); },
        [&] { Cpu::findShadows(picture, shown, mask, shadow); }, Reads{picture}, Reads{shown},
        Reads{mask}, Writes{shadow});
  }
  void keepCastShadows(const BitMask& mask, BitMask& dark) override {
    run([&] { keepCastShadowsOnDevice(mask, dark); }, [&] { Cpu::keepCastShadows(mask, dark); },
        Reads{mask}, Changes{dark});
  }
  /// The frame waits here for the device: whoever reads the mask reads it on the host.
  void paintForeground(const BitMask& mask, const BitMask& shadow, Point shift,
                       Image<uint8_t>& out) override {
    run(
        [&] {
          background::paintForeground(on().read(mask), on().read(shadow), shift, on().write(out),
                                      stream());
        },
        [&] { Cpu::paintForeground(mask, shadow, shift, out); }, Reads{mask}, Reads{shadow},
        Writes{out});
    onHost([] {}, Changes{out});
  }

 private:
  static int ageOf(int64_t age) { return static_cast<int>(std::min<int64_t>(age, UINT16_MAX + 1)); }

  void findShadowsOnDevice(const SmoothPicture& picture, const ShownModel& shown,
                           const BitMask& mask, BitMask& shadow) {
    const auto planes = [](const Planes& from) {
      const bool isGrey = from.channels == 1;
      return rg::background::ColourPlanes{from.planes[isGrey ? 0 : 1], from.planes[0],
                                          from.planes[isGrey ? 0 : 2]};
    };
    background::findShadows(planes(on().read(picture)), planes(on().read(shown, picture.channels)),
                            on().read(mask), on().write(shadow, mask.size()), stream());
  }
  /// It drops parts twice, so it works on a copy.
  void keepCastShadowsOnDevice(const BitMask& mask, BitMask& dark) {
    const int64_t runs = mostRuns(mask.size());
    const CastShadowView view{components(mask.size()),
                              scratch().take<rg::background::DarkPart>(runs),
                              scratch().take<uint32_t>(runs)};
    const BitTarget copied = copyOf(on().read(dark));
    background::keepCastShadows(on().read(mask), copied, view, stream());
    copy(copied, on().change(dark));
  }
};

}  // namespace
}  // namespace rg::gpu::background

template <>
std::unique_ptr<rg::background::Operations> rg::gpu::operationsOn(GpuDevice& device,
                                                                  const Executor& executor) {
  return std::make_unique<background::GpuOperations>(device, executor);
}
