// SPDX-License-Identifier: LGPL-2.1-or-later
// Method hybrid, the default: adaptive sample consensus. Each pixel remembers colours that it had
// (models/consensus_background.hpp), and decides by itself how near is near; round that lies the
// paper's structure: validation, shadows, what stands still.
#include "core/background/ghosts/displaced_things.hpp"
#include "core/background/ghosts/ghosts.hpp"
#include "core/background/ghosts/mask_contour.hpp"
#include "core/background/light_switch.hpp"
#include "core/background/mask_cleaning.hpp"
#include "core/background/method.hpp"
#include "core/background/models/consensus_background.hpp"
#include "core/background/scene_watch.hpp"
#include "core/background/shadows/cast_shadows.hpp"
#include "core/background/shadows/shadow.hpp"
#include "core/base/mask_gaps.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace rg::background {
namespace {

constexpr int kUsualThreshold = 5;  ///< Grey levels that the darkest pixel may be off.
constexpr int kBrightness = 20;     ///< Of 256: share of the brightness that is added to it.
constexpr int kMajority = 115;      ///< Of 256: share of foreground that keeps a pixel.

constexpr uint32_t kOddShare = 16;          ///< Of 256: foreground that makes us look at the scene.
constexpr uint32_t kLightShare = 102;       ///< Of 256: foreground that asks for a reason.
constexpr uint32_t kOtherSceneShare = 192;  ///< Of 256: foreground that no object covers.

constexpr int kDarkLevel = 12, kBrightLevel = 18;  ///< Grey levels: from where, and until where.

constexpr bool startsAnew(SceneEvent event) {
  return event == SceneEvent::ColourSwitched || event == SceneEvent::CameraMoved;
}

class ConsensusMethod final : public MethodModel {
 public:
  void prepare(const Picture& picture) override;
  void segment(const MethodJob& job, Foreground& out) override;
  void breakOff() override {}

 private:
  bool isFirst(const MethodJob& job) const {
    return frame_.value() < static_cast<uint32_t>(job.params.trainingFrames);
  }
  void start(const MethodJob& job, Foreground& out);
  bool isTooDark(Foreground& out);
  void watch(const MethodJob& job, uint64_t differing, Foreground& out);
  SceneEvent followCamera(const MethodJob& job);
  SceneEvent followLight(const MethodJob& job);
  bool isElsewhere(const MethodJob& job);
  void clean(const MethodJob& job);
  void refine(const MethodJob& job);
  void findShadow(const MethodJob& job);
  void dissolveGhosts(const MethodJob& job);
  void learnFrame(const MethodJob& job);
  void publish(const MethodJob& job, ImageView<uint8_t> out) const;

