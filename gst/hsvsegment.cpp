// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-hsvsegment
 * @title: hsvsegment
 *
 * Divides the picture, or the foreground that bgremove found, into regions of one colour and
 * attaches the number of its region to every pixel; the pixels themselves pass untouched. Regions
 * grow by red, green and blue; colour-space=hsv lets them grow by hue, saturation and value, as the
 * paper does.
 *
 * |[
 * gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert ! hsvsegment max-regions=160
 * ! regionmask source=labels ! pngenc ! multifilesink location=labels-%06d.png
 * ]|
 */
#include "core/base/mapping.hpp"
#include "core/segmentation/segmentation.hpp"
#include "core/text/text.hpp"
#include "gst/elements.hpp"
#include "gst/support/pixel_filter.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <tuple>
#include <utility>

namespace rg {
namespace {

/// As the user asks for it; the stage knows only what it comes to.
enum class ScopeChoice : int { Auto, Frame, Foreground, Areas };

GType scopeType() {
  static const GEnumValue values[] = {
      {static_cast<int>(ScopeChoice::Auto),
       "The foreground where bgremove is upstream, else the whole frame", "auto"},
      {static_cast<int>(ScopeChoice::Frame), "The whole frame: for moving cameras", "frame"},
      {static_cast<int>(ScopeChoice::Foreground),
       "What bgremove marked as foreground, and gaps in it where no colour ends", "foreground"},
      {static_cast<int>(ScopeChoice::Areas),
       "The boxes of bgremove's areas and 4 to 11 pixels around: only their pixels are converted "
       "and labelled",
       "areas"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionScopeChoice", values);
  return type;
}

GType colourSpaceType() {
  static const GEnumValue values[] = {
      {static_cast<int>(segmentation::ColourSpace::Rgb),
       "Red, green and blue as the video holds them (R'G'B')", "rgb"},
      {static_cast<int>(segmentation::ColourSpace::Hsv),
       "Hue, in 256ths of the colour circle, saturation and value, as the paper does; pixels too "
       "grey for a hue go by the other two",
       "hsv"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionColourSpace", values);
  return type;
}

struct Settings : PixelSettings, segmentation::Params, BackendSettings {
  ScopeChoice scopeChoice = ScopeChoice::Auto;
  std::string backgroundHue;
  std::string objectHue;
};

constexpr std::array kProperties{
    enumProperty<Settings, &Settings::scopeChoice>(
        "scope",
        "Which pixels are divided into regions; auto is decided on the first frame, but for frames "
        "in "
        "which bgremove tells that the camera moves: of these it is the whole",
        scopeType),
    property<Settings, &Settings::similarity>(
        "similarity",
        "Largest difference between neighbouring pixels of one region, in grey levels of a channel "
        "of the smoothed picture. Lower gives more and smaller regions",
        0, 254),
    enumProperty<Settings, &Settings::space>(
        "colour-space",
        "The channels by whose largest difference pixels grow into a region; what is smaller than "
        "min-area is absorbed by R'G'B' in either case",
        colourSpaceType),
    property<Settings, &Settings::minAreaPx>(
        "min-area",
        "Regions with fewer pixels of the frame are absorbed by the neighbour most like them; 0 = "
        "1/1200 of the pixels that are looked at, at least 32",
        0, 1 << 24),
    property<Settings, &Settings::maxRegions>(
        "max-regions", "Never more regions than this; the smallest are absorbed first", 1, 65535),
    property<Settings, &Settings::backgroundHue>(
        "background-hue",
        "Hues of the background: pixels of these get no region, those of other hues are objects, "
        "and those without colour follow bgremove's foreground. auto = round the peak of the "
        "frame's hue histogram; FROM-TO in degrees (0 red, 120 green, 240 blue), as 80-160; empty "
        "= "
        "hue decides nothing"),
    property<Settings, &Settings::objectHue>(
        "object-hue",
        "Hues of the things to follow: only pixels of these get a region. FROM-TO in degrees, as "
        "350-10 for red; empty = all hues"),
    analysisHeightProperty<Settings>(),
    threadsProperty<Settings>(),
    backendProperty<Settings>(),
    deviceIdProperty<Settings>(),
    activeBackendProperty<Settings>(),
    statsProperty<Settings>(),
    badBuffersProperty<Settings>(),
};

class HsvSegment final : public PixelFilter<Settings, segmentation::Stage> {
 public:
  explicit HsvSegment(GstBaseTransform* element) : PixelFilter(element, segmentation::makeStage) {}

  bool start() override {
    hueText_ = inForce_ = {};
    hue_ = {};
    if (const auto read = followHue(currentSettings()); !read) {
      postError(read.error().message);
      return false;
    }
    return PixelFilter::start();
  }

  GstFlowReturn process(const FilterFrame& frame) override {
    checkOrder<graph::Graph, motion::Motion, objects::Objects>(frame);
    Settings settings = currentSettings();
    if (const auto read = followHue(settings); !read) {
      postWarning(read.error().message + "; what was set before stays in use");
      putBack(settings);
    }
    settings.hue = hue_;
    if (frame.isFirst)
      autoScope_ = findResult<background::Foreground>(frame.buffer)
                       ? segmentation::Scope::Foreground
                       : segmentation::Scope::Frame;
    settings.scope = scopeOf(settings.scopeChoice, frame);
    if (settings.scope != segmentation::Scope::Frame) return divideForeground(frame, settings);
    divideFrame(frame, settings);
    return GST_FLOW_OK;
  }

 private:
  /// Reads the hues where they are not those of the last call; an error is told once, and what was
  /// read before stays.
  Result<bool> followHue(const Settings& settings) {
    std::pair text{settings.backgroundHue, settings.objectHue};
    if (text == hueText_) return true;
    const auto rules = segmentation::parseHueRules(text.first, text.second);
    hueText_ = std::move(text);
    if (!rules) return rules.error();
    hue_ = *rules;
    inForce_ = hueText_;
    return true;
  }

  /// Where hues can't be read, the properties go back to those in use.
  void putBack(const Settings& refused) {
    const std::lock_guard lock(settingsMutex());
    if (settings_.backgroundHue != refused.backgroundHue) return;
    if (settings_.objectHue != refused.objectHue) return;
    std::tie(settings_.backgroundHue, settings_.objectHue) = inForce_;
  }

  [[nodiscard]] segmentation::Scope scopeOf(ScopeChoice choice, const FilterFrame& frame) const {
    switch (choice) {
      case ScopeChoice::Frame:
        return segmentation::Scope::Frame;
      case ScopeChoice::Foreground:
        return segmentation::Scope::Foreground;
      case ScopeChoice::Areas:
        return segmentation::Scope::Areas;
      case ScopeChoice::Auto:
        break;
    }
    const auto foreground = findResult<background::Foreground>(frame.buffer);
    const bool isCameraMoving = foreground && foreground->scene.isCameraMoving;
    return isCameraMoving ? segmentation::Scope::Frame : autoScope_;
  }

  GstFlowReturn divideForeground(const FilterFrame& frame, const Settings& settings) {
    auto upstream = requireUnpacked<background::Foreground>(frame, "bgremove");
    if (upstream.flow != GST_FLOW_OK) return upstream.flow;
    if (upstream.result && upstream.result->picture)
      divide(frame, upstream.result->picture, upstream.result, settings);
    else
      attachSkipped<segmentation::Labels>(frame);
    return GST_FLOW_OK;
  }

  void divideFrame(const FilterFrame& frame, const Settings& settings) {
    const auto foreground = findResult<background::Foreground>(frame.buffer);
    if (!frame.isUsable) {
      attachSkipped<segmentation::Labels>(frame);
    } else if (foreground && foreground->picture) {
      divide(frame, foreground->picture, foreground, settings);
    } else if (auto picture = load(frame)) {
      divide(frame, *picture, nullptr, settings);
    } else {
      attach<segmentation::Labels>(frame, picture.error());
    }
  }

  /// What bgremove has looked at.
  [[nodiscard]] Size analysedSize(const FilterFrame& frame) const override {
    const auto foreground = findResult<background::Foreground>(frame.buffer);
    return foreground && !foreground->size.isEmpty() ? foreground->size
                                                     : PixelFilter::analysedSize(frame);
  }

  void divide(const FilterFrame& frame, std::shared_ptr<const Picture> picture,
              std::shared_ptr<const background::Foreground> foreground, const Settings& settings) {
    segmentation::Params params = settings;
    if (params.minAreaPx > 0) {
      const FrameMap toPicture = mapBetween(sizeOf(frame), picture->size());
      params.minAreaPx = static_cast<int>(std::max<int64_t>(toPicture.area(params.minAreaPx), 1));
    }
    attach<segmentation::Labels>(
        frame, stage().process(std::move(picture), std::move(foreground), params));
  }

  [[nodiscard]] Progress describe(const FilterFrame& frame) override {
    const auto labels = findResult<segmentation::Labels>(frame.buffer);
    if (!labels) return {};
    constexpr std::array kScopes{"the frame", "the foreground", "the areas"};
    const auto scope = static_cast<size_t>(labels->scope);
    std::array<char, 120> text;
    std::snprintf(text.data(), text.size(), "%s, %u regions in %s, at most %d allowed",
                  text::name(labels->status).data(), labels->count, kScopes[scope],
                  currentSettings().maxRegions);
    return {static_cast<uint64_t>(labels->status) * 8 + scope, text.data()};
  }

  segmentation::Scope autoScope_ = segmentation::Scope::Frame;
  std::pair<std::string, std::string> hueText_;  ///< As last asked for.
  std::pair<std::string, std::string> inForce_;
  segmentation::HueRules hue_;
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
        "scope=foreground and scope=areas. Frames have at most 35389440 pixels (8192x4320)",
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
