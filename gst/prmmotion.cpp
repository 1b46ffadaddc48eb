// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-prmmotion
 * @title: prmmotion
 *
 * Finds by how much each region moved since the previous frame: partitioned region matching, by the
 * least sum of absolute differences of every shift within max-shift. Sums are not taken where a
 * bound shows that they are not the least: the vectors are those of the exhaustive search.
 *
 * |[
 * gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert ! hsvsegment ! srg !
 *   prmmotion max-shift=32 ! regionwrite format=regions location=regions.csv ! fakesink
 * ]|
 */
#include "core/base/mapping.hpp"
#include "core/motion/motion.hpp"
#include "core/text/text.hpp"
#include "gst/elements.hpp"
#include "gst/support/stage_filter.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace rg {
namespace {

GType methodType() {
  static const GEnumValue values[] = {
      {static_cast<int>(motion::Method::Refined),
       "Pixels away from the regions' borders, fractions of a pixel, and the neighbours' say where "
       "a region tells little",
       "refined"},
      {static_cast<int>(motion::Method::Literal),
       "As the paper says: the sums of absolute differences over all of a region's pixels, whole "
       "pixels, no neighbours. Slow",
       "literal"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionMotionMethod", values);
  return type;
}

struct Settings : StageSettings, motion::Params, BackendSettings {};

constexpr std::array kProperties{
    property<Settings, &Settings::maxShiftPx>(
        "max-shift",
        "Largest motion between two frames that is searched, in pixels of the frame along each "
        "axis, up to 64 of the picture that is looked at. The best shift of all is found; 64 takes "
        "about twice as long as 20. 0 = as far as a thing gets that crosses the frame's height in "
        "a second, at least 20; with method=literal 20",
        0, 64),
    property<Settings, &Settings::isSubpixel>(
        "subpixel",
        "Refine vectors to 1/16 pixel; otherwise, and with method=literal, they are whole pixels"),
    enumProperty<Settings, &Settings::method>("method", "How regions are matched", methodType),
    threadsProperty<Settings>(),
    backendProperty<Settings>(),
    deviceIdProperty<Settings>(),
    activeBackendProperty<Settings>(),
    statsProperty<Settings>(),
};

class PrmMotion final : public ChainedFilter<Settings, motion::Stage, graph::Graph> {
 public:
  explicit PrmMotion(GstBaseTransform* element)
      : ChainedFilter(element, motion::makeStage, "srg") {}

 private:
  void handle(const FilterFrame& frame, std::shared_ptr<const graph::Graph> graph,
              const Settings& settings) override {
    checkOrder<objects::Objects>(frame);
    if (!graph) return attachSkipped<motion::Motion>(frame);
    motion::Params params = settings;
    if (params.maxShiftPx > 0) {
      const FrameMap toPicture = mapBetween(sizeOf(frame), graph->size);
      params.maxShiftPx = static_cast<int>(std::max<int64_t>(toPicture.y(params.maxShiftPx), 1));
    }
    attach<motion::Motion>(frame, stage().process(std::move(graph), params, frame.time));
  }

  [[nodiscard]] Progress describe(const FilterFrame& frame) override {
    const auto motion = findResult<motion::Motion>(frame.buffer);
    if (!motion) return {};
    const auto moving = std::count_if(
        motion->regions.begin(), motion->regions.end(),
        [](const motion::RegionMotion& region) { return region.dx != 0 || region.dy != 0; });
    std::array<char, 120> text;
    std::snprintf(text.data(), text.size(), "%s, %zu regions, %td of them move, %.0f %% searched",
                  text::name(motion->status).data(), motion->regions.size(), moving,
                  100.0 * (motion->matchedBlocks - motion->stillBlocks) /
                      std::max(motion->matchedBlocks, 1u));
    return {static_cast<uint64_t>(motion->status), text.data()};
  }
};

const Settings kDefaults;
const FilterDescription kDescription{
    .elementName = "prmmotion",
    .typeName = "GstPrmMotion",
    .longName = "Region motion",
    .klass = "Filter/Analyzer/Video",
    .description =
        "Finds by how much each region of the graph moved since the previous frame, by "
        "the smallest sum of absolute differences over all shifts within max-shift, and "
        "how reliable that is. Attaches the vectors to each buffer as a meta; pixels pass "
        "untouched. Fourth of the five stages, needs srg",
    .example =
        "gst-launch-1.0 videotestsrc pattern=ball num-buffers=100 ! "
        "video/x-raw,format=I420 ! hsvsegment ! srg ! prmmotion max-shift=32 ! "
        "regionwrite format=regions ! fakesink",
    .caps = kMetaCaps,
    .properties = kProperties,
    .defaults = &kDefaults,
    .create = [](GstBaseTransform* element) -> Filter* { return new PrmMotion(element); },
};

}  // namespace
}  // namespace rg

GType gst_region_prmmotion_get_type() {
  static const GType type = rg::registerFilter(rg::kDescription);
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(prmmotion, "prmmotion", GST_RANK_NONE, gst_region_prmmotion_get_type())
