// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/background.hpp"

#include "core/background/method.hpp"
#include "core/base/components.hpp"
#include "core/base/memory/operations_source.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/renewed_stage.hpp"
#include "core/base/row_spans.hpp"

#include <optional>
#include <string>
#include <utility>

namespace rg::background {
namespace {

class BackgroundStage final : public Stage {
 public:
  explicit BackgroundStage(Context context)
      : context_(std::move(context)), operations_(makeOperations<Operations>(context_)) {}

  Result<std::shared_ptr<const Foreground>> process(std::shared_ptr<const Picture> picture,
                                                    const Params& params, FrameTime time) override;
  void reset(Reset what) override;

  /// Whether the device was lost while the model was there.
  [[nodiscard]] bool bequeath() const noexcept {
    return model_ && wasOnDevice_ && context_.device->error() != nullptr &&
           context_.device->error()->isLost();
  }
  void inherit(bool hasLostModel) noexcept { hasLostModel_ = hasLostModel; }

 private:
  MethodModel& modelOf(Method method);

  Context context_;
  std::unique_ptr<Operations> operations_;
  const bool wasOnDevice_ = context_.device && context_.device->isUp();
  bool hasLostModel_ = false;  ///< Not told yet.
  FrameClock clock_;
  Size size_;
  bool isGrey_ = false;
  bool isCameraMoving_ = false;
  std::optional<Method> method_;
  std::unique_ptr<MethodModel> model_;
  Components parts_;
  Pool<Foreground> pool_;
};

std::unique_ptr<MethodModel> makeModel(Method method, const Context& context) {
  switch (method) {
    case Method::Paper:
      return makePaperMethod(context);
    case Method::FrameDifference:
      return makeDifferenceMethod(context);
    case Method::Hybrid:
      break;
  }
  return makeConsensusMethod();
}

/// Another method starts anew: the models have nothing in common.
MethodModel& BackgroundStage::modelOf(Method method) {
  if (!model_ || method_ != method) {
    model_ = makeModel(method, context_);
    method_ = method;
  }
  return *model_;
}

Result<std::shared_ptr<const Foreground>> BackgroundStage::process(
    std::shared_ptr<const Picture> picture, const Params& params, FrameTime time) {
  if (!picture || picture->size().isEmpty()) return Error{"the picture has no pixels"};
  const Size size = picture->size();
  if (!size_.isEmpty() && (size != size_ || picture->isGrey() != isGrey_))
    return Error{"the picture's format changed from " + std::to_string(size_.width) + "x" +
                 std::to_string(size_.height) + " within a stream"};
  if (params.interest && params.interest->size() != size)
    return Error{"the mask of interest was made for another frame size"};
  if (params.camera == Camera::Moving)
    model_.reset();
  else
    modelOf(params.method).prepare(*picture);
  size_ = size;
  isGrey_ = picture->isGrey();
  clock_.tick(time);

  std::shared_ptr<Foreground> out = pool_.take();
  out->size = size;
  out->scene = {};
  out->camera = {};
  out->cameraSince.reset();
  out->status = Status::Ok;
  out->picture = picture;
  if (out->mask.size() != size) {
    out->mask.resize(size);
    out->extent = boundsOf(size);
  }
  out->mask.changeOnHost();  // Readers may have had copies of what it was.
  if (model_)
    model_->segment({std::move(picture), params, clock_, *context_.cpu, *operations_}, *out);
  else
    tellMoving(*out);

  out->interest = params.interest;
  const Box& extent = out->extent;
  const ImageView<uint8_t> mask = out->mask.view().crop(extent);
  if (out->interest) keepInside(out->interest->view().crop(extent), mask);
  const bool wasMoving = std::exchange(isCameraMoving_, out->scene.isCameraMoving);
  if (wasMoving && !isCameraMoving_) out->scene.event = SceneEvent::CameraStopped;
  if (std::exchange(hasLostModel_, false)) out->scene.event = SceneEvent::ModelLost;
  findComponents(mask, kForegroundPixel, Connectivity::Eight, parts_);
  out->areas.clear();
  for (const Component& part : parts_.list) {
    const Box& box = part.box;
    out->areas.push_back({extent.x + box.x, extent.y + box.y, box.width, box.height});
    out->scene.foregroundPx += part.areaPx;
  }
  return {std::move(out)};
}

void BackgroundStage::reset(Reset) {
  clock_.breakOff();
  if (model_) model_->breakOff();
}

}  // namespace

std::unique_ptr<Stage> makeStage(Context context) {
  return std::make_unique<RenewedStage<Stage, BackgroundStage>>(std::move(context));
}

}  // namespace rg::background
