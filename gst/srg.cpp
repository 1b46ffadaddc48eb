// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-srg
 * @title: srg
 *
 * Makes the spatial region graph of hsvsegment's regions: a node for each region with its area,
 * box, centroid and colour, an arc for each pair that touches.
 *
 * |[
 * gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert ! bgremove ! hsvsegment ! srg
 * ! prmmotion ! mrfmerge ! regionoverlay ! videoconvert ! autovideosink
 * ]|
 */
#include "core/graph/graph.hpp"
#include "core/text/text.hpp"
#include "gst/elements.hpp"
#include "gst/support/stage_filter.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace rg {
namespace {

GType connectivityType() {
  static const GEnumValue values[] = {
      {static_cast<int>(Connectivity::Four), "Regions touch along the sides of pixels", "4"},
      {static_cast<int>(Connectivity::Eight), "Regions touch also at the corners of pixels", "8"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionConnectivity", values);
  return type;
}

struct Settings : StageSettings, graph::Params, BackendSettings {};

constexpr std::array kProperties{
    enumProperty<Settings, &Settings::connectivity>(
        "connectivity", "Which pixels count as neighbours across a border", connectivityType),
    threadsProperty<Settings>(),
    backendProperty<Settings>(),
    deviceIdProperty<Settings>(),
    activeBackendProperty<Settings>(),
    statsProperty<Settings>(),
};

class Srg final : public ChainedFilter<Settings, graph::Stage, segmentation::Labels> {
 public:
  explicit Srg(GstBaseTransform* element)
      : ChainedFilter(element, graph::makeStage, "hsvsegment") {}

 private:
  void handle(const FilterFrame& frame, std::shared_ptr<const segmentation::Labels> labels,
              const Settings& settings) override {
    checkOrder<motion::Motion, objects::Objects>(frame);
    if (labels)
      attach<graph::Graph>(frame, stage().process(std::move(labels), settings));
    else
      attachSkipped<graph::Graph>(frame);
  }

  [[nodiscard]] Progress describe(const FilterFrame& frame) override {
    const auto graph = findResult<graph::Graph>(frame.buffer);
    if (!graph) return {};
    std::array<char, 80> text;
    std::snprintf(text.data(), text.size(), "%s, %zu regions, %zu pairs that touch",
                  text::name(graph->status).data(), graph->regions.size(), graph->arcs.size());
    return {static_cast<uint64_t>(graph->status), text.data()};
  }
};

const Settings kDefaults;
const FilterDescription kDescription{
    .elementName = "srg",
    .typeName = "GstSrg",
    .longName = "Spatial region graph",
    .klass = "Filter/Analyzer/Video",
    .description =
        "Describes the regions of hsvsegment by area, box, centroid and colour, and which "
        "of them touch along how long a border. Attaches this graph to each buffer as a "
        "meta; pixels pass untouched. Third of the five stages, needs hsvsegment",
    .example =
        "gst-launch-1.0 videotestsrc pattern=ball num-buffers=100 ! "
        "video/x-raw,format=I420 ! hsvsegment ! srg ! prmmotion ! regionwrite "
        "format=regions ! fakesink",
    .caps = kMetaCaps,
    .properties = kProperties,
    .defaults = &kDefaults,
    .create = [](GstBaseTransform* element) -> Filter* { return new Srg(element); },
};

}  // namespace
}  // namespace rg

GType gst_region_srg_get_type() {
  static const GType type = rg::registerFilter(rg::kDescription);
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(srg, "srg", GST_RANK_NONE, gst_region_srg_get_type())
