// SPDX-License-Identifier: LGPL-2.1-or-later
// Section 2.2.1 to the letter; where it leaves a step open, the reading is said beside the step.
#include "core/background/method.hpp"
#include "core/background/methods/paper_operations.hpp"
#include "core/base/memory/operations_source.hpp"

#include <algorithm>

namespace rg::background {
namespace {

constexpr int kUsualThreshold = 40;  ///< "Pre-determined" in the paper, without a figure.
constexpr int kLeastEdge = 12;       ///< Grey levels below which a frame difference is noise.

class PaperMethod final : public MethodModel {
 public:
  explicit PaperMethod(const Context& context) : on_(makeOperations<PaperOperations>(context)) {}
  void prepare(const Picture& picture) override;
  void segment(const MethodJob& job, Foreground& out) override;
  void breakOff() override { previous_.reset(); }

 private:
  void learnFirst(const MethodJob& job);
  void fillAreas(const MethodJob& job);

  std::unique_ptr<PaperOperations> on_;
  GaussianBackground model_;
  std::shared_ptr<const Picture> previous_;
  bool isTrained_ = false;
  FrameCount frame_;  ///< Since the model was begun.
  GaussianTests tests_;
  Image<uint8_t> edges_, filled_;
};

void PaperMethod::prepare(const Picture& picture) {
  const Size size = picture.size();
  for (Image<uint8_t>* image :
       {&tests_.simple, &tests_.gaussian, &tests_.common, &edges_, &filled_})
    image->resize(size);
  if (model_.channels == 0) startTraining(picture, model_);
}

void PaperMethod::learnFirst(const MethodJob& job) {
  on_->train(*job.picture, model_);
  if (model_.trainedFrames < std::clamp(job.params.trainingFrames, 1, 65535)) return;
  on_->finishTraining(model_);
  isTrained_ = true;
}

/// Edges by frame difference, filled by line segmentation, inside the box of each area.
void PaperMethod::fillAreas(const MethodJob& job) {
  if (!previous_) return filled_.fill(0);
  on_->findEdges(*job.picture, *previous_, kLeastEdge, edges_);
  on_->fillAreas(tests_.common, edges_, filled_);
}

/// F = (Fc ∨ (fill ∧ (Fs ∨ Fg))) without shadow.
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
  on_->testGaussian(*job.picture, model_, threshold, tests_);
  fillAreas(job);
  on_->joinFound(tests_, filled_, out.mask);
  if (job.params.findsShadows) on_->markShadows(*job.picture, model_, out.mask);
  // Foreground is learnt too, slowly, so that what has stopped becomes background in the end.
  const UpdateRates rates{updateRate(job.clock.frames(job.params.learningTimeS)),
                          updateRate(job.clock.frames(job.params.absorbTimeS)), frame_.value()};
  on_->updateGaussian(*job.picture, out.mask, rates, model_);
  on_->publish(out.mask);
  ++frame_;
  previous_ = job.picture;
}

}  // namespace

std::unique_ptr<MethodModel> makePaperMethod(const Context& context) {
  return std::make_unique<PaperMethod>(context);
}

}  // namespace rg::background
