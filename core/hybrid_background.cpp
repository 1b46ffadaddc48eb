// SPDX-License-Identifier: LGPL-2.1-or-later
// The default method: the paper's structure over a model of several modes.
#include "core/background_method.hpp"
#include "core/cast_shadows.hpp"
#include "core/consensus_background.hpp"
#include "core/light_switch.hpp"
#include "core/mask_cleaning.hpp"
#include "core/mask_gaps.hpp"
#include "core/shadow.hpp"
#include "core/still_parts.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kUsualThreshold = 8;  ///< Grey levels that the darkest pixel may be off.
constexpr int kBrightness = 18;     ///< Of 256: share of the brightness that is added to it.
constexpr int kMajority = 115;      ///< Of 256: share of foreground that keeps a pixel.
constexpr int kMostGapStep = 14;    ///< Grey levels across a border that is no edge.

constexpr uint32_t kLightShare = 102;       ///< Of 256: foreground that asks for a reason.
constexpr uint32_t kOtherSceneShare = 192;  ///< Of 256: foreground that no object covers.

class HybridBackground final : public BackgroundMethodModel {
 public:
  void prepare(const Picture& picture) override;
  void segment(const BackgroundJob& job, Foreground& out) override;
  void reset(Reset what) override;

 private:
  bool isFirst(const BackgroundJob& job) const {
    return frame_ < static_cast<uint32_t>(job.params.trainingFrames);
  }
  void start(const BackgroundJob& job, Foreground& out);
  void judge(const BackgroundJob& job);
  SceneEvent followLight(const BackgroundJob& job);
  void clean(const BackgroundJob& job, ImageView<uint8_t> mask);
  void removeShadows(const BackgroundJob& job, ImageView<uint8_t> mask);
  void dissolveGhosts(const BackgroundJob& job, ImageView<uint8_t> mask);
  void learnFrame(const BackgroundJob& job, ImageView<const uint8_t> mask);

  SmoothPicture smooth_;
  ConsensusBackground model_;
  Distances distances_;
  Image<uint8_t> radii_, raw_, previousRaw_, strong_;
  StillPixels still_;
  Image<uint8_t> ghosts_;
  StillScratch stillScratch_;
  CleaningScratch scratch_;
  GapScratch gaps_;
  std::array<Image<uint8_t>, 3> shown_;
  Image<uint8_t> dark_, shadow_;
  CastShadowScratch shadowScratch_;
  uint32_t frame_ = 0;
};

void HybridBackground::prepare(const Picture& picture) {
  const Size size = picture.size();
  for (Image<uint8_t>* image :
       {&radii_, &raw_, &previousRaw_, &strong_, &ghosts_, &dark_, &shadow_})
    image->resize(size);
  rg::prepare(size, picture.isGrey() ? 1 : 3, model_);
  rg::prepare(size, picture.isGrey() ? 1 : 3, still_);
}

void HybridBackground::reset(Reset what) {
  if (what == Reset::Stream) model_.channels = 0;
}

void HybridBackground::start(const BackgroundJob& job, Foreground& out) {
  fillFrom(smooth_, job.executor, model_);
  previousRaw_.fill(0);
  still_.ages.fill(0);
  still_.fresh.fill(0);
  frame_ = 0;
  out.status = Status::Training;
  out.mask.fill(kBackgroundPixel);
}

void HybridBackground::judge(const BackgroundJob& job) {
  measure(smooth_, model_, job.executor, distances_);
  const Tolerance tolerance = job.params.threshold > 0 ? Tolerance{job.params.threshold, 0}
                                                       : Tolerance{kUsualThreshold, kBrightness};
  findRadii(smooth_, model_, tolerance, job.executor, radii_);
  job.executor.forRows(raw_.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const uint8_t *second = distances_.second.row(y), *radius = radii_.row(y);
      for (int x = 0; x < raw_.width(); ++x) {
        raw_.row(y)[x] = second[x] > radius[x] ? 255 : 0;
        strong_.row(y)[x] = second[x] > std::min(254, 2 * radius[x]) ? 255 : 0;
      }
    }
  });
}

uint32_t countSet(ImageView<const uint8_t> mask) {
  uint32_t pixels = 0;
  for (int y = 0; y < mask.height(); ++y)
    pixels +=
        static_cast<uint32_t>(std::count(mask.row(y), mask.row(y) + mask.width(), uint8_t{255}));
  return pixels;
}

