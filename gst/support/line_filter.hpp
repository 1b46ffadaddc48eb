// SPDX-License-Identifier: LGPL-2.1-or-later
// What the elements that tell results as text have in common.
#pragma once

#include "core/text/text.hpp"
#include "gst/support/stage_filter.hpp"

#include <cstdint>
#include <string>

namespace rg {

enum class LineFormat : int { JsonLines, Mot, Regions, Graph };

class LineFilter : public StageFilter {
 public:
  using StageFilter::StageFilter;

 protected:
  struct Lines {
    LineFormat format = LineFormat::JsonLines;
    bool hasContours = false;
    const text::Origin* origin = nullptr;  ///< Told in JSON; null: none.
  };

  void restartCount() { frames_ = 0; }
  /// Appends the lines of a frame, of which each format but CSV has one.
  GstFlowReturn appendLines(std::string& out, const FilterFrame& frame, const Lines& lines);

 private:
  [[nodiscard]] text::FrameStamp stampOf(const FilterFrame& frame);
  GstFlowReturn appendRegions(std::string& out, const FilterFrame& frame,
                              const text::FrameStamp& stamp);
  GstFlowReturn appendObjects(std::string& out, const FilterFrame& frame,
                              const text::FrameStamp& stamp, const Lines& lines);

  uint64_t frames_ = 0;
  const objects::Objects skipped_{};  ///< Told of a frame without a result.
};

}  // namespace rg
