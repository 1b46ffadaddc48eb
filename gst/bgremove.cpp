// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-bgremove
 * @title: bgremove
 *
 * Tells the moving foreground of a still camera's picture from its background, and attaches the
 * mask to each buffer; the pixels pass untouched.
 *
 * |[
 * gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert ! bgremove !
 *   regionmask source=foreground ! videoconvert ! autovideosink
 * ]|
 */
#include "core/background/background.hpp"
#include "core/text/text.hpp"
#include "gst/elements.hpp"
#include "gst/support/backend.hpp"
#include "gst/support/interest_mask.hpp"
#include "gst/support/origin.hpp"
#include "gst/support/pixel_filter.hpp"
#include "gst/support/timed_message.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace rg {
namespace {

GType methodType() {
  static const GEnumValue values[] = {
      {static_cast<int>(background::Method::Hybrid),
       "Several colours per pixel, holes filled, shadows, ghosts and light changes handled",
       "hybrid"},
      {static_cast<int>(background::Method::Paper),
       "One Gaussian per pixel as in section 2.2.1 of the paper", "paper"},
      {static_cast<int>(background::Method::FrameDifference),
       "What changed since the frame before, and things that stopped, as in section 2.1 of the "
       "paper: the fastest",
       "frame-difference"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionBackgroundMethod", values);
  return type;
}

GType cameraType() {
  static const GEnumValue values[] = {
      {static_cast<int>(background::Camera::Auto),
       "Decided from frame to frame: nothing is foreground while the camera moves, and once it "
       "has stood for a second a new model is learnt. By method=hybrid",
       "auto"},
      {static_cast<int>(background::Camera::Still), "It stands still, or sways and comes back",
       "still"},
      {static_cast<int>(background::Camera::Moving), "It moves all the time: nothing is foreground",
       "moving"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionCamera", values);
  return type;
}

GType searchType() {
  static const GEnumValue values[] = {
      {static_cast<int>(background::SearchScope::Frame), "The whole frame", "frame"},
      {static_cast<int>(background::SearchScope::Areas),
       "The areas round the things of the frame before, and the rows whose turn it is", "areas"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionSearch", values);
  return type;
}

GType thresholdSourceType() {
  static const GEnumValue values[] = {
      {static_cast<int>(background::ThresholdSource::Difference),
       "The histogram of the difference of two frames: follows the noise", "difference"},
      {static_cast<int>(background::ThresholdSource::Frame),
       "The histogram of the frame itself: an eighth of its contrast", "frame"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionThresholdSource", values);
  return type;
}

struct Settings : PixelSettings,
                  background::Params,
                  InterestSettings,
                  OriginSettings,
                  BackendSettings {};

constexpr std::array kProperties{
    enumProperty<Settings, &Settings::method>("method", "How the background is modelled",
                                              methodType),
    enumProperty<Settings, &Settings::camera>(
        "camera",
        "Whether the camera may move. In frames in which it does hsvsegment's scope=auto divides "
        "the whole frame",
        cameraType),
    property<Settings, &Settings::trainingFrames>(
        "training-frames",
        "Frames from which the first model is learnt. With method=paper nothing is foreground "
        "until "
        "then; method=hybrid finds things from the start and only learns faster; "
        "method=frame-difference needs none",
        1, 65535),
    property<Settings, &Settings::learningTimeS>(
        "learning-time", "Seconds in which the model follows a slow change of the background", 0.1,
        3600),
    property<Settings, &Settings::threshold>(
        "threshold",
        "Least difference from the background, in grey levels of a channel, that can be "
        "foreground; "
        "0 = found by the method from the noise and the contrast of the picture",
        0, 255),
    property<Settings, &Settings::findsShadows>(
        "shadows", "Tell cast shadows from foreground: they get 128 in the mask instead of 255"),
    property<Settings, &Settings::absorbTimeS>(
        "absorb-time",
        "Seconds after which a thing that stopped moving becomes part of the background", 0.1,
        86400),
    property<Settings, &Settings::mask>(
        "mask",
        "Path of a PNG picture, white where to look: nothing is foreground elsewhere, nor reported "
        "by any element. Fitted to the frame; empty = look everywhere. A regular file, or a link "
        "to one, of 35 million pixels at most; read when it is set or at the start"),
    property<Settings, &Settings::areasOfInterest>(
        "areas-of-interest",
        "Polygons to look in, and with the word exclude in front, to leave out. Points are x,y as "
        "shares of width and height from 0 to 1, separated by blanks, polygons by ';': "
        "\"0,0.5 1,0.5 1,1 0,1; exclude 0.4,0.6 0.5,0.6 0.5,0.7\". Holds together with mask; "
        "empty = look everywhere. At most 1000 points in all"),
    enumProperty<Settings, &Settings::search>(
        "search",
        "Where method=frame-difference looks. Both find the same things; areas looks at less of "
        "the frame",
        searchType),
    property<Settings, &Settings::searchInterval>(
        "search-interval",
        "Frames in which method=frame-difference has searched every row for new things: in each "
        "frame it scans one row in so many, in turn. A thing of so many rows is found at once",
        1, 64),
    enumProperty<Settings, &Settings::thresholdFrom>(
        "threshold-from",
        "What method=frame-difference takes its threshold from, where threshold is 0",
        thresholdSourceType),
    analysisHeightProperty<Settings>(),
    sourceProperty<Settings>(),
    tagsProperty<Settings>(),
    threadsProperty<Settings>(),
    backendProperty<Settings>(),
    deviceIdProperty<Settings>(),
    activeBackendProperty<Settings>(),
    statsProperty<Settings>(),
    badBuffersProperty<Settings>(),
};

/// Null where nothing is told.
const char* messageOf(background::SceneEvent event) {
  switch (event) {
    case background::SceneEvent::None:
      break;
    case background::SceneEvent::LightSwitched:
      return "regiongraph-light-switched";
    case background::SceneEvent::ColourSwitched:
      return "regiongraph-night-switched";
    case background::SceneEvent::CameraMoved:
      return "regiongraph-camera-moved";
    case background::SceneEvent::CameraShaken:
      return "regiongraph-camera-shaken";
    case background::SceneEvent::TooDark:
    case background::SceneEvent::BrightAgain:
      return "regiongraph-too-dark";
    case background::SceneEvent::ModelLost:
      return "regiongraph-model-lost";
    case background::SceneEvent::CameraStarted:
    case background::SceneEvent::CameraStopped:
      return "regiongraph-camera-moving";
  }
  return nullptr;
}

class BgRemove final : public PixelFilter<Settings, background::Stage> {
 public:
  explicit BgRemove(GstBaseTransform* element) : PixelFilter(element, background::makeStage) {}

  bool start() override {
    interest_ = {};
    const Settings settings = currentSettings();
    inForce_ = settings;
    if (const auto read = interest_.follow(inForce_); !read) {
      postError(read.error().message);
      return false;
    }
    return startAt(settings.method == background::Method::Hybrid ? kUsualHeight : kHeightOfFrame);
  }

  GstFlowReturn process(const FilterFrame& frame) override {
    checkOrder<segmentation::Labels, graph::Graph, motion::Motion, objects::Objects>(frame);
    Settings settings = followInterest();
    settings.interest = interest_.fit(analysedSize(frame));
    if (!frame.isUsable) {
      attachSkipped<background::Foreground>(frame);
    } else if (auto picture = load(frame)) {
      auto result = stage().process(*std::move(picture), settings, frame.time);
      if (result) tell((*result)->scene, momentOf(frame.buffer, settings.origin));
      attach<background::Foreground>(frame, std::move(result));
    } else {
      attach<background::Foreground>(frame, picture.error());
    }
    return GST_FLOW_OK;
  }

 private:
  /// The settings; a mask or areas that can't be read go back to those in use.
  Settings followInterest() {
    Settings settings = currentSettings();
    const InterestSettings& wanted = settings;
    if (const auto read = interest_.follow(wanted); !read) {
      postWarning(read.error().message + "; what was set before stays in use");
      const std::lock_guard lock(settingsMutex());
      InterestSettings& current = settings_;
      if (current == wanted) current = inForce_;
    } else if (inForce_ != wanted) {
      inForce_ = wanted;
    }
    return settings;
  }

  [[nodiscard]] const char* lossOfDevice() const override {
    return ", with a new background model.";
  }

  [[nodiscard]] Progress describe(const FilterFrame& frame) override {
    const auto seen = findResult<background::Foreground>(frame.buffer);
    if (!seen) return {};
    const auto pixels = static_cast<double>(std::max<int64_t>(seen->size.area(), 1));
    std::array<char, 160> text;
    std::snprintf(text.data(), text.size(),
                  "%s, foreground %.2f %% of the frame in %zu areas%s, background off by %d,%d px",
                  text::name(seen->status).data(), 100 * seen->scene.foregroundPx / pixels,
                  seen->areas.size(),
                  seen->scene.isDark           ? ", too dark to see"
                  : seen->scene.isCameraMoving ? ", the camera moves"
                                               : "",
                  seen->scene.shift.x, seen->scene.shift.y);
    const uint64_t state = static_cast<uint64_t>(seen->status) * 256 +
                           static_cast<uint64_t>(seen->scene.event) * 4 +
                           seen->scene.isCameraMoving * 2u + seen->scene.isDark;
    return {state, text.data()};
  }

  void tell(const background::Scene& scene, const FrameMoment& moment) {
    const char* name = messageOf(scene.event);
    if (!name) return;
    GstStructure* fields = gst_structure_new_empty(name);
    if (scene.event == background::SceneEvent::TooDark ||
        scene.event == background::SceneEvent::BrightAgain)
      gst_structure_set(fields, "dark", G_TYPE_BOOLEAN, scene.isDark, nullptr);
    if (scene.event == background::SceneEvent::CameraStarted ||
        scene.event == background::SceneEvent::CameraStopped)
      gst_structure_set(fields, "moving", G_TYPE_BOOLEAN, scene.isCameraMoving, nullptr);
    postTimedMessage(element(), category(), moment, fields);
  }

  InterestMask interest_;
  InterestSettings inForce_;
};

const Settings kDefaults;
const FilterDescription kDescription{
    .elementName = "bgremove",
    .typeName = "GstBgRemove",
    .longName = "Background removal",
    .klass = "Filter/Analyzer/Video",
    .description =
        "Tells the moving foreground of a still camera's picture from its background. "
        "Attaches a mask (0 background, 128 shadow, 255 foreground) and the boxes of its "
        "connected parts to each buffer as a meta; pixels pass untouched. First of the "
        "five stages; leave it out for a camera that moves all the time. Frames have at most "
        "35389440 pixels "
        "(8192x4320)",
    .example =
        "gst-launch-1.0 videotestsrc pattern=ball num-buffers=100 ! "
        "video/x-raw,format=I420 ! bgremove ! regionmask source=foreground ! pngenc ! "
        "multifilesink location=mask-%03d.png",
    .caps = kPixelCaps,
    .properties = kProperties,
    .defaults = &kDefaults,
    .create = [](GstBaseTransform* element) -> Filter* { return new BgRemove(element); },
};

}  // namespace
}  // namespace rg

GType gst_region_bgremove_get_type() {
  static const GType type = rg::registerFilter(rg::kDescription);
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(bgremove, "bgremove", GST_RANK_NONE, gst_region_bgremove_get_type())
