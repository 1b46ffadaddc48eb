// SPDX-License-Identifier: LGPL-2.1-or-later
// Method frame-difference: the search in cells, the memory of the scene, outlines.
#include "core/background/changed_pixels.hpp"
#include "core/background/ghosts/outline_ghosts.hpp"
#include "core/background/methods/difference_operations.hpp"
#include "tests/kernels/masks.hpp"
#include "tests/kernels/parity.hpp"
#include "tests/kernels/pictures.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace rg::test {
namespace {

using background::CellCounts;
using background::kCellPx;
using background::OutlineSums;
using background::ScannedRows;
using background::SceneMemory;
using background::Verdict;

/// Two frames of a scene, a memory of parts of a third one, and areas that were searched.
struct SearchedScene {
  Picture now, before;
  SceneMemory memory;
  background::CellSearch search;
  std::vector<Verdict> verdicts;
  ScannedRows scanned;
  Size size;
  Image<uint8_t> areaSeeds;  ///< Of each cell, before hits were added.

  static constexpr int kThreshold = 20, kSceneThreshold = 40;

  SearchedScene(Size frame, int fill, bool isGrey, bool hasBefore)
      : scanned{frame.height > 16 ? 1 : 0, frame.height > 16 ? 3 : 1}, size(frame) {
    loadScene(size, fill, 0, isGrey, before);
    loadScene(size, fill, 1, isGrey, now);
    learnParts(fill, isGrey);
    searchFrame(hasBefore);
    for (size_t i = 0; i < search.parts().list.size(); ++i)
      verdicts.push_back(static_cast<Verdict>((i + 2) % 3));
  }

  [[nodiscard]] background::ColourPlanes planes(const Picture& picture) const {
    return background::planesOf(picture);
  }
  [[nodiscard]] background::JudgedParts parts() const { return {search, verdicts}; }

 private:
  void learnParts(int fill, bool isGrey) {
    Picture seen;
    loadScene(size, fill, 7, isGrey, seen);
    memory.prepare(seen);
    for (Image<uint8_t>& plane : memory.images().seen) plane.fill(3);
    for (int y = 0; y < size.height; ++y)
      memory.learn(planes(seen), runOf(y, y % 5 * size.width / 9, size.width - y % 3));
  }
  void searchFrame(bool hasBefore) {
    search.prepare(size);
    search.begin();
    search.addArea({size.width / 4, -3, size.width / 2 + 1, size.height});
    search.addArea({0, size.height - 5, 9, 30});
    areaSeeds.copyFrom(std::as_const(search).seeds());
    std::vector<uint8_t> changes(static_cast<size_t>(size.width));
    for (int y = scanned.first; hasBefore && y < size.height; y += scanned.step) {
      background::measureChange(planes(now), planes(before), runOf(y, 0, size.width),
                                changes.data());
      search.addHits(changes.data(), y, kThreshold);
    }
    search.run(background::SearchScope::Frame,
               {planes(now), hasBefore ? planes(before) : background::ColourPlanes{}, memory,
                kThreshold, kSceneThreshold},
               oneThread());
  }
};

template <class Check>
void forSearched(const Check& check) {
  forSizesAndFills([&](Size size, int fill) {
    for (const bool isGrey : {false, true})
      for (const bool hasBefore : {true, false}) {
        if (isGrey && !hasBefore) continue;
        SearchedScene scene(size, fill, isGrey, hasBefore);
        check(scene, hasBefore);
      }
  });
}

struct DeviceMemoryOfScene {
  DevicePlanes seen;
  Plane<uint8_t> known;
  explicit DeviceMemoryOfScene(const SceneMemory& memory)
      : seen(memory.images().seen, memory.images().channels), known(memory.known()) {}
};

Image<uint8_t> cellsOf(const SearchedScene& scene) {
  Image<uint8_t> cells;
  background::markCells(scene.parts(), cells);
  return cells;
}

}  // namespace

void parity_countScene() {
  forSearched([](const SearchedScene& scene, bool) {
    for (const int threshold : {0, 12, 255}) {
      const auto rows = [&](ImageView<const uint8_t> plane) {
        return background::everyRow(plane, scene.scanned.first, scene.scanned.step);
      };
      const auto now = rows(scene.now.green()), seen = rows(scene.memory.planes().green),
                 known = rows(scene.memory.known());
      const background::SceneCounts expected = background::countScene(now, seen, known, threshold);
      background::SceneCounts counts{7, 7, 7};
      gpu::background::countScene(Plane<uint8_t>(now), Plane<uint8_t>(seen), Plane<uint8_t>(known),
                                  threshold, &counts, nullptr);
      ASSERT_EQ(counts.known, expected.known);
      ASSERT_EQ(counts.brighter, expected.brighter);
      ASSERT_EQ(counts.darker, expected.darker);
    }
  });
}

