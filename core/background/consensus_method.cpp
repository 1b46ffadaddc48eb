// SPDX-License-Identifier: LGPL-2.1-or-later
// Method hybrid, the default: adaptive sample consensus. Each pixel remembers colours that it had
// (models/consensus_background.hpp), and decides by itself how near is near; round that lies the
// paper's structure: validation, shadows, what stands still.
#include "core/background/camera_watch.hpp"
#include "core/background/method.hpp"

#include <algorithm>
#include <utility>

namespace rg::background {
namespace {

constexpr int kUsualThreshold = 5;  ///< Grey levels that the darkest pixel may be off.
constexpr int kLeastThreshold = 2;  ///< Where the scene has little contrast.
constexpr int kBrightness = 20;     ///< Of 256: share of the brightness that is added to it.
constexpr int kLearntGain = 50;     ///< The model learns a 50th of the gain as it is.
constexpr int kMajority = 115;      ///< Of 256: share of foreground that keeps a pixel.

constexpr uint32_t kContrastFrames = 16;  ///< From one look at it to the next.

constexpr uint32_t kOddShare = 8;           ///< Of 256: foreground that makes us look at the scene.
constexpr uint32_t kLightShare = 102;       ///< Of 256: foreground that asks for a reason.
constexpr uint32_t kOtherSceneShare = 192;  ///< Of 256: foreground that no object covers.

/// Of 256: share of the difference that a shift of the camera explains, where it stood still and
/// where it sways, so that a shift is more likely than none.
constexpr uint32_t kPushedShare = 64, kSwayingShare = 32;
constexpr int kMostSteps = 4;         ///< From where it was last, three pixels each.
constexpr uint32_t kEver = 1u << 30;  ///< Frames: nobody has told of a push yet.

constexpr int kDarkLevel = 12, kBrightLevel = 18;  ///< Grey levels: from where, and until where.

constexpr bool startsAnew(SceneEvent event) {
  return event == SceneEvent::ColourSwitched || event == SceneEvent::CameraMoved;
}

class ConsensusMethod final : public MethodModel {
 public:
  void prepare(const Picture& picture) override;
  void segment(const MethodJob& job, Foreground& out) override;
  void breakOff() override { camera_.breakOff(); }

 private:
  bool isFirst(const MethodJob& job) const {
    return frame_.value() < static_cast<uint32_t>(job.params.trainingFrames);
  }
  void start(const MethodJob& job, Foreground& out);
  void followContrast(const MethodJob& job);
  [[nodiscard]] Tolerance toleranceOf(const MethodJob& job) const;
  void followExposure(const MethodJob& job, uint64_t differing);
  void learnGain(const MethodJob& job);
  bool isTooDark(const MethodJob& job, Foreground& out);
  void watch(const MethodJob& job, uint64_t differing, Foreground& out);
  [[nodiscard]] Point findShift(const MethodJob& job);
  SceneEvent followCamera(const MethodJob& job);
  SceneEvent followLight(const MethodJob& job);
  bool isElsewhere(const MethodJob& job);
  [[nodiscard]] bool cameraStarts(const MethodJob& job, uint64_t differing);
  [[nodiscard]] bool isBlind(const MethodJob& job);
  void goAlong(Foreground& out) const;
  void clean(const MethodJob& job);
  void keepWhole(const MethodJob& job);
  void findShadow(const MethodJob& job);
  void dissolveGhosts(const MethodJob& job);
  void learnFrame(const MethodJob& job);

