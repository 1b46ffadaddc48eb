// SPDX-License-Identifier: LGPL-2.1-or-later
// What method frame-difference does with pixels, step by step: by the functions of this room, or by
// a device's counterparts of them. Which of the two did a step can't be seen in its result.
#pragma once

#include "core/background/background.hpp"
#include "core/background/cell_search.hpp"
#include "core/background/mask_cleaning.hpp"
#include "core/background/scene_memory.hpp"
#include "core/base/bit_mask.hpp"
#include "core/base/histogram.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::background {

inline constexpr int kLeastScannedRows = 16;  ///< In every frame: fewer make no histogram.

/// Rows first, first + step, … of a frame.
struct ScannedRows {
  int first = 0, step = 1;
  /// y: not above the first one.
  [[nodiscard]] constexpr bool holds(int y) const { return y >= first && (y - first) % step == 0; }
};

struct DifferenceFrame {
  const Picture& now;
  const Picture* before = nullptr;  ///< None: it follows no frame.
  ScannedRows scanned;
};

/// Of which pixels a scan counts the grey levels.
enum class LevelsOf : uint8_t {
  Nothing,
  Changes,  ///< Differences from the frame before, of every other scanned row where there are many.
  Frame,    ///< The frame itself, of the scanned rows.
};

/// Of some pixels of the scanned rows.
struct SceneCounts {
  uint32_t known = 0;                 ///< Whose scene is known; of these,
  uint32_t brighter = 0, darker = 0;  ///< those that are so by more than the threshold.

  /// Is most of the scene that is known no longer there? Then its light was switched, or the camera
  /// moved or was covered.
  [[nodiscard]] SceneEvent event() const;
};
inline constexpr int kComparedColumns = 16;  ///< Every so many columns tell it as well.

/// Of rows of the green planes and of what is known. threshold: in grey levels.
[[nodiscard]] SceneCounts countScene(ImageView<const uint8_t> now, ImageView<const uint8_t> scene,
                                     ImageView<const uint8_t> isKnown, int threshold);

struct Scan {
  SceneCounts scene;
  Histogram levels{};
};

/// Where is looked, and from which difference on, in grey levels.
struct SearchPlan {
  SearchScope scope;
  int threshold = 0;       ///< For what changed since the frame before.
  int sceneThreshold = 0;  ///< For what is not as in the memory.
};

/// What a part of the search is.
enum class Verdict : uint8_t { Noise, Scene, Thing };
struct JudgedParts {
  const CellSearch& search;
  std::span<const Verdict> verdicts;
  [[nodiscard]] bool is(const ComponentRun& run, Verdict verdict) const {
    return verdicts[run.component] == verdict;
  }
};

/// The same of cells, in bits.
inline constexpr uint8_t kThingCell = 1;  ///< Of a thing.
inline constexpr uint8_t kKeptCell = 2;   ///< Of a thing or beside one: the memory keeps it.
inline constexpr uint8_t kSceneCell = 4;  ///< Of a part that belongs to the scene.
void markCells(const JudgedParts& parts, Image<uint8_t>& cells);

/// Smaller things are noise.
[[nodiscard]] constexpr uint32_t leastThingPx(Size frame) {
  return static_cast<uint32_t>(std::max<int64_t>(8, frame.area() / 10000));
}
[[nodiscard]] constexpr uint32_t mostHolePx(Size frame) {
  return static_cast<uint32_t>(frame.area() / 100);
}

/// The rows of `changes` that LevelsOf::Changes counts.
[[nodiscard]] ImageView<const uint8_t> countedRows(ImageView<const uint8_t> changes);

/// Each does what is said of it; this class does it on the CPU.
class DifferenceOperations {
 public:
  explicit DifferenceOperations(const Executor& executor) : executor_(executor) {}
  virtual ~DifferenceOperations() = default;
  DifferenceOperations(const DifferenceOperations&) = delete;
  DifferenceOperations& operator=(const DifferenceOperations&) = delete;

  /// Writes how much each pixel of the scanned rows changed, 0 without a frame before, and counts.
  [[nodiscard]] virtual Scan scan(const DifferenceFrame& frame, const SceneMemory& memory,
                                  LevelsOf levels, int threshold, Image<uint8_t>& changes);
  /// Adds the hits of the changes to the areas of a search that has begun, and runs it.
  virtual void search(const DifferenceFrame& frame, const SceneMemory& memory,
                      const SearchPlan& plan, const Image<uint8_t>& changes, CellSearch& search);
  /// Which of these parts are ghosts (ghosts/outline_ghosts.hpp): 0 or 1, in their order.
  virtual void findGhosts(const Picture& now, const SceneMemory& memory, const CellSearch& search,
                          std::span<const uint32_t> parts, std::vector<uint8_t>& isGhost);
  /// The mask and its extent: the dense pixels of things, without holes and small parts. What is
  /// painted is within the extent of an earlier frame. Whoever reads the mask reads it on the host.
  virtual void paint(const JudgedParts& parts, Foreground& out);
  /// The scanned rows become the scene, but for the cells of things and those around them. So do,
  /// at once, the parts that belong to it.
  virtual void learn(const DifferenceFrame& frame, const JudgedParts& parts, SceneMemory& memory);

 protected:
  /// markCells(), in memory of this class.
  const Image<uint8_t>& marked(const JudgedParts& parts);

 private:
  const Executor& executor_;
  Image<uint8_t> cells_;
  BitMask bits_;
  CleaningScratch scratch_;
};

/// Writes no more than was painted the last time.
void clearMask(Foreground& out);
/// The box round all things.
[[nodiscard]] Box extentOfThings(const JudgedParts& parts, Size frame);

}  // namespace rg::background