  SmoothPicture smooth_;
  ConsensusBackground model_;
  Verdicts verdicts_;
  BitMask previousRaw_;
  BitMask mask_;  ///< The foreground.
  StillPixels still_;
  BitMask ghosts_;
  StillScratch stillScratch_;
  DisplacedScratch moved_;
  CleaningScratch scratch_;
  GapScratch gaps_;
  ContourScratch contour_;
  std::array<Image<uint8_t>, 3> shown_;
  BitMask across_, near_;  ///< near_: the foreground and two pixels round it.
  BitMask dark_, shadow_;
  CastShadowScratch shadowScratch_;
  FrameCount frame_;
  bool isDark_ = false;
  Point shift_;                   ///< The camera's, from the model.
  SmoothPicture spare_;           ///< For shifting.
  uint32_t calmFrames_ = 0;       ///< Since the camera was off its place.
  uint32_t offFrames_ = 0;        ///< It has been off by the same shift.
  uint32_t elsewhereFrames_ = 0;  ///< The picture has differed everywhere.
};

void ConsensusMethod::prepare(const Picture& picture) {
  const Size size = picture.size();
  for (BitMask* mask : {&previousRaw_, &mask_, &ghosts_, &dark_, &shadow_}) mask->resize(size);
  background::prepare(size, picture.isGrey() ? 1 : 3, model_);
  background::prepare(size, picture.isGrey() ? 1 : 3, still_);
}

void ConsensusMethod::start(const MethodJob& job, Foreground& out) {
  fillFrom(smooth_, job.executor, model_);
  previousRaw_.clear();
  clear(still_);
  frame_ = {};
  shift_ = {};
  offFrames_ = elsewhereFrames_ = 0;
  out.status = Status::Training;
  out.mask.fill(kBackgroundPixel);
}

Tolerance toleranceOf(const Params& params) {
  return params.threshold > 0 ? Tolerance{params.threshold, 0}
                              : Tolerance{kUsualThreshold, kBrightness};
}

/// In the dark there is nothing to be told from noise, and nothing to be learnt.
bool ConsensusMethod::isTooDark(Foreground& out) {
  const bool wasDark = isDark_;
  isDark_ = isDarkerThan(smooth_, wasDark ? kBrightLevel : kDarkLevel);
  if (isDark_ != wasDark) out.scene.event = isDark_ ? SceneEvent::TooDark : SceneEvent::BrightAgain;
  out.scene.isDark = isDark_;
  if (!isDark_) return false;
  if (model_.channels == 0) out.status = Status::Training;
  out.mask.fill(kBackgroundPixel);
  return true;
}

/// A camera that was pushed sees what the model knows beside its place. The picture is put there.
SceneEvent ConsensusMethod::followCamera(const MethodJob& job) {
  const Point before = std::exchange(shift_, findShift(smooth_, model_));
  if (shift_ == Point{}) {
    offFrames_ = 0;
    ++calmFrames_;
    return SceneEvent::None;
  }
  shiftPicture(shift_, job.executor, spare_, smooth_);
  judge(smooth_, model_, toleranceOf(job.params), job.executor, verdicts_);
  offFrames_ = shift_ == before ? offFrames_ + 1 : 0;
  if (offFrames_ >= job.clock.frames(5.0)) return SceneEvent::CameraMoved;
  const bool isNews = std::exchange(calmFrames_, 0) >= job.clock.frames(1.0);
  return isNews ? SceneEvent::CameraShaken : SceneEvent::None;
}

/// No light explains it, no object covers it, and it stays.
bool ConsensusMethod::isElsewhere(const MethodJob& job) {
  elsewhereFrames_ = isEverywhere(verdicts_.raw) ? elsewhereFrames_ + 1 : 0;
  return elsewhereFrames_ >= job.clock.frames(0.3);
}

/// Much differs from the model: why?
void ConsensusMethod::watch(const MethodJob& job, uint64_t differing, Foreground& out) {
  const auto pixels = static_cast<uint64_t>(smooth_.size().area());
  SceneEvent& event = out.scene.event;
  if (differing * 256 < pixels * kOddShare) {
    shift_ = {};
    offFrames_ = elsewhereFrames_ = 0;
    ++calmFrames_;
    return;
  }
  if (isEverywhere(verdicts_.raw) && hasSwitchedColour(smooth_, model_)) {
    event = SceneEvent::ColourSwitched;
    return;
  }
  const SceneEvent pushed = followCamera(job), lit = followLight(job);
  out.scene.shift = shift_;
  if (pushed != SceneEvent::None) event = pushed;
  if (lit != SceneEvent::None) event = lit;
  if (isElsewhere(job)) event = SceneEvent::CameraMoved;
}

/// Most of the picture is foreground: is it the known scene in
/// another light, or another scene?
SceneEvent ConsensusMethod::followLight(const MethodJob& job) {
  const auto pixels = static_cast<uint64_t>(smooth_.size().area());
  const uint64_t before = countSet(verdicts_.raw);
  if (before * 256 < pixels * kLightShare) return SceneEvent::None;
  paintModel(model_, job.executor, shown_);
  const Tolerance tolerance = toleranceOf(job.params);
  const LevelMaps maps = matchLight(shown_, smooth_, job.executor);
  if (uint64_t{countApart(shown_, smooth_, maps, model_, tolerance)} * 2 < before) {
    relight(maps, job.executor, model_);
    clear(still_);
    judge(smooth_, model_, tolerance, job.executor, verdicts_);
    return SceneEvent::LightSwitched;
  }
  return before * 256 < pixels * kOtherSceneShare ? SceneEvent::None : SceneEvent::CameraMoved;
}

uint32_t leastStrongPx(uint32_t pixels) {
  return std::max(4u, pixels / 10000);
}

/// Not at the start: what is left of those who were in view must not
/// stick to those who are, and is told from them by its contour.
void ConsensusMethod::refine(const MethodJob& job) {
  const auto pixels = static_cast<uint32_t>(mask_.size().area());
  growFaint({smooth_, model_, verdicts_.faint, shown_}, job.executor, scratch_, contour_, mask_);
  keepSupported(mask_, verdicts_.strong, leastStrongPx(pixels), scratch_);
  fillHoles(mask_, pixels / 50, scratch_);
  if (shift_ != Point{}) return;  // The picture as it came is elsewhere.
  trimBorder(*job.picture, smooth_, model_, toleranceOf(job.params), job.executor, contour_, mask_);
}

void ConsensusMethod::clean(const MethodJob& job) {
  const auto pixels = static_cast<uint32_t>(mask_.size().area());
  const int radius = pixels < 40000 ? 1 : pixels < 200000 ? 2 : 3;
  keepMajority(verdicts_.raw, radius, kMajority, job.executor, scratch_, mask_);
  keepSupported(mask_, verdicts_.strong, leastStrongPx(pixels), scratch_);
  fillHoles(mask_, pixels / 50, scratch_);
  fillUnedged(smooth_.planes[0], kMostGapStep, mostGapPx(mask_.size()), job.executor, gaps_, mask_);
  if (!isFirst(job)) refine(job);
  dropSmallParts(mask_, std::max(8u, pixels / 4000), scratch_);
}

void ConsensusMethod::dissolveGhosts(const MethodJob& job) {
  const int64_t absorbFrames = job.clock.frames(job.params.absorbTimeS);
  const AgeScale scale = AgeScale::upTo(absorbFrames);
  followStill(smooth_, model_, toleranceOf(job.params), mask_, scale.mostAge(frame_.value()),
              job.executor, still_);
  const auto usual = static_cast<int>(std::clamp<int64_t>(job.clock.frames(0.4), 4, 60000));
  const int leastAge = isFirst(job) ? 4 : usual;
  findGhosts(smooth_, model_, mask_, still_, leastAge, stillScratch_, ghosts_);
  // What has not changed for so long belongs to the scene.
  const int64_t absorbAge = scale.ageOf(absorbFrames);
  forSetPixels(mask_, 0, mask_.height(), [&](int x, int y) {
    if (still_.ages.at(x, y) >= absorbAge) ghosts_.set(x, y);
  });
  if (frame_.value() % 8 == 0)
    addDisplaced(smooth_, model_, mask_, still_, job.clock.frames(3.0), moved_, ghosts_);
  replaceWhere(ghosts_, smooth_, job.executor, model_);
  remove(ghosts_, mask_);
}

void ConsensusMethod::findShadow(const MethodJob& job) {
  if (!job.params.findsShadows) return shadow_.clear();
  paintModelAt(near_, model_, job.executor, shown_);
  const auto planes = [&](const std::array<Image<uint8_t>, 3>& from) {
    const bool isGrey = model_.channels == 1;
    return ColourPlanes{from[isGrey ? 0 : 1], from[0], from[isGrey ? 0 : 2]};
  };
  findShadows(planes(smooth_.planes), planes(shown_), mask_, job.executor, dark_);
  keepMajority(dark_, 1, 128, job.executor, scratch_, shadow_);
  keepOnly(mask_, shadow_);
  keepCastShadows(mask_, shadow_, shadowScratch_);
}

void ConsensusMethod::learnFrame(const MethodJob& job) {
  const auto usual =
      std::clamp<int64_t>(job.clock.frames(job.params.learningTimeS) / kSamples, 2, 4096);
  const ConsensusRate rate{frame_.value(), isFirst(job) ? 3 : static_cast<int>(usual),
                           isFirst(job)};
  thicken(mask_, 2, job.executor, across_, near_);
  learn(smooth_, {mask_, isFirst(job) ? mask_ : near_, verdicts_.raw, previousRaw_}, rate,
        job.executor, model_);
  std::swap(verdicts_.raw, previousRaw_);
}

void ConsensusMethod::publish(const MethodJob& job, ImageView<uint8_t> out) const {
  const int width = out.width(), height = out.height();
  // Where the camera looks off the model, the mask goes back to the
  // picture.
  const int from = std::max(0, shift_.x), to = std::max(0, -shift_.x);
  const int count = std::max(0, width - std::abs(shift_.x));
  job.executor.forRows(height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      std::fill_n(out.row(y), width, kBackgroundPixel);
      const int row = y + shift_.y;
      if (row < 0 || row >= height) continue;
      paintRow(mask_, row, kForegroundPixel, out.row(y));
      paintRow(shadow_, row, kShadowPixel, out.row(y));
      if (from != to) {
        std::memmove(out.row(y) + to, out.row(y) + from, static_cast<size_t>(count));
        std::fill(out.row(y), out.row(y) + to, kBackgroundPixel);
        std::fill(out.row(y) + to + count, out.row(y) + width, kBackgroundPixel);
      }
    }
  });
}

void ConsensusMethod::segment(const MethodJob& job, Foreground& out) {
  out.extent = boundsOf(job.picture->size());
  if (model_.channels == 0) {
    smooth(*job.picture, job.executor, smooth_);
    if (!isTooDark(out)) start(job, out);
    return;
  }
  ++frame_;
  smoothAndJudge(*job.picture, model_, toleranceOf(job.params), job.executor, {smooth_, verdicts_});
  const auto pixels = static_cast<uint64_t>(smooth_.size().area());
  const uint64_t differing = countSet(verdicts_.raw);
  if ((isDark_ || differing * 256 >= pixels * kLightShare) && isTooDark(out)) return;
  watch(job, differing, out);
  if (startsAnew(out.scene.event)) return start(job, out);
  clean(job);
  dissolveGhosts(job);
  learnFrame(job);
  findShadow(job);
  publish(job, out.mask);
}

}  // namespace

std::unique_ptr<MethodModel> makeConsensusMethod() {
  return std::make_unique<ConsensusMethod>();
}

}  // namespace rg::background
