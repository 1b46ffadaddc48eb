// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/methods/difference_operations.hpp"

#include "core/background/changed_pixels.hpp"
#include "kernels/backend/dispatcher.hpp"
#include "kernels/bit_mask.hpp"
#include "kernels/changed_pixels.hpp"
#include "kernels/histogram.hpp"
#include "kernels/mask_cleaning.hpp"
#include "kernels/runtime.hpp"
#include "kernels/scene_memory.hpp"
#include "kernels/shadow.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace rg::gpu::background {
namespace {

using rg::background::CellCounts;
using rg::background::CellSearch;
using rg::background::DifferenceFrame;
using rg::background::Foreground;
using rg::background::JudgedParts;
using rg::background::LevelsOf;
using rg::background::OutlineSums;
using rg::background::Scan;
using rg::background::ScannedRows;
using rg::background::SceneMemory;
using rg::background::SearchPlan;
using rg::background::Verdict;
using Cpu = rg::background::DifferenceOperations;

/// Everything is looked at everywhere: what the search by areas saves, a device does not miss.
class DifferenceOnDevice final : public Cpu, private Dispatcher {
 public:
  DifferenceOnDevice(GpuDevice& device, const Executor& executor)
      : Cpu(executor), Dispatcher(device) {}

  Scan scan(const DifferenceFrame& frame, const SceneMemory& memory, LevelsOf levels, int threshold,
            Image<uint8_t>& changes) override {
    return ask<Scan>(
        [&](Scan* to) {
          scanOnDevice(frame, memory, {levels, threshold}, changes, to);
        },
        [&] { return Cpu::scan(frame, memory, levels, threshold, changes); }, Reads{memory},
        Writes{changes});
  }
  void search(const DifferenceFrame& frame, const SceneMemory& memory, const SearchPlan& plan,
              const Image<uint8_t>& changes, CellSearch& search) override {
    run(
        [&] {
          searchOnDevice(frame, memory, plan, search);
          search.take(cells_);
        },
        [&] { Cpu::search(frame, memory, plan, changes, search); }, Reads{memory}, Reads{changes},
        Changes{search});
  }
  void findGhosts(const Picture& now, const SceneMemory& memory, const CellSearch& search,
                  std::span<const uint32_t> parts, std::vector<uint8_t>& isGhost) override {
    run([&] { findGhostsOnDevice(now, memory, search, parts, isGhost); },
        [&] { Cpu::findGhosts(now, memory, search, parts, isGhost); }, Reads{memory},
        Reads{search});
  }
  /// The frame waits here for the device: whoever reads the mask reads it on the host.
  void paint(const JudgedParts& parts, Foreground& out) override {
    const Box extent = extentOfThings(parts, out.size);
    if (extent.isEmpty()) return clearMask(out);
    const auto onCpu = [&] {
      // What of it the device has written is not known.
      out.mask.fill(rg::background::kBackgroundPixel);
      Cpu::paint(parts, out);
    };
    run([&] { paintOnDevice(parts, out.mask); }, onCpu, Reads{parts.search}, Writes{out.mask});
    onHost([] {}, Changes{out.mask});
    out.extent = extent;
  }
  void learn(const DifferenceFrame& frame, const JudgedParts& parts, SceneMemory& memory) override {
    run(
        [&] {
          const Planes now = on().read(frame.now);
          const ImageView<const uint8_t> cells = marked(parts).readOn(device());
          learnScene(now, frame.scanned, cells, change(memory), stream());
        },
        [&] { Cpu::learn(frame, parts, memory); }, Changes{memory});
  }

 private:
  struct WantedLevels {
    LevelsOf of;
    int threshold;
  };

  [[nodiscard]] static Planes thinned(Planes planes, const ScannedRows& rows) {
    for (int c = 0; c < planes.channels; ++c) planes.planes[c] = thinned(planes.planes[c], rows);
    return planes;
  }
  [[nodiscard]] static ImageView<const uint8_t> thinned(ImageView<const uint8_t> plane,
                                                        const ScannedRows& rows) {
    return rg::background::everyRow(plane, rows.first, rows.step);
  }
  [[nodiscard]] Planes sceneOf(const SceneMemory& memory) const {
    return on().read(memory.images().seen, memory.images().channels);
  }
  [[nodiscard]] MemoryView change(SceneMemory& memory) const {
    MemoryView view{{{}, memory.images().channels}, memory.images().known.changeOn(device())};
    for (int c = 0; c < view.seen.channels; ++c)
      view.seen.planes[c] = memory.images().seen[static_cast<size_t>(c)].changeOn(device());
    return view;
  }