  SmoothPicture smooth_;
  ConsensusBackground model_;
  Verdicts verdicts_;
  BitMask previousRaw_;
  BitMask mask_;  ///< The foreground.
  StillPixels still_;
  BitMask ghosts_;
  ShownModel shown_;
  BitMask around_;  ///< Where the model is painted.
  BitMask near_;    ///< The foreground and two pixels round it.
  BitMask previousNear_;
  BitMask dark_, shadow_;
  FrameCount frame_;
  int contrast_ = kFullContrast;
  int64_t litFrames_ = INT32_MAX;  ///< Since the light was switched.
  bool isDark_ = false;
  int gain_ = kSameGain;          ///< The camera's, against the model's.
  Point shift_;                   ///< The camera's, from the model.
  SmoothPicture spare_;           ///< For shifting.
  bool sways_ = false;            ///< The camera was off its place within the last second.
  uint32_t calmFrames_ = kEver;   ///< Since the camera was off its place.
  uint32_t offFrames_ = 0;        ///< It has been off by the same shift.
  uint32_t elsewhereFrames_ = 0;  ///< The picture has differed everywhere.
  CameraWatch camera_;
};

void ConsensusMethod::prepare(const Picture& picture) {
  const Size size = picture.size();
  for (BitMask* mask : {&previousRaw_, &mask_, &ghosts_, &near_, &previousNear_, &dark_, &shadow_})
    mask->resize(size);
  background::prepare(size, picture.isGrey() ? 1 : 3, model_);
  background::prepare(size, picture.isGrey() ? 1 : 3, still_);
}

void ConsensusMethod::start(const MethodJob& job, Foreground& out) {
  followContrast(job);
  job.on.fillFrom(smooth_, model_);
  previousRaw_.clear();
  near_.clear();
  clear(still_);
  frame_ = {};
  shift_ = {};
  sways_ = false;
  gain_ = kSameGain;
  offFrames_ = elsewhereFrames_ = 0;
  camera_.passOver();
  out.status = Status::Training;
  out.mask.fill(kBackgroundPixel);
}

void ConsensusMethod::followContrast(const MethodJob& job) {
  contrast_ = contrastOf(job.on.countLevels(smooth_.planes[0]));
}

/// A model that was relit is known by its histogram only, until it has learnt in the new light.
Tolerance ConsensusMethod::toleranceOf(const MethodJob& job) const {
  if (job.params.threshold > 0) return {job.params.threshold, 0};
  const int contrast = litFrames_ < job.clock.frames(2.0) ? kFullContrast : contrast_;
  const auto share = [&](int level) {
    return (level * contrast + kFullContrast / 2) / kFullContrast;
  };
  return {std::max(share(kUsualThreshold), kLeastThreshold), share(kBrightness)};
}

/// A gain that goes slowly enough is the camera's, and taken back, but for what the model learns.
/// Where no gain is told, nothing says that it has changed.
void ConsensusMethod::followExposure(const MethodJob& job, uint64_t differing) {
  const auto pixels = static_cast<uint64_t>(smooth_.size().area());
  if (gain_ == kSameGain && differing * 256 < pixels * kOddShare) return;
  const int seen = job.on.findGain(smooth_, model_);
  if (seen != kNoGain) {
    const int learnt = kSameGain / kLearntGain;
    const int wanted = std::clamp(kSameGain, seen - learnt, seen + learnt);
    const int step = std::max<int>(1, gain_ / static_cast<int>(job.clock.frames(1.0)));
    gain_ = std::clamp(wanted, gain_ - step, gain_ + step);
  }
  if (gain_ == kSameGain) return;
  if (isFar(gain_))
    learnGain(job);
  else
    job.on.mapLevels(withoutGain(gain_), smooth_);
  job.on.judge(smooth_, model_, toleranceOf(job), verdicts_);
}

/// A gain that has gone far may be the light's, which goes on and does not come back: what is
/// remembered goes along before it cannot be told any more.
void ConsensusMethod::learnGain(const MethodJob& job) {
  const LevelMap map = withGain(std::exchange(gain_, kSameGain));
  job.on.relight({map, map, map}, model_);
  SmoothPicture still{std::move(still_.colours), model_.channels};
  job.on.mapLevels(map, still);
  still_.colours = std::move(still.planes);
}

/// In the dark there is nothing to be told from noise, and nothing to be learnt.
bool ConsensusMethod::isTooDark(const MethodJob& job, Foreground& out) {
  const bool wasDark = isDark_;
  isDark_ = job.on.isDarkerThan(smooth_, wasDark ? kBrightLevel : kDarkLevel);
  if (isDark_ != wasDark) out.scene.event = isDark_ ? SceneEvent::TooDark : SceneEvent::BrightAgain;
  out.scene.isDark = isDark_;
  if (!isDark_) return false;
  gain_ = kSameGain;
  if (model_.channels == 0) out.status = Status::Training;
  out.mask.fill(kBackgroundPixel);
  return true;
}

/// A camera that stood still is looked for close by; one that sways goes on from where it was, too.
/// It is followed downhill. Where that does not end, it is no shift, but something that looks like
/// one, as light on a slope of colour does.
Point ConsensusMethod::findShift(const MethodJob& job) {
  const Size size = smooth_.size();
  Shift found = job.on.findShift(smooth_, model_, {});
  const auto isBetter = [&](Point centre) {
    const Shift there = job.on.findShift(smooth_, model_, centreWithin(centre, size));
    if (there.off >= found.off) return false;
    found = there;
    return true;
  };
  if (shift_ != Point{}) isBetter(shift_);
  for (int i = 0; i < kMostSteps && found.by != Point{} && isBetter(found.by); ++i) continue;
  const int most = mostShiftPx(size);
  const bool isLost = absDiff(found.by.x, 0) == most || absDiff(found.by.y, 0) == most;
  return !isLost && found.explains(sways_ ? kSwayingShare : kPushedShare) ? found.by : Point{};
}

/// A camera that sways sees what the model knows beside its place. The picture is put there, by
/// whole pixels: where the rest of a shift falls is what the model has seen before.
SceneEvent ConsensusMethod::followCamera(const MethodJob& job) {
  const Point before = std::exchange(shift_, findShift(job));
  sways_ = shift_ != Point{} || (sways_ && calmFrames_ < job.clock.frames(1.0));
  if (shift_ == Point{}) {
    offFrames_ = 0;
    ++calmFrames_;
    return SceneEvent::None;
  }
  job.on.shiftPicture(shift_, spare_, smooth_);
  job.on.judge(smooth_, model_, toleranceOf(job), verdicts_);
  offFrames_ = shift_ == before ? offFrames_ + 1 : 0;
  if (offFrames_ >= job.clock.frames(5.0)) return SceneEvent::CameraMoved;
  const bool isNews = std::exchange(calmFrames_, 0) >= job.clock.frames(1.0);
  return isNews ? SceneEvent::CameraShaken : SceneEvent::None;
}

/// No light explains it, no object covers it, and it stays.
bool ConsensusMethod::isElsewhere(const MethodJob& job) {
  elsewhereFrames_ = job.on.isEverywhere(verdicts_.raw) ? elsewhereFrames_ + 1 : 0;
  return elsewhereFrames_ >= job.clock.frames(0.3);
}

/// Much differs from the model: why?
void ConsensusMethod::watch(const MethodJob& job, uint64_t differing, Foreground& out) {
  const auto pixels = static_cast<uint64_t>(smooth_.size().area());
  SceneEvent& event = out.scene.event;
  if (differing * 256 < pixels * kOddShare && !sways_) {
    shift_ = {};
    offFrames_ = elsewhereFrames_ = 0;
    ++calmFrames_;
    return;
  }
  if (job.on.isEverywhere(verdicts_.raw) && job.on.hasSwitchedColour(smooth_, model_)) {
    event = SceneEvent::ColourSwitched;
    return;
  }
  const SceneEvent pushed = followCamera(job), lit = followLight(job);
  out.scene.shift = shift_;
  if (pushed != SceneEvent::None) event = pushed;
  if (lit != SceneEvent::None) event = lit;
  if (isElsewhere(job)) event = SceneEvent::CameraMoved;
}

/// Most of the picture is foreground: is it the known scene in another light, or another scene?
SceneEvent ConsensusMethod::followLight(const MethodJob& job) {
  const auto pixels = static_cast<uint64_t>(smooth_.size().area());
  const uint64_t before = job.on.countSet(verdicts_.raw);
  if (before * 256 < pixels * kLightShare) return SceneEvent::None;
  job.on.paintModel(model_, shown_);
  const Tolerance tolerance = toleranceOf(job);
  const LevelMaps maps = job.on.matchLight(shown_, smooth_);
  if (uint64_t{job.on.countApart(shown_, smooth_, maps, model_, tolerance)} * 2 < before) {
    job.on.relight(maps, model_);
    litFrames_ = 0;
    clear(still_);
    job.on.judge(smooth_, model_, tolerance, verdicts_);
    return SceneEvent::LightSwitched;
  }
  return before * 256 < pixels * kOtherSceneShare ? SceneEvent::None : SceneEvent::CameraMoved;
}

/// A model that is being learnt does not say much of the camera, which is looked at in any case
/// then.
bool ConsensusMethod::cameraStarts(const MethodJob& job, uint64_t differing) {
  if (job.params.camera != Camera::Auto) return false;
  const auto pixels = static_cast<uint64_t>(smooth_.size().area());
  const bool isOff = differing * 256 >= pixels * kOddShare && job.on.isEverywhere(verdicts_.raw);
  if (isOff || isFirst(job)) return camera_.starts(isOff, job.clock, job.executor);
  camera_.passOver();
  return false;
}

/// Of a camera that moves: looked at from time to time.
bool ConsensusMethod::isBlind(const MethodJob& job) {
  if ((++frame_).value() % kContrastFrames != 0) return false;
  job.on.smooth(*job.picture, smooth_);
  return job.on.isDarkerThan(smooth_, kDarkLevel);
}

/// The stages behind need not look for the camera's motion once more.
void ConsensusMethod::goAlong(Foreground& out) const {
  tellMoving(out);
  out.camera = camera_.motion();
  out.cameraSince = camera_.since();
}

/// Parts that are sure somewhere, without their holes.
void ConsensusMethod::keepWhole(const MethodJob& job) {
  const auto pixels = static_cast<uint32_t>(mask_.size().area());
  job.on.keepSupported(mask_, verdicts_.strong, std::max(4u, pixels / 10000));
  job.on.fillHoles(mask_, pixels / 50);
}

void ConsensusMethod::clean(const MethodJob& job) {
  const auto pixels = static_cast<uint32_t>(mask_.size().area());
  const int radius = pixels < 40000 ? 1 : pixels < 200000 ? 2 : 3;
  job.on.keepMajority(verdicts_.raw, radius, kMajority, mask_);
  job.on.dropSwaying(smooth_, model_, toleranceOf(job), mask_);
  keepWhole(job);
  job.on.fillUnedged(smooth_, kMostGapStep, mostGapPx(mask_.size()), mask_);
  // Not at the start: what is left of those who were in view must not stick to those who are, and
  // is told from them by its contour.
  if (!isFirst(job)) {
    job.on.growFaint({smooth_, model_, verdicts_.faint, shown_}, mask_);
    keepWhole(job);
  }
  // What is seen of the model hereafter is at most two pixels from the mask, which grows no more.
  job.on.thicken(mask_, 2, around_);
  job.on.paintModelAt(around_, model_, shown_);
  const bool isInPlace = shift_ == Point{};  // Or the picture as it came is elsewhere.
  if (!isFirst(job) && isInPlace)
    for (const BorderLayer layer : {BorderLayer::DrawnIn, BorderLayer::Blurred})
      job.on.trimBorder({*job.picture, smooth_, model_, shown_, toleranceOf(job)}, layer, mask_);
  job.on.dropSmallParts(mask_, std::max(8u, pixels / 4000));
}

void ConsensusMethod::dissolveGhosts(const MethodJob& job) {
  const int64_t absorbFrames = job.clock.frames(job.params.absorbTimeS);
  const AgeScale scale = AgeScale::upTo(absorbFrames);
  job.on.followStill(smooth_, model_, toleranceOf(job), mask_, scale.mostAge(frame_.value()),
                     still_);
  const auto usual = static_cast<int>(std::clamp<int64_t>(job.clock.frames(0.4), 4, 60000));
  const int leastAge = isFirst(job) ? 4 : usual;
  job.on.findGhosts(smooth_, model_, mask_, still_, leastAge, ghosts_);
  // What has not changed for so long belongs to the scene.
  job.on.addAged(mask_, still_, scale.ageOf(absorbFrames), ghosts_);
  if (frame_.value() % 8 == 0)
    job.on.addDisplaced(smooth_, model_, mask_, still_, job.clock.frames(3.0), ghosts_);
  job.on.replaceWhere(ghosts_, smooth_, model_);
  job.on.remove(ghosts_, mask_);
}

void ConsensusMethod::findShadow(const MethodJob& job) {
  if (!job.params.findsShadows) return shadow_.clear();
  job.on.findShadows(smooth_, shown_, mask_, dark_);
  job.on.keepMajority(dark_, 1, 128, shadow_);
  job.on.keepOnly(mask_, shadow_);
  job.on.keepCastShadows(mask_, shadow_);
}

/// Unrest is forgotten by time, but not within fewer frames than a flip needs to be seen again:
/// what sways does not sway less often from frame to frame if there are few of them.
uint32_t calmPeriodOf(const FrameClock& clock) {
  constexpr int64_t kLeast = 8, kMost = 4096;
  return static_cast<uint32_t>(std::clamp(clock.frames(0.32), kLeast, kMost));
}

void ConsensusMethod::learnFrame(const MethodJob& job) {
  const auto usual =
      std::clamp<int64_t>(job.clock.frames(job.params.learningTimeS) / kSamples, 2, 4096);
  const ConsensusRate rate{frame_.value(), isFirst(job) ? 3 : static_cast<int>(usual), isFirst(job),
                           calmPeriodOf(job.clock)};
  std::swap(near_, previousNear_);
  job.on.thicken(mask_, 2, near_);
  const BitMask& near = isFirst(job) ? mask_ : near_;
  job.on.learn(smooth_, {mask_, near, verdicts_.raw, previousNear_, previousRaw_}, rate, model_);
  std::swap(verdicts_.raw, previousRaw_);
}

void ConsensusMethod::segment(const MethodJob& job, Foreground& out) {
  out.extent = boundsOf(job.picture->size());
  const bool wasMoving = camera_.isMoving();
  camera_.show(job.params.camera == Camera::Auto ? job.picture : nullptr);
  if (wasMoving) {
    const bool goesOn = camera_.isMoving() && !camera_.stops(job.clock, job.executor);
    if (goesOn && !isBlind(job)) return goAlong(out);
    camera_.rest();
    model_.channels = 0;  // What is to be seen now is new.
  }
  if (model_.channels == 0) {
    job.on.smooth(*job.picture, smooth_);
    if (!isTooDark(job, out)) start(job, out);
    return;
  }
  ++frame_;
  ++litFrames_;
  job.on.smoothAndJudge(*job.picture, model_, toleranceOf(job), {smooth_, verdicts_});
  const auto pixels = static_cast<uint64_t>(smooth_.size().area());
  followExposure(job, job.on.countSet(verdicts_.raw));
  const uint64_t differing = job.on.countSet(verdicts_.raw);
  if ((isDark_ || differing * 256 >= pixels * kLightShare) && isTooDark(job, out)) return;
  watch(job, differing, out);
  if (cameraStarts(job, differing)) {
    out.scene.event = SceneEvent::CameraStarted;
    return goAlong(out);
  }
  if (startsAnew(out.scene.event)) {
    job.on.smooth(*job.picture, smooth_);
    return start(job, out);
  }
  clean(job);
  dissolveGhosts(job);
  findShadow(job);
  learnFrame(job);
  if (frame_.value() % kContrastFrames == 0) followContrast(job);
  job.on.paintForeground(mask_, shadow_, shift_, out.mask);
}

}  // namespace

std::unique_ptr<MethodModel> makeConsensusMethod() {
  return std::make_unique<ConsensusMethod>();
}

}  // namespace rg::background
