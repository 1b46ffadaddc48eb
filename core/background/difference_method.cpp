// SPDX-License-Identifier: LGPL-2.1-or-later
// Section 2.1: frame difference with a threshold from the histogram, and feedback from frame to
// frame. Where it leaves a step open, the reading is said beside the step.
#include "core/background/cell_search.hpp"
#include "core/background/ghosts/outline_ghosts.hpp"
#include "core/background/mask_cleaning.hpp"
#include "core/background/method.hpp"
#include "core/background/scene_memory.hpp"
#include "core/background/search_areas.hpp"
#include "core/base/histogram.hpp"

#include <algorithm>
#include <tuple>

namespace rg::background {
namespace {

constexpr int kLeastThreshold = 12;    ///< Grey levels below which a difference is noise.
constexpr int kLeastScannedRows = 16;  ///< In every frame: fewer make no histogram.
constexpr size_t kMostAreas = 256;     ///< More are noise; the largest stay.
constexpr int kAskedFrames = 5;        ///< Standing so long, a thing is asked whether it is one.
constexpr uint64_t kOtherScene = 154;  ///< Of 256: share of the known scene that no object covers.
constexpr uint64_t kOneDirection = 230;  ///< Of 256: so many pixels brighter, or darker: the light.

enum class Verdict : uint8_t { Noise, Scene, Thing };

uint32_t leastPx(Size frame) {
  return static_cast<uint32_t>(std::max<int64_t>(8, frame.area() / 10000));
}

void fill(ImageView<uint8_t> image, uint8_t value) {
  for (int y = 0; y < image.height(); ++y) std::fill_n(image.row(y), image.width(), value);
}

/// Writes no more than was painted the last time.
void clearMask(Foreground& out) {
  fill(out.mask.view().crop(out.extent), kBackgroundPixel);
  out.extent = {};
}

class DifferenceMethod final : public MethodModel {
 public:
  void prepare(const Picture& picture) override;
  void segment(const MethodJob& job, Foreground& out) override;
  void breakOff() override { previous_.reset(); }

 private:
  void start(const MethodJob& job, Foreground& out);
  void scan(const MethodJob& job);
  int thresholdOf(const MethodJob& job) const;
  SceneEvent compareScene(const ColourPlanes& now);
  void seed();
  void judgeParts(const MethodJob& job);
  void paint(Foreground& out);
  void learn(const ColourPlanes& now);
  void learnBox(const ColourPlanes& now, const Box& box);
  void rememberAreas();

