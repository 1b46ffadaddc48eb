// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/detection.hpp"

#include "core/detection/window_search.hpp"

#include <utility>

namespace rg::detection {
namespace {

/// What a search is made for.
struct Setup {
  std::shared_ptr<const Cascade> cascade;
  Size frame;
  double scaleFactor = 0;
  int minHeightPx = 0, maxHeightPx = 0;
  friend bool operator==(const Setup&, const Setup&) = default;
};

constexpr double kLeastScaleFactor = 1.01;

class Detector final : public Stage {
 public:
  explicit Detector(Context context) : context_(std::move(context)) {}

  Result<Detections> process(ImageView<const uint8_t> luma, std::span<const Box> areas,
                             const std::shared_ptr<const Cascade>& cascade,
                             const Params& params) override {
    if (auto prepared = prepare(
            {cascade, luma.size, params.scaleFactor, params.minHeightPx, params.maxHeightPx});
        !prepared)
      return prepared.error();
    uniteAreas(areas, luma.size, areas_);
    const auto windows = search_->find(luma, areas_, *context_.cpu);
    if (!windows) return windows.error();
    Detections detections;
    // As OpenCV counts: a window and its neighbours.
    const int least = params.minNeighbours > 0 ? params.minNeighbours + 1 : 0;
    groupWindows(*windows, least, detections.found);
    detections.isCutShort = params.minNeighbours > 0 && windows->size() > kMostGrouped;
    return detections;
  }

  void reset(Reset what) override {
    if (what != Reset::Stream) return;
    search_.reset();
    setup_ = {};
  }

 private:
  Result<bool> prepare(const Setup& setup) {
    if (search_ && setup == setup_) return true;
    if (!setup.cascade) return Error{"there is no cascade"};
    if (!(setup.scaleFactor >= kLeastScaleFactor)) return Error{"the scale factor is below 1.01"};
    search_.reset();
    ScaleParams params{setup.frame, setup.cascade->window, setup.scaleFactor};
    params.least.height = setup.minHeightPx;
    params.most.height = setup.maxHeightPx;
    auto scales = scalesOf(params);
    if (!scales) return scales.error();
    search_ = std::make_unique<WindowSearch>(setup.cascade, *std::move(scales), setup.frame);
    setup_ = setup;
    return true;
  }

  Context context_;
  Setup setup_;  ///< Of the search.
  std::unique_ptr<WindowSearch> search_;
  std::vector<Box> areas_;
};

}  // namespace

std::unique_ptr<Stage> makeStage(Context context) {
  return std::make_unique<Detector>(std::move(context));
}

}  // namespace rg::detection