  void scanOnDevice(const DifferenceFrame& frame, const SceneMemory& memory,
                    const WantedLevels& wanted, Image<uint8_t>& changes, Scan* to) {
    const Planes now = thinned(on().read(frame.now), frame.scanned);
    changes.resize(now.size());
    const ImageView<uint8_t> out = on().write(changes);
    if (frame.before != nullptr)
      measureChange(now, thinned(on().read(*frame.before), frame.scanned), out, stream());
    else
      clear(out);
    runtime::clear(to, sizeof *to, stream());
    const ImageView<const uint8_t> seen = sceneOf(memory).planes[0],
                                   known = memory.images().known.readOn(device());
    countScene(now.planes[0], thinned(seen, frame.scanned), thinned(known, frame.scanned),
               wanted.threshold, &to->scene, stream());
    if (wanted.of == LevelsOf::Nothing) return;
    rg::gpu::countLevels(
        wanted.of == LevelsOf::Frame ? now.planes[0] : rg::background::countedRows(out),
        to->levels.data(), stream());
  }

  /// Leaves in cells_ what it counts.
  void searchOnDevice(const DifferenceFrame& frame, const SceneMemory& memory,
                      const SearchPlan& plan, CellSearch& search) {
    const SearchedFrame searched{on().read(frame.now),
                                 frame.before != nullptr ? on().read(*frame.before) : Planes{},
                                 sceneOf(memory),
                                 memory.images().known.readOn(device()),
                                 std::as_const(search).seeds().readOn(device()),
                                 plan.threshold,
                                 plan.sceneThreshold,
                                 frame.scanned};
    auto* cells = scratch().take<CellCounts>(search.grid().area());
    searchCells(searched, search.pixels().changeOn(device()), cells, stream());
    fetchLists(FetchedList<CellCounts>{cells, static_cast<uint32_t>(search.grid().area()), cells_});
  }

  void findGhostsOnDevice(const Picture& now, const SceneMemory& memory, const CellSearch& search,
                          std::span<const uint32_t> parts, std::vector<uint8_t>& isGhost) {
    listCells(search, parts);
    const auto count = static_cast<int>(parts.size());
    const OutlineCells cells{sent(outline_), static_cast<int>(outline_.size()), count};
    const rg::background::OutlinePlanes planes{coloursOf(on().read(now)),
                                               coloursOf(sceneOf(memory)),
                                               memory.images().known.readOn(device())};
    auto* sums = scratch().take<OutlineSums>(count);
    sumOutlines(cells, search.pixels().readOn(device()), planes, sums, stream());
    fetchLists(FetchedList<OutlineSums>{sums, static_cast<uint32_t>(count), outlines_});
    isGhost.clear();
    for (const OutlineSums& outline : outlines_) isGhost.push_back(outline.isGhost());
  }
  void listCells(const CellSearch& search, std::span<const uint32_t> parts) {
    outline_.clear();
    for (const ComponentRun& run : search.parts().runs) {
      const auto part = std::find(parts.begin(), parts.end(), run.component);
      if (part == parts.end()) continue;
      for (int x = run.begin; x < run.end; ++x)
        outline_.push_back({static_cast<uint16_t>(x), static_cast<uint16_t>(run.y),
                            static_cast<uint32_t>(part - parts.begin())});
    }
  }

  void paintOnDevice(const JudgedParts& parts, Image<uint8_t>& mask) {
    const Size size = mask.size();
    const BitTarget bits = scratchMask(size);
    const ComponentsView found = components(size);
    keepDenseInCells(parts.search.pixels().readOn(device()), marked(parts).readOn(device()), bits,
                     stream());
    fillHoles(bits, rg::background::mostHolePx(size), found, stream());
    dropSmallParts(bits, rg::background::leastThingPx(size), found, stream());
    const ImageView<uint8_t> out = on().write(mask);
    clear(out);
    rg::gpu::paint(bits, rg::background::kForegroundPixel, out, stream());
  }

  std::vector<CellCounts> cells_;
  std::vector<OutlineCell> outline_;
  std::vector<OutlineSums> outlines_;
};

}  // namespace
}  // namespace rg::gpu::background

template <>
std::unique_ptr<rg::background::DifferenceOperations> rg::gpu::operationsOn(
    GpuDevice& device, const Executor& executor) {
  return std::make_unique<background::DifferenceOnDevice>(device, executor);
}