  std::shared_ptr<const Picture> previous_;
  bool hasStarted_ = false;
  FrameCount frame_;
  int threshold_ = kLeastThreshold;
  int firstScanned_ = 0, scanStep_ = 1;
  Image<uint8_t> changes_;  ///< Of the scanned rows: how much each pixel changed.
  SceneMemory memory_;
  CellSearch search_;
  std::vector<SearchArea> areas_, parts_;
  std::vector<PartSums> sums_;
  std::vector<Verdict> verdicts_;  ///< Of each part.
  Image<uint8_t> isKept_;          ///< Cells that the memory must not take over.
  BitMask bits_;
  CleaningScratch scratch_;
};

void DifferenceMethod::prepare(const Picture& picture) {
  search_.prepare(picture.size());
  memory_.prepare(picture);
  isKept_.resize(search_.grid());
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
void DifferenceMethod::scan(const MethodJob& job) {
  const int height = job.picture->size().height;
  scanStep_ = std::clamp(job.params.searchInterval, 1, std::max(1, height / kLeastScannedRows));
  firstScanned_ = static_cast<int>(frame_.value() % static_cast<uint32_t>(scanStep_));
  const ColourPlanes now = everyRow(planesOf(*job.picture), firstScanned_, scanStep_);
  changes_.resize(now.green.size);
  if (previous_) {
    const ColourPlanes before = everyRow(planesOf(*previous_), firstScanned_, scanStep_);
    job.executor.forRows(changes_.height(), [&](int first, int last) {
      for (int y = first; y < last; ++y)
        measureChange(now, before, runOf(y, 0, changes_.width()), changes_.row(y));
    });
  } else {
    changes_.fill(0);
  }
}

int DifferenceMethod::thresholdOf(const MethodJob& job) const {
  if (job.params.threshold > 0) return job.params.threshold;
  if (job.params.thresholdFrom == ThresholdSource::Frame) {
    const ColourPlanes rows = everyRow(planesOf(*job.picture), firstScanned_, scanStep_);
    return contrastThreshold(countLevels(rows.green, job.executor), kLeastThreshold);
  }
  if (!previous_) return threshold_;
  // Every other row is enough, where there are many.
  const int step = changes_.height() < 2 * kLeastScannedRows - 2 ? 1 : 2;
  const ImageView<const uint8_t> rows{changes_.row(0),
                                      {changes_.width(), changes_.height() / step},
                                      step * changes_.view().strideBytes};
  return differenceThreshold(countLevels(rows, job.executor), kLeastThreshold);
}

/// Is most of the scene that is known no longer there? Then its light was switched, or the camera
/// moved or was covered.
SceneEvent DifferenceMethod::compareScene(const ColourPlanes& now) {
  uint64_t known = 0, brighter = 0, darker = 0;
  constexpr int kEvery = 16;  // A share of the columns tells it as well.
  const ColourPlanes seen = memory_.planes();
  for (int y = firstScanned_; y < now.green.height(); y += scanStep_) {
    const uint8_t *level = now.green.row(y), *before = seen.green.row(y);
    const uint8_t* isKnown = memory_.known().row(y);
    uint32_t knownHere = 0, brighterHere = 0, darkerHere = 0;
    for (int x = 0; x < now.green.width(); x += kEvery) {
      const int bit = isKnown[x] & 1;
      knownHere += static_cast<uint32_t>(bit);
      brighterHere += static_cast<uint32_t>(bit & int{level[x] > before[x] + threshold_});
      darkerHere += static_cast<uint32_t>(bit & int{before[x] > level[x] + threshold_});
    }
    known += knownHere;
    brighter += brighterHere;
    darker += darkerHere;
  }
  const uint64_t changed = brighter + darker;
  if (changed * 256 <= known * kOtherScene) return SceneEvent::None;
  return std::max(brighter, darker) * 256 >= changed * kOneDirection ? SceneEvent::LightSwitched
                                                                     : SceneEvent::CameraMoved;
}

void DifferenceMethod::seed() {
  search_.begin();
  for (const SearchArea& area : areas_) search_.addArea(searchBox(area));
  for (int row = 0; row < changes_.height(); ++row)
    search_.addHits(changes_.row(row), firstScanned_ + row * scanStep_, threshold_);
}

/// What the parts are. Things hold a seed and are large enough. What stands still belongs to the
/// scene when it has done so for the absorb-time, when it did not come from elsewhere (a lamp was
/// lit), or when it is only the place that a thing has left.
void DifferenceMethod::judgeParts(const MethodJob& job) {
  const Size frame = job.picture->size();
  followAreas(search_, areas_, frame, sums_, parts_);
  const int64_t absorbFrames = job.clock.frames(job.params.absorbTimeS);
  verdicts_.resize(parts_.size());
  for (uint32_t i = 0; i < parts_.size(); ++i) {
    const SearchArea& part = parts_[i];
    const bool isAsked = part.stillFrames > 0 && part.stillFrames % kAskedFrames == 0;
    if (!search_.hasSeed(i) || part.foundPx < leastPx(frame))
      verdicts_[i] = Verdict::Noise;
    else if (part.stillFrames >= absorbFrames ||
             (isAsked &&
              (!part.hasTravelled || isGhost(search_, i, planesOf(*job.picture), memory_))))
      verdicts_[i] = Verdict::Scene;
    else
      verdicts_[i] = Verdict::Thing;
  }
}

void DifferenceMethod::paint(Foreground& out) {
  clearMask(out);
  const Size frame = out.mask.size();
  for (const ComponentRun& run : search_.parts().runs) {
    if (verdicts_[run.component] != Verdict::Thing) continue;
    const Box box = pixelsOfCells(run, frame);
    out.extent = unite(out.extent, box);
    for (int y = box.y; y < box.bottom(); ++y)
      keepDense(search_.foundRow(y - 1), search_.foundRow(y), search_.foundRow(y + 1),
                runOf(y, box.x, box.right()), out.mask.row(y));
  }
  const ImageView<uint8_t> part = out.mask.view().crop(out.extent);
  packEqual(part, kForegroundPixel, bits_);
  fillHoles(bits_, static_cast<uint32_t>(frame.area() / 100), scratch_);
  dropSmallParts(bits_, leastPx(frame), scratch_);
  fill(part, kBackgroundPixel);
  rg::paint(bits_, kForegroundPixel, part);
}

/// The scanned rows become the scene, but for the cells of things and those around them. So do, at
/// once, the parts that belong to it.
void DifferenceMethod::learn(const ColourPlanes& now) {
  const Size frame = now.green.size;
  const Box grid = boundsOf(isKept_.size());
  isKept_.fill(0);
  for (const ComponentRun& run : search_.parts().runs) {
    const Box cells{run.begin, run.y, run.end - run.begin, 1};
    if (verdicts_[run.component] == Verdict::Scene) learnBox(now, pixelsOfCells(cells, frame));
    if (verdicts_[run.component] != Verdict::Thing) continue;
    const Box around = intersect(inflate(cells, 1), grid);
    for (int y = around.y; y < around.bottom(); ++y)
      std::fill_n(isKept_.row(y) + around.x, around.width, uint8_t{1});
  }
  for (int y = firstScanned_; y < frame.height; y += scanStep_) {
    const uint8_t* kept = isKept_.row(y / kCellPx);
    for (int x = 0; x < grid.width;) {
      const int begin = x;
      while (x < grid.width && kept[x] == 0) ++x;
      if (x > begin)
        memory_.learn(now, runOf(y, begin * kCellPx, std::min(x * kCellPx, frame.width)));
      while (x < grid.width && kept[x] != 0) ++x;
    }
  }
}

void DifferenceMethod::learnBox(const ColourPlanes& now, const Box& box) {
  for (int y = box.y; y < box.bottom(); ++y) memory_.learn(now, runOf(y, box.x, box.right()));
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
  const ColourPlanes now = planesOf(*job.picture);
  scan(job);
  out.scene.event = compareScene(now);
  if (out.scene.event != SceneEvent::None) return start(job, out);
  threshold_ = thresholdOf(job);
  seed();
  const ColourPlanes before = previous_ ? planesOf(*previous_) : ColourPlanes{};
  // The scene may have been seen long ago, in a slightly other light.
  const int sceneThreshold = std::min(255, 2 * threshold_);
  search_.run(job.params.search, {now, before, memory_, threshold_, sceneThreshold}, job.executor);
  judgeParts(job);
  paint(out);
  learn(now);
  rememberAreas();
  previous_ = job.picture;
}

}  // namespace

std::unique_ptr<MethodModel> makeDifferenceMethod() {
  return std::make_unique<DifferenceMethod>();
}

}  // namespace rg::background