/// Most of the picture is foreground: is it the known scene in another light, or another scene?
SceneEvent HybridBackground::followLight(const BackgroundJob& job) {
  const auto pixels = static_cast<uint64_t>(raw_.size().area());
  const uint64_t before = countSet(raw_);
  if (before * 256 < pixels * kLightShare) return SceneEvent::None;
  paintModel(model_, job.executor, shown_);
  const LevelMaps maps = matchLight(shown_, smooth_, job.executor);
  if (uint64_t{countApart(shown_, smooth_, maps, radii_)} * 2 < before) {
    relight(maps, job.executor, model_);
    still_.ages.fill(0);
    judge(job);
    return SceneEvent::LightSwitched;
  }
  return before * 256 < pixels * kOtherSceneShare ? SceneEvent::None : SceneEvent::Changed;
}

void HybridBackground::clean(const BackgroundJob& job, ImageView<uint8_t> mask) {
  const auto pixels = static_cast<uint32_t>(mask.size.area());
  const int radius = pixels < 40000 ? 1 : pixels < 200000 ? 2 : 3;
  keepMajority(raw_, radius, kMajority, job.executor, scratch_, mask);
  keepSupported(mask, strong_, std::max(4u, pixels / 10000), scratch_);
  fillHoles(mask, pixels / 50, scratch_);
  fillUnedged(smooth_.planes[0], kMostGapStep, pixels / 5, job.executor, gaps_, mask);
  dropSmallParts(mask, std::max(8u, pixels / 4000), scratch_);
}

void HybridBackground::dissolveGhosts(const BackgroundJob& job, ImageView<uint8_t> mask) {
  followStill(smooth_, mask, radii_, job.executor, still_);
  const auto usual = static_cast<int>(std::clamp<int64_t>(job.clock.frames(0.4), 4, 60000));
  const int leastAge = isFirst(job) ? 4 : usual;
  findGhosts(smooth_, model_, mask, still_, leastAge, stillScratch_, ghosts_);
  // What has not changed for so long belongs to the scene.
  const int64_t absorbFrames = job.clock.frames(job.params.absorbTimeS);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (still_.ages.row(y)[x] >= absorbFrames) ghosts_.row(y)[x] = 255;
  replaceWhere(ghosts_, smooth_, job.executor, model_);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (ghosts_.row(y)[x] != 0) mask.row(y)[x] = kBackgroundPixel;
}

void HybridBackground::removeShadows(const BackgroundJob& job, ImageView<uint8_t> mask) {
  if (!job.params.findsShadows) return;
  paintModel(model_, job.executor, shown_);
  const auto planes = [&](const std::array<Image<uint8_t>, 3>& from) {
    const bool isGrey = model_.channels == 1;
    return ColourPlanes{from[isGrey ? 0 : 1], from[0], from[isGrey ? 0 : 2]};
  };
  findShadows(planes(smooth_.planes), planes(shown_), mask, job.executor, dark_);
  keepMajority(dark_, 1, 128, job.executor, scratch_, shadow_);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) shadow_.row(y)[x] = shadow_.row(y)[x] & mask.row(y)[x];
  keepCastShadows(mask, shadow_, shadowScratch_);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (shadow_.row(y)[x] != 0) mask.row(y)[x] = kShadowPixel;
}

void HybridBackground::learnFrame(const BackgroundJob& job, ImageView<const uint8_t> mask) {
  const auto usual =
      std::clamp<int64_t>(job.clock.frames(job.params.learningTimeS) / kSamples, 2, 4096);
  const ConsensusRate rate{frame_, isFirst(job) ? 3 : static_cast<int>(usual), isFirst(job)};
  learn(smooth_, {mask, raw_, previousRaw_}, distances_, rate, job.executor, model_);
  std::swap(raw_, previousRaw_);
}

void HybridBackground::segment(const BackgroundJob& job, Foreground& out) {
  out.mask.resize(job.picture->size());
  smooth(*job.picture, job.executor, smooth_);
  if (model_.channels == 0) return start(job, out);
  ++frame_;
  judge(job);
  out.scene.event = followLight(job);
  if (out.scene.event == SceneEvent::Changed) return start(job, out);
  clean(job, out.mask);
  dissolveGhosts(job, out.mask);
  learnFrame(job, out.mask);
  removeShadows(job, out.mask);
}

}  // namespace

std::unique_ptr<BackgroundMethodModel> makeHybridBackground() {
  return std::make_unique<HybridBackground>();
}

}  // namespace rg
