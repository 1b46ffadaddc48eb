// SPDX-License-Identifier: LGPL-2.1-or-later
// Section 2.1: frame difference with a threshold from the histogram, and feedback from frame to
// frame. Where it leaves a step open, the reading is said beside the step.
#include "core/background/cell_search.hpp"
#include "core/background/method.hpp"
#include "core/background/methods/difference_operations.hpp"
#include "core/background/scene_memory.hpp"
#include "core/background/search_areas.hpp"
#include "core/base/histogram.hpp"
#include "core/base/memory/operations_source.hpp"

#include <algorithm>
#include <tuple>

namespace rg::background {
namespace {

constexpr int kLeastThreshold = 12;  ///< Grey levels below which a difference is noise.
constexpr size_t kMostAreas = 256;   ///< More are noise; the largest stay.
constexpr int kAskedFrames = 5;      ///< Standing so long, a thing is asked whether it is one.

class DifferenceMethod final : public MethodModel {
 public:
  explicit DifferenceMethod(const Context& context)
      : on_(makeOperations<DifferenceOperations>(context)) {}
  void prepare(const Picture& picture) override;
  void segment(const MethodJob& job, Foreground& out) override;
  void breakOff() override { previous_.reset(); }

 private:
  void start(const MethodJob& job, Foreground& out);
  [[nodiscard]] ScannedRows scannedRows(const MethodJob& job) const;
  [[nodiscard]] LevelsOf levelsFor(const Params& params) const;
  [[nodiscard]] int thresholdOf(const Params& params, const Scan& scan) const;
  void search(const MethodJob& job, const DifferenceFrame& frame);
  void judgeParts(const MethodJob& job);
  void rememberAreas();

  std::unique_ptr<DifferenceOperations> on_;
  std::shared_ptr<const Picture> previous_;
  bool hasStarted_ = false;
  FrameCount frame_;
  int threshold_ = kLeastThreshold;
  Image<uint8_t> changes_;  ///< Of the scanned rows: how much each pixel changed.
  SceneMemory memory_;
  CellSearch search_;
  std::vector<SearchArea> areas_, parts_;
  std::vector<PartSums> sums_;
  std::vector<Verdict> verdicts_;  ///< Of each part.
  std::vector<uint32_t> asked_;    ///< Parts that may be ghosts, and
  std::vector<uint8_t> isGhost_;   ///< whether they are.
};

void DifferenceMethod::prepare(const Picture& picture) {
  search_.prepare(picture.size());
  memory_.prepare(picture);
}

void DifferenceMethod::start(const MethodJob& job, Foreground& out) {
  memory_.forget();
  areas_.clear();
  hasStarted_ = true;
  frame_ = {};
  threshold_ = kLeastThreshold;
  out.status = Status::Training;
  clearMask(out);
  previous_ = job.picture;
}

/// The scan: in each frame some rows are looked at in full, all of them once in searchInterval
/// frames. This is the paper's search of the whole frame for new things, dealt out evenly. The
/// threshold is global: the histogram's pixels are those of the scanned rows.
ScannedRows DifferenceMethod::scannedRows(const MethodJob& job) const {
  const int height = job.picture->size().height;
  const int step =
      std::clamp(job.params.searchInterval, 1, std::max(1, height / kLeastScannedRows));
  return {static_cast<int>(frame_.value() % static_cast<uint32_t>(step)), step};
}

LevelsOf DifferenceMethod::levelsFor(const Params& params) const {
  if (params.threshold > 0) return LevelsOf::Nothing;
  if (params.thresholdFrom == ThresholdSource::Frame) return LevelsOf::Frame;
  return previous_ ? LevelsOf::Changes : LevelsOf::Nothing;
}

int DifferenceMethod::thresholdOf(const Params& params, const Scan& scan) const {
  switch (levelsFor(params)) {
    case LevelsOf::Frame:
      return contrastThreshold(scan.levels, kLeastThreshold);
    case LevelsOf::Changes:
      return differenceThreshold(scan.levels, kLeastThreshold);
    case LevelsOf::Nothing:
      break;
  }
  return params.threshold > 0 ? params.threshold : threshold_;
}

void DifferenceMethod::search(const MethodJob& job, const DifferenceFrame& frame) {
  search_.begin();
  for (const SearchArea& area : areas_) search_.addArea(searchBox(area));
  // The scene may have been seen long ago, in a slightly other light.
  on_->search(frame, memory_, {job.params.search, threshold_, std::min(255, 2 * threshold_)},
              changes_, search_);
}

/// What the parts are. Things hold a seed and are large enough. What stands still belongs to the
/// scene when it has done so for the absorb-time, when it did not come from elsewhere (a lamp was
/// lit), or when it is only the place that a thing has left.
void DifferenceMethod::judgeParts(const MethodJob& job) {
  const Size frame = job.picture->size();
  followAreas(search_, areas_, frame, sums_, parts_);
  const int64_t absorbFrames = job.clock.frames(job.params.absorbTimeS);
  verdicts_.resize(parts_.size());
  asked_.clear();
  for (uint32_t i = 0; i < parts_.size(); ++i) {
    const SearchArea& part = parts_[i];
    const bool isAsked = part.stillFrames > 0 && part.stillFrames % kAskedFrames == 0;
    verdicts_[i] = Verdict::Thing;
    if (!search_.hasSeed(i) || part.foundPx < leastThingPx(frame))
      verdicts_[i] = Verdict::Noise;
    else if (part.stillFrames >= absorbFrames || (isAsked && !part.hasTravelled))
      verdicts_[i] = Verdict::Scene;
    else if (isAsked)
      asked_.push_back(i);
  }
  if (asked_.empty()) return;
  on_->findGhosts(*job.picture, memory_, search_, asked_, isGhost_);
  for (size_t i = 0; i < asked_.size(); ++i)
    if (isGhost_[i] != 0) verdicts_[asked_[i]] = Verdict::Scene;
}

/// Things of one frame are looked for in the next: all of them, unless there are so many that most
/// are noise; then the largest.
void DifferenceMethod::rememberAreas() {
  areas_.clear();
  for (size_t i = 0; i < parts_.size(); ++i)
    if (verdicts_[i] == Verdict::Thing) areas_.push_back(parts_[i]);
  if (areas_.size() <= kMostAreas) return;
  const auto isLarger = [](const SearchArea& a, const SearchArea& b) {
    return std::tuple(b.foundPx, a.box.y, a.box.x) < std::tuple(a.foundPx, b.box.y, b.box.x);
  };
  std::nth_element(areas_.begin(), areas_.begin() + kMostAreas, areas_.end(), isLarger);
  areas_.resize(kMostAreas);
  std::sort(areas_.begin(), areas_.end(), isLarger);
}

void DifferenceMethod::segment(const MethodJob& job, Foreground& out) {
  if (!hasStarted_) return start(job, out);
  ++frame_;
  const DifferenceFrame frame{*job.picture, previous_.get(), scannedRows(job)};
  const Scan scan = on_->scan(frame, memory_, levelsFor(job.params), threshold_, changes_);
  out.scene.event = scan.scene.event();
  if (out.scene.event != SceneEvent::None) return start(job, out);
  threshold_ = thresholdOf(job.params, scan);
  search(job, frame);
  judgeParts(job);
  const JudgedParts parts{search_, verdicts_};
  on_->paint(parts, out);
  on_->learn(frame, parts, memory_);
  rememberAreas();
  previous_ = job.picture;
}

}  // namespace

std::unique_ptr<MethodModel> makeDifferenceMethod(const Context& context) {
  return std::make_unique<DifferenceMethod>(context);
}

}  // namespace rg::background
