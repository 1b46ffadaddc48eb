// SPDX-License-Identifier: LGPL-2.1-or-later
// All windows of all scales, on several threads and in vectors.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/detection/cascade.hpp"
#include "core/detection/scaled_cascade.hpp"
#include "core/detection/search_windows.hpp"

#include <memory>
#include <span>
#include <vector>

namespace rg::detection {

/// A search for a cascade at scales that were chosen for a size of frames. Memory: 16 bytes a pixel
/// and what ScaledCascade says for each scale.
class WindowSearch {
 public:
  /// Scales of 1 or more, within the frame.
  WindowSearch(std::shared_ptr<const Cascade> cascade, std::vector<Scale> scales, Size frame);

  /// The windows in areas, as uniteAreas() leaves them, that pass all stages: by scale, then row,
  /// then column. They stand until the next call. Error: more windows than numbers for them.
  [[nodiscard]] Result<std::span<const Box>> find(ImageView<const uint8_t> luma,
                                                  std::span<const Box> areas,
                                                  const Executor& executor);

 private:
  struct Found {
    int scale = 0;
    Point at;
  };
  /// A row of windows of a range.
  struct Row {
    int range = 0;
    int row = 0;
  };
  /// What a thread fills by itself.
  struct Scratch {
    std::vector<uint16_t> stages;
    std::vector<Found> found;
  };
  /// A row of sums of an area.
  struct SumRow {
    int area = 0;
    int y = 0;
  };

  void sumAreas(ImageView<const uint8_t> luma, std::span<const Box> areas,
                const Executor& executor);
  void searchStep(int step, std::span<const Box> areas, const Executor& executor);
  void sortColumns(const Box& area, int y, int phases);
  void judge(const Row& row, Scratch& scratch) const;
  void judgeOneByOne(const WindowRange& range, int y, uint16_t* stages) const;
  void collect();

  std::shared_ptr<const Cascade> cascade_;
  std::vector<Scale> scales_;
  Size frame_;
  std::vector<int> steps_;  ///< Each once.
  std::vector<ScaledCascade> scaled_;
  SearchWindows windows_;
  Image<uint32_t> sums_;
  Image<double> squares_;
  Image<uint32_t> sorted_;  ///< Sums of the step that is searched.
  std::vector<Row> rows_;
  std::vector<SumRow> sumRows_;
  std::vector<Scratch> threads_;
  std::vector<Found> found_;
  std::vector<Box> boxes_;
};

}  // namespace rg::detection
