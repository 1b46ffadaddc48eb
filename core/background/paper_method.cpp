// SPDX-License-Identifier: LGPL-2.1-or-later
// Section 2.2.1 to the letter; where it leaves a step open, the reading is said beside the step.
#include "core/background/mask_cleaning.hpp"
#include "core/background/method.hpp"
#include "core/background/models/frame_difference.hpp"
#include "core/background/models/gaussian_background.hpp"
#include "core/background/shadows/shadow.hpp"
#include "core/base/components.hpp"
#include "core/base/histogram.hpp"

#include <algorithm>
#include <numeric>

namespace rg::background {
namespace {

constexpr int kUsualThreshold = 40;  ///< "Pre-determined" in the paper, without a figure.
constexpr int kLeastEdge = 12;       ///< Grey levels below which a frame difference is noise.

class PaperMethod final : public MethodModel {
 public:
  void prepare(const Picture& picture) override;
  void segment(const MethodJob& job, Foreground& out) override;
  void breakOff() override { previous_.reset(); }

 private:
  void learnFirst(const MethodJob& job);
  void fillAreas(const MethodJob& job);
  void validate(const MethodJob& job, ImageView<uint8_t> mask);

  GaussianBackground model_;
  std::shared_ptr<const Picture> previous_;
  bool isTrained_ = false;
  FrameCount frame_;  ///< Since the model was begun.
  std::array<Image<uint8_t>, 3> mean_;
  Image<uint8_t> simple_, gaussian_, common_, edges_, filled_;
  BitMask found_, shadow_;
  Components areas_;
  CleaningScratch scratch_;
  std::vector<uint32_t> order_;
};

void PaperMethod::prepare(const Picture& picture) {
  const Size size = picture.size();
  for (Image<uint8_t>* image : {&simple_, &gaussian_, &common_, &edges_, &filled_})
    image->resize(size);
  shadow_.resize(size);
  if (model_.channels == 0) startTraining(picture, model_);
}

void PaperMethod::learnFirst(const MethodJob& job) {
  train(*job.picture, job.executor, model_);
  if (model_.trainedFrames < std::clamp(job.params.trainingFrames, 1, 65535)) return;
  finishTraining(job.executor, model_);
  isTrained_ = true;
}

/// Edges by frame difference, filled by line segmentation, inside the box of each area. Boxes may
/// overlap; the largest come first, and no more is looked at than four times the frame.
void PaperMethod::fillAreas(const MethodJob& job) {
  filled_.fill(0);
  if (!previous_) return;
  differ(*job.picture, *previous_, job.executor, edges_);
  const int threshold = differenceThreshold(countLevels(edges_, job.executor), kLeastEdge);
  job.executor.forRows(edges_.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int x = 0; x < edges_.width(); ++x)
        edges_.row(y)[x] = edges_.row(y)[x] > threshold ? 255 : 0;
  });
  findComponents(common_, 255, Connectivity::Eight, areas_);
  order_.resize(areas_.list.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) {
    const int64_t areaA = areas_.list[a].box.area(), areaB = areas_.list[b].box.area();
    return areaA != areaB ? areaA > areaB : a < b;
  });
  int64_t budget = 4 * edges_.size().area();
  for (const uint32_t i : order_) {
    const Box& box = areas_.list[i].box;
    budget -= box.area();
    if (budget < 0) break;
    fillLines(edges_, box, scratch_, filled_);
  }
}

/// F = (Fc ∨ (fill ∧ (Fs ∨ Fg))) without shadow.
void PaperMethod::validate(const MethodJob& job, ImageView<uint8_t> mask) {
  const int width = mask.width();
  job.executor.forRows(mask.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const uint8_t *common = common_.row(y), *filled = filled_.row(y);
      const uint8_t *simple = simple_.row(y), *gaussian = gaussian_.row(y);
      uint8_t* out = mask.row(y);
      for (int x = 0; x < width; ++x)
        out[x] = static_cast<uint8_t>(common[x] | (filled[x] & (simple[x] | gaussian[x])));
    }
  });
  if (!job.params.findsShadows) return;
  paintMean(model_, job.executor, mean_);
  const ColourPlanes background = model_.channels == 1 ? ColourPlanes{mean_[0], mean_[0], mean_[0]}
                                                       : ColourPlanes{mean_[1], mean_[0], mean_[2]};
  const ColourPlanes picture{job.picture->red(), job.picture->green(), job.picture->blue()};
  packEqual(mask, kForegroundPixel, found_);
  findShadows(picture, background, found_, job.executor, shadow_);
  paint(shadow_, kShadowPixel, mask);
}

void PaperMethod::segment(const MethodJob& job, Foreground& out) {
  out.extent = boundsOf(job.picture->size());
  if (!isTrained_) {
    out.status = Status::Training;
    out.mask.fill(kBackgroundPixel);
    learnFirst(job);
    previous_ = job.picture;
    return;
  }
  const int threshold = job.params.threshold > 0 ? job.params.threshold : kUsualThreshold;
  testGaussian(*job.picture, model_, threshold, job.executor, simple_, gaussian_);
  job.executor.forRows(common_.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int x = 0; x < common_.width(); ++x)
        common_.row(y)[x] = simple_.row(y)[x] & gaussian_.row(y)[x];
  });
  fillAreas(job);
  validate(job, out.mask);
  // Foreground is learnt too, slowly, so that what has stopped becomes background in the end.
  const UpdateRates rates{updateRate(job.clock.frames(job.params.learningTimeS)),
                          updateRate(job.clock.frames(job.params.absorbTimeS)), frame_.value()};
  updateGaussian(*job.picture, out.mask, rates, job.executor, model_);
  ++frame_;
  previous_ = job.picture;
}

}  // namespace

std::unique_ptr<MethodModel> makePaperMethod() {
  return std::make_unique<PaperMethod>();
}

}  // namespace rg::background
