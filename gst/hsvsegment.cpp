// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-hsvsegment
 * @title: hsvsegment
 *
 * Divides the picture, or the foreground that bgremove found, into regions of one colour and
 * attaches the number of its region to every pixel; the pixels themselves pass untouched.
 *
 * |[
 * gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert ! hsvsegment max-regions=160
 * ! regionmask source=labels ! pngenc ! multifilesink location=labels-%06d.png
 * ]|
 */
#include "core/segmentation.hpp"
#include "gst/elements.hpp"
#include "gst/support/frame_loader.hpp"
#include "gst/support/stage_filter.hpp"

#include <array>

namespace rg {
namespace {

/// As the user asks for it; the stage knows only what it comes to.
enum class ScopeChoice : int { Auto, Frame, Foreground };

GType scopeType() {
  static const GEnumValue values[] = {
      {static_cast<int>(ScopeChoice::Auto),
       "The foreground where bgremove is upstream, else the whole frame", "auto"},
      {static_cast<int>(ScopeChoice::Frame), "The whole frame: for moving cameras", "frame"},
      {static_cast<int>(ScopeChoice::Foreground), "Only what bgremove marked as foreground",
       "foreground"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionScopeChoice", values);
  return type;
}

struct Settings : StageSettings, SegmentationParams {
  ScopeChoice scopeChoice = ScopeChoice::Auto;
  guint64 badBuffers = 0;
};

constexpr std::array kProperties{
    enumProperty<Settings, &Settings::scopeChoice>(
        "scope", "Which pixels are divided into regions; auto is decided on the first frame",
        scopeType),
    property<Settings, &Settings::similarity>("similarity",
                                              "Largest difference between neighbouring pixels of "
                                              "one region, in grey levels of a channel. "
                                              "Lower gives more and smaller regions",
                                              0, 255),
    property<Settings, &Settings::minAreaPx>("min-area",
                                             "Regions with fewer pixels are absorbed by the "
                                             "neighbour most like them; 0 = by the size of "
                                             "the frame",
                                             0, 1 << 24),
    property<Settings, &Settings::maxRegions>(
        "max-regions", "Never more regions than this; the smallest are absorbed first", 1, 65535),
    threadsProperty<Settings>(),
    property<Settings, &Settings::badBuffers>(
        "bad-buffers",
        "Frames passed on unread, because their memory is not what their caps or "
        "GstVideoMeta promise",
        0, 0, Mutable::Never),
};

class HsvSegment final : public StageFilter {
 public:
  using StageFilter::StageFilter;

  void* settings() override { return &settings_; }

  bool start() override {
    const Context context = makeContext(snapshot(settings_).threads);
    executor_ = context.cpu;
    stage_ = makeSegmentationStage(context);
    return true;
  }
  void stop() override { stage_.reset(); }
  void reset(Reset what) override {
    if (stage_) stage_->reset(what);
  }

  GstFlowReturn process(const FilterFrame& frame) override {
    Settings settings = snapshot(settings_);
    if (frame.isFirst)
      autoScope_ = findResult<Foreground>(frame.buffer) ? Scope::Foreground : Scope::Frame;
    settings.scope = scopeOf(settings.scopeChoice);
    return settings.scope == Scope::Foreground ? divideForeground(frame, settings)
                                               : divideFrame(frame, settings);
  }

 private:
  [[nodiscard]] Scope scopeOf(ScopeChoice choice) const {
    switch (choice) {
      case ScopeChoice::Frame:
        return Scope::Frame;
      case ScopeChoice::Foreground:
        return Scope::Foreground;
      case ScopeChoice::Auto:
        break;
    }
    return autoScope_;
  }

  GstFlowReturn divideForeground(const FilterFrame& frame, const Settings& settings) {
    auto upstream = require<Foreground>(frame, "bgremove");
    if (upstream.flow != GST_FLOW_OK) return upstream.flow;
    if (!upstream.result || upstream.result->status == Status::Skipped) {
      attachSkipped<Labels>(frame);
      return GST_FLOW_OK;
    }
    auto picture = upstream.result->picture;
    attach<Labels>(frame,
                   stage_->process(std::move(picture), std::move(upstream.result), settings));
    return GST_FLOW_OK;
  }

  GstFlowReturn divideFrame(const FilterFrame& frame, const Settings& settings) {
    if (!frame.isUsable) {
      attachSkipped<Labels>(frame);
      return GST_FLOW_OK;
    }
    auto foreground = findResult<Foreground>(frame.buffer);
    if (foreground && foreground->picture) {
      auto shared = foreground->picture;
      attach<Labels>(frame, stage_->process(std::move(shared), std::move(foreground), settings));
      return GST_FLOW_OK;
    }
    auto picture = loader_.load(frame.buffer, frame.info, *executor_);
    if (!picture) {
      {
        const std::lock_guard lock(settingsMutex());
        ++settings_.badBuffers;
      }
      attach<Labels>(frame, picture.error());
      return GST_FLOW_OK;
    }
    attach<Labels>(frame, stage_->process(*std::move(picture), nullptr, settings));
    return GST_FLOW_OK;
  }

  Settings settings_;
  Scope autoScope_ = Scope::Frame;
  std::shared_ptr<const Executor> executor_;
  std::unique_ptr<SegmentationStage> stage_;
  FrameLoader loader_;
};

const Settings kDefaults;
const FilterDescription kDescription{
    .elementName = "hsvsegment",
    .typeName = "GstHsvSegment",
    .longName = "Colour segmentation",
    .klass = "Filter/Analyzer/Video",
    .description =
        "Divides the whole frame, or the foreground that bgremove found, into regions of "
        "one colour. Attaches the number of its region to each pixel as a meta; pixels "
        "pass untouched. Second of the five stages, needs bgremove only for "
        "scope=foreground",
    .example =
        "gst-launch-1.0 videotestsrc pattern=ball num-buffers=100 ! "
        "video/x-raw,format=I420 ! hsvsegment max-regions=160 ! regionmask source=labels "
        "! pngenc ! multifilesink location=labels-%03d.png",
    .caps = kPixelCaps,
    .properties = kProperties,
    .defaults = &kDefaults,
    .create = [](GstBaseTransform* element) -> Filter* { return new HsvSegment(element); },
};

}  // namespace
}  // namespace rg

GType gst_region_hsvsegment_get_type() {
  static const GType type = rg::registerFilter(rg::kDescription);
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(hsvsegment, "hsvsegment", GST_RANK_NONE,
                            gst_region_hsvsegment_get_type())
