// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-haardetect
 * @title: haardetect
 *
 * Says which objects are what an OpenCV Haar cascade was trained for, people for instance: looks
 * for it round the objects that mrfmerge follows, or in the whole frame, in windows of all sizes.
 * The class goes to the object's GstVideoRegionOfInterestMeta as a structure "classification"
 * (label, confidence, model_name, the box as x_min to y_max in shares of the frame, windows: how
 * many agreed), and with GStreamer 1.24 to its GstAnalytics detection as a classification. With
 * areas=frame what is none of the objects gets a region of its own, whose type is the class. Pixels
 * pass untouched.
 *
 * Each window is judged as OpenCV's CascadeClassifier judges it, but the features are scaled, not
 * the picture. Cascades are XML files in OpenCV's format since 2.4, as Debian's package opencv-data
 * has them in /usr/share/opencv4/haarcascades.
 *
 * |[
 * gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert ! regiontrack !
 *   haardetect cascade=/usr/share/opencv4/haarcascades/haarcascade_fullbody.xml ! regionoverlay !
 *   videoconvert ! autovideosink
 * ]|
 */
#include "core/base/mapping.hpp"
#include "core/detection/detection.hpp"
#include "gst/elements.hpp"
#include "gst/support/cascade_file.hpp"
#include "gst/support/class_metas.hpp"
#include "gst/support/pixel_filter.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace rg {
namespace {

enum class DetectionAreas { Moving, Frame };

GType areasType() {
  static const GEnumValue values[] = {
      {static_cast<int>(DetectionAreas::Moving),
       "Round the objects that mrfmerge sees: for these alone is there a class", "moving"},
      {static_cast<int>(DetectionAreas::Frame), "The whole frame; mrfmerge may be there or not",
       "frame"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionDetectionAreas", values);
  return type;
}

struct Settings : PixelSettings, detection::Params {
  Settings() { analysisHeight = kHeightOfFrame; }  ///< Sizes of things are in pixels of the frame.
  std::string cascade;
  std::string label;
  DetectionAreas areas = DetectionAreas::Moving;
  double areaMargin = .25;
};

constexpr std::array kProperties{
    property<Settings, &Settings::cascade>(
        "cascade",
        "Path of an OpenCV Haar cascade, an XML file in the format since 2.4; a regular file, or a "
        "link to one. Debian's package opencv-data has some in /usr/share/opencv4/haarcascades",
        0, 0, Mutable::Ready),
    property<Settings, &Settings::label>(
        "label",
        "What is said of the objects that the cascade finds; empty = the cascade's file name "
        "without haarcascade_ and .xml"),
    enumProperty<Settings, &Settings::areas>("areas", "Where to look", areasType),
    property<Settings, &Settings::areaMargin>(
        "area-margin",
        "How far round an object areas=moving looks, on each side, as share of the object's height",
        0, 4),
    property<Settings, &Settings::scaleFactor>(
        "scale-factor",
        "From one size of windows to the next; nearer to 1 finds more and is slower", 1.01, 10),
    property<Settings, &Settings::minNeighbours>(
        "min-neighbours",
        "How many windows near a window must agree with it; more make fewer false detections. 0 = "
        "tell each window",
        0, 1000),
    property<Settings, &Settings::minHeightPx>(
        "min-height", "Height of the smallest windows, in pixels; 0 = as the cascade was trained",
        0, 16384),
    property<Settings, &Settings::maxHeightPx>(
        "max-height", "Height of the largest windows, in pixels; 0 = the frame's", 0, 16384),
    threadsProperty<Settings>(),
    statsProperty<Settings>(),
    badBuffersProperty<Settings>(),
};

/// Of a path: what stands between the last slash and the last dot, and in that what is behind
/// "haarcascade_".
std::string modelOf(const std::string& path) {
  const size_t slash = path.rfind('/');
  const std::string file = slash == std::string::npos ? path : path.substr(slash + 1);
  return file.substr(0, file.rfind('.'));
}
std::string classOf(const std::string& model) {
  constexpr std::string_view kPrefix = "haarcascade_";
  return model.rfind(kPrefix, 0) == 0 ? model.substr(kPrefix.size()) : model;
}

/// Structures take no other text.
std::string validText(const std::string& text) {
  gchar* valid = g_utf8_make_valid(text.data(), static_cast<gssize>(text.size()));
  std::string copy = valid;
  g_free(valid);
  return copy;
}

class HaarDetect final : public PixelFilter<Settings, detection::Stage> {
 public:
  explicit HaarDetect(GstBaseTransform* element) : PixelFilter(element, detection::makeStage) {}

  bool start() override {
    const std::string path = currentSettings().cascade;
    if (path.empty()) {
      postError(
          "cascade is not set: give the path of an OpenCV Haar cascade, for instance "
          "/usr/share/opencv4/haarcascades/haarcascade_fullbody.xml of Debian's opencv-data.");
      return false;
    }
    auto cascade = readCascade(path);
    if (!cascade) {
      postError(cascade.error().message);
      return false;
    }
    cascade_ = *std::move(cascade);
    model_ = validText(modelOf(path));
    return PixelFilter::start();
  }
  void stop() override {
    PixelFilter::stop();
    cascade_.reset();
  }

  GstFlowReturn process(const FilterFrame& frame) override {
    const Settings settings = currentSettings();
    const bool isMoving = settings.areas == DetectionAreas::Moving;
    told_ = {};
    areas_.assign(1, boundsOf(sizeOf(frame)));
    if (isMoving) {
      const auto upstream = require<objects::Objects>(frame, "mrfmerge");
      if (!upstream.result) return upstream.flow;
      lookRound(*upstream.result, sizeOf(frame), settings.areaMargin);
    }
    if (!frame.isUsable || areas_.empty()) return GST_FLOW_OK;
    const auto picture = load(frame);
    if (!picture) return skip(picture.error());
    const auto detections = stage().process((*picture)->luma(), areas_, cascade_, settings);
    if (!detections) return skip(detections.error());
    if (detections->isCutShort)
      warnOnce(
          "So many windows see the cascade's class that not all are brought together: raise "
          "min-height, or take a cascade of more stages.");
    told_ = {areas_.size(), detections->found.size(),
             addClasses(frame.buffer, frame.info, *detections, namesOf(settings),
                        isMoving ? Unmatched::Dropped : Unmatched::Added)};
    return GST_FLOW_OK;
  }

 private:
  /// What is hidden can't be seen.
  void lookRound(const objects::Objects& objects, Size frame, double margin) {
    const FrameMap map = mapBetween(objects.size, frame);
    areas_.clear();
    for (const objects::Object& object : objects.objects)
      if (objects::isListed(object.state) && object.state != objects::ObjectState::Occluded)
        areas_.push_back(detection::areaAround(map.box(object.box), margin));
  }

  [[nodiscard]] DetectorNames namesOf(const Settings& settings) const {
    return {settings.label.empty() ? classOf(model_) : validText(settings.label), model_};
  }

  GstFlowReturn skip(const Error& why) {
    countSkipped();
    warnOnce("A frame was skipped: " + why.message + ".");
    return GST_FLOW_OK;
  }

  [[nodiscard]] Progress describe(const FilterFrame&) override {
    std::array<char, 96> text;
    std::snprintf(text.data(), text.size(), "%zu areas, %zu detections, %zu objects with a class",
                  told_.areas, told_.found, told_.objects);
    return {told_.objects, text.data()};
  }

  std::shared_ptr<const detection::Cascade> cascade_;
  std::string model_;
  std::vector<Box> areas_;
  struct Told {
    size_t areas = 0, found = 0, objects = 0;
  };
  Told told_;  ///< Of the latest frame.
};

const Settings kDefaults;
const FilterDescription kDescription{
    .elementName = "haardetect",
    .typeName = "GstHaarDetect",
    .longName = "Haar cascade detection",
    .klass = "Filter/Analyzer/Video",
    .description =
        "Says which objects are what an OpenCV Haar cascade was trained for: adds the class to "
        "their GstVideoRegionOfInterestMeta and GstAnalytics detections; pixels pass untouched. "
        "Looks round the objects of mrfmerge, or with areas=frame everywhere",
    .example =
        "gst-launch-1.0 videotestsrc pattern=ball num-buffers=100 ! video/x-raw,format=I420 ! "
        "regiontrack ! "
        "haardetect cascade=/usr/share/opencv4/haarcascades/haarcascade_fullbody.xml ! "
        "regionwrite ! fakesink",
    .caps = kPixelCaps,
    .properties = kProperties,
    .defaults = &kDefaults,
    .create = [](GstBaseTransform* element) -> Filter* { return new HaarDetect(element); },
};

}  // namespace
}  // namespace rg

GType gst_region_haar_detect_get_type() {
  static const GType type = rg::registerFilter(rg::kDescription);
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(haardetect, "haardetect", GST_RANK_NONE,
                            gst_region_haar_detect_get_type())