void parity_searchCells() {
  forSearched([](const SearchedScene& scene, bool hasBefore) {
    DeviceMemoryOfScene memory(scene.memory);
    const Size grid = scene.search.grid();
    Image<uint8_t> nothing(scene.search.pixels().size());
    nothing.fill(0);
    Plane<uint8_t> pixels(std::as_const(nothing).view()), seeds(scene.areaSeeds.view());
    Guarded<CellCounts> cells(std::vector<CellCounts>(static_cast<size_t>(grid.area())), {1, 2, 3});
    gpu::background::searchCells(
        {planesOf(scene.now), hasBefore ? planesOf(scene.before) : gpu::Planes{}, memory.seen,
         memory.known, seeds, SearchedScene::kThreshold, SearchedScene::kSceneThreshold,
         scene.scanned},
        pixels, cells.data(), nullptr);
    pixels.expect(scene.search.pixels().view(), "pixels");
    for (int y = 0; y < grid.height; ++y)
      for (int x = 0; x < grid.width; ++x) {
        const CellCounts& cell = cells.data()[y * grid.width + x];
        ASSERT_EQ(cell.found, scene.search.found(x, y)) << x << ", " << y;
        ASSERT_EQ(cell.moved, scene.search.moved(x, y)) << x << ", " << y;
        const bool isSeed = scene.areaSeeds.at(x, y) != 0 || cell.hits > 0;
        ASSERT_EQ(isSeed, scene.search.seeds().at(x, y) != 0) << x << ", " << y;
      }
    cells.expect(std::vector<CellCounts>(cells.data(), cells.data() + grid.area()),
                 [](const CellCounts& a, const CellCounts& b) {
                   return a.found == b.found && a.moved == b.moved && a.hits == b.hits;
                 });
  });
}

void parity_sumOutlines() {
  forSearched([](const SearchedScene& scene, bool) {
    const auto count = static_cast<uint32_t>(scene.search.parts().list.size());
    if (count == 0) return;
    std::vector<gpu::background::OutlineCell> cells;
    for (const ComponentRun& run : scene.search.parts().runs)
      for (int x = run.begin; x < run.end; ++x)
        cells.push_back({static_cast<uint16_t>(x), static_cast<uint16_t>(run.y), run.component});
    DeviceMemoryOfScene memory(scene.memory);
    const bool isGrey = memory.seen.channels == 1;
    const background::ColourPlanes seen{memory.seen.planes[isGrey ? 0 : 1], memory.seen.planes[0],
                                        memory.seen.planes[isGrey ? 0 : 2]};
    Plane<uint8_t> pixels(scene.search.pixels().view());
    Guarded<OutlineSums> sums(std::vector<OutlineSums>(count, OutlineSums{9, 9, 9}), {1, 2, 3});
    gpu::background::sumOutlines(
        {cells.data(), static_cast<int>(cells.size()), static_cast<int>(count)}, pixels,
        {scene.planes(scene.now), seen, memory.known}, sums.data(), nullptr);
    std::vector<OutlineSums> expected;
    for (uint32_t part = 0; part < count; ++part)
      expected.push_back(
          background::sumOutline(scene.search, part, scene.planes(scene.now), scene.memory));
    sums.expect(expected, [](const OutlineSums& a, const OutlineSums& b) {
      return a.inPicture == b.inPicture && a.inScene == b.inScene && a.read == b.read;
    });
  });
}

void parity_keepDenseInCells() {
  forSearched([](const SearchedScene& scene, bool) {
    const Image<uint8_t> cells = cellsOf(scene);
    Image<uint8_t> dense(scene.size);
    dense.fill(0);
    for (int y = 0; y < scene.size.height; ++y)
      for (int x = 0; x < scene.size.width; ++x)
        if ((cells.at(x / kCellPx, y / kCellPx) & background::kThingCell) != 0)
          background::keepDense(scene.search.foundRow(y - 1), scene.search.foundRow(y),
                                scene.search.foundRow(y + 1), runOf(y, x, x + 1), dense.row(y));
    BitMask expected(scene.size);
    packEqual(dense, 255, expected);
    Bits out(scene.size);
    gpu::background::keepDenseInCells(Plane<uint8_t>(scene.search.pixels().view()),
                                      Plane<uint8_t>(cells.view()), out, nullptr);
    out.expect(expected, "dense");
  });
}

void parity_learnScene() {
  forSearched([](SearchedScene& scene, bool) {
    const Image<uint8_t> cells = cellsOf(scene);
    DeviceMemoryOfScene memory(scene.memory);
    gpu::background::learnScene(planesOf(scene.now), scene.scanned, Plane<uint8_t>(cells.view()),
                                {memory.seen, memory.known}, nullptr);
    background::DifferenceOperations cpu(oneThread());
    cpu.learn({scene.now, nullptr, scene.scanned}, scene.parts(), scene.memory);
    memory.seen.expect(scene.memory.images().seen, "seen");
    memory.known.expect(std::as_const(scene.memory).known(), "known");
  });
}

}  // namespace rg::test
