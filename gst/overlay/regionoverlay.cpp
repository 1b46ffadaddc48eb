// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-regionoverlay
 * @title: regionoverlay
 *
 * Draws what the elements before it found: objects' boxes with their numbers and states, the ways
 * that they came and go, their outlines, the region graph, and a grid that lies on the ground.
 * Boxes are dashed while an object is hidden and only corners while it has stopped. Lines and
 * letters grow with the frame. A caption, such as the camera's name, may be in any script that the
 * machine has a font for.
 *
 * The drawing is attached as GstVideoOverlayComposition where downstream asks for that in its
 * allocation query (a sink that draws it itself); otherwise it is blended into the frames.
 *
 * It draws what it can from the results that are there: of bgremove for background=black, of srg
 * for the graph, of prmmotion for the regions' vectors, of mrfmerge for all else.
 *
 * |[
 * gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert ! bgremove ! hsvsegment !
 *   srg ! prmmotion ! mrfmerge ! regionoverlay contours=true ! videoconvert ! autovideosink
 * ]|
 */
#include "gst/elements.hpp"
#include "gst/overlay/blackout.hpp"
#include "gst/overlay/painter.hpp"
#include "gst/support/mapped_frame.hpp"
#include "gst/support/stage_filter.hpp"
#include "gst/support/video_map.hpp"

#include <array>

namespace rg {
namespace {

enum class Background : int { Keep, Black };

GType backgroundType() {
  static const GEnumValue values[] = {
      {static_cast<int>(Background::Keep), "The picture as it is", "keep"},
      {static_cast<int>(Background::Black),
       "Black where there is no object, or no foreground where mrfmerge is not there", "black"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionOverlayBackground", values);
  return type;
}

struct Settings : overlay::Views {
  Background background = Background::Keep;
};

constexpr std::array kProperties{
    property<Settings, &Settings::boxes>(
        "boxes",
        "Draw a box around each object: dashed while it is hidden, corners while it has stopped"),
    property<Settings, &Settings::ids>(
        "ids", "Write each object's number, and its state unless it is seen moving"),
    property<Settings, &Settings::trails>("trails", "Draw the way that each object came"),
    property<Settings, &Settings::trailLengthS>("trail-length",
                                                "How far back trails reach, in seconds", 0.1, 600),
    property<Settings, &Settings::contours>("contours", "Draw the outline of each object"),
    property<Settings, &Settings::vectors>(
        "vectors",
        "Draw an arrow to where each object will be in half a second; without mrfmerge, one for "
        "each region that prmmotion is sure of"),
    property<Settings, &Settings::graph>(
        "graph",
        "Draw the region graph: a node for each region, a line for each pair that touches, in the "
        "object's colour where both belong to one"),
    property<Settings, &Settings::grid>(
        "grid",
        "Draw a grid that lies on the ground: it moves as the camera moves the picture, and starts "
        "anew where the scene changes or a square has become three times as large or small"),
    property<Settings, &Settings::scale>(
        "scale", "Size of lines and letters, as a factor of the size that suits the frame's height",
        0.25, 8),
    property<Settings, &Settings::caption>(
        "caption",
        "Text in the left upper corner, such as the camera's name; at most 256 bytes of UTF-8"),
    enumProperty<Settings, &Settings::background>("background", "What becomes of the background",
                                                  backgroundType),
};

/// The results on one frame.
struct Results {
  std::shared_ptr<const background::Foreground> foreground;
  std::shared_ptr<const graph::Graph> graph;
  std::shared_ptr<const motion::Motion> motion;
  std::shared_ptr<const objects::Objects> objects;

  explicit Results(GstBuffer* buffer)
      : foreground(findResult<background::Foreground>(buffer)),
        graph(findResult<graph::Graph>(buffer)),
        motion(findResult<motion::Motion>(buffer)),
        objects(findResult<objects::Objects>(buffer)) {}

  /// Whether any of what is wanted can be drawn.
  [[nodiscard]] bool suffice(const Settings& settings) const {
    return objects || (settings.graph && graph) || (settings.vectors && graph && motion) ||
           (settings.background == Background::Black && foreground);
  }
};

/// The element to add before this one, so that something can be drawn.
const char* missingFor(const Settings& settings) {
  if (settings.any() || settings.grid) return "mrfmerge";
  return settings.graph ? "srg" : "bgremove";
}

bool wantsAnything(const Settings& settings) {
  return settings.any() || settings.graph || settings.grid ||
         settings.background == Background::Black;
}

class RegionOverlay final : public StageFilter {
 public:
  using StageFilter::StageFilter;

  void* settings() override { return &settings_; }

  void reset(Reset what) override {
    if (what != Reset::Gap) painter_.forget();
  }

  GstFlowReturn process(const FilterFrame& frame) override {
    if (frame.isDownstreamNew) attaches_ = downstreamDraws();
    const Settings settings = snapshot(settings_);
    const Results results(frame.buffer);
    if (wantsAnything(settings) && !results.suffice(settings))
      return reportMissing(frame, missingFor(settings));
    if (results.objects) painter_.follow(*results.objects, frame.time.ns, settings.trailLengthS);
    auto drawing = painter_.paint(sceneOf(frame, results), settings);
    if (drawing && attaches_) {
      gst_buffer_add_video_overlay_composition_meta(frame.buffer, drawing.get());
      drawing.reset();
    }
    const bool blackens = settings.background == Background::Black;
    if (drawing || blackens) change(frame, results, blackens, drawing.get());
    return GST_FLOW_OK;
  }

 private:
  /// Asks by itself: the base class queries nothing for elements that work in place.
  [[nodiscard]] bool downstreamDraws() const {
    GstPad* pad = GST_BASE_TRANSFORM_SRC_PAD(element());
    GstCaps* caps = gst_pad_get_current_caps(pad);
    GstQuery* query = gst_query_new_allocation(caps, FALSE);
    const bool draws =
        gst_pad_peer_query(pad, query) &&
        gst_query_find_allocation_meta(query, GST_VIDEO_OVERLAY_COMPOSITION_META_API_TYPE, nullptr);
    gst_query_unref(query);
    if (caps) gst_caps_unref(caps);
    return draws;
  }

  [[nodiscard]] static Size sizeOf(const FilterFrame& frame) {
    return {GST_VIDEO_INFO_WIDTH(&frame.info), GST_VIDEO_INFO_HEIGHT(&frame.info)};
  }

  [[nodiscard]] static overlay::Scene sceneOf(const FilterFrame& frame, const Results& results) {
    overlay::Scene scene;
    scene.frame = sizeOf(frame);
    if (GST_VIDEO_INFO_FPS_N(&frame.info) > 0)
      gst_util_fraction_to_double(GST_VIDEO_INFO_FPS_N(&frame.info),
                                  GST_VIDEO_INFO_FPS_D(&frame.info), &scene.framesPerSecond);
    scene.objects = results.objects.get();
    scene.graph = results.graph.get();
    scene.motion = results.motion.get();
    return scene;
  }

  /// Writes into the frame's pixels; GStreamer copies them first where others hold them too.
  void change(const FilterFrame& frame, const Results& results, bool blackens,
              GstVideoOverlayComposition* drawing) {
    if (const MappedFrame checked(frame.buffer, frame.info); !checked.frame())
      return warnOnce("A frame was passed on as it came: " + checked.frame().error().message + ".");
    VideoMap pixels(frame.buffer, frame.info, GST_MAP_READWRITE);
    if (!pixels.frame())
      return warnOnce("A frame was passed on as it came: its memory can't be written.");
    if (blackens) blacken(results, pixels.frame());
    if (drawing) gst_video_overlay_composition_blend(drawing, pixels.frame());
  }

  void blacken(const Results& results, GstVideoFrame* pixels) {
    keep_.resize({GST_VIDEO_FRAME_WIDTH(pixels), GST_VIDEO_FRAME_HEIGHT(pixels)});
    if (results.objects)
      overlay::markObjects(*results.objects, keep_);
    else if (results.foreground)
      overlay::markForeground(*results.foreground, keep_);
    else
      keep_.fill(0);
    overlay::blacken(pixels, keep_);
  }

  Settings settings_;
  overlay::Painter painter_;
  Image<uint8_t> keep_;
  bool attaches_ = false;  ///< Downstream takes the drawing as a meta.
};

const Settings kDefaults;
const FilterDescription kDescription{
    .elementName = "regionoverlay",
    .typeName = "GstRegionOverlay",
    .longName = "Region and object overlay",
    .klass = "Filter/Editor/Video",
    .description =
        "Draws what the elements before it found: objects' boxes (dashed while hidden, corners "
        "while stopped), numbers, trails, outlines, vectors, the region graph, and a grid on the "
        "ground; can black out the background. Lines and letters grow with the frame. Attached as "
        "overlay composition where downstream draws those, else blended into the frames. Needs "
        "mrfmerge; srg for the graph alone, bgremove for the background alone",
    .example =
        "gst-launch-1.0 videotestsrc pattern=ball num-buffers=100 ! video/x-raw,format=I420 ! "
        "bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! regionoverlay ! videoconvert ! "
        "pngenc ! multifilesink location=objects-%03d.png",
    .caps = kPixelCaps,
    .properties = kProperties,
    .defaults = &kDefaults,
    .create = [](GstBaseTransform* element) -> Filter* { return new RegionOverlay(element); },
};

}  // namespace
}  // namespace rg

GType gst_region_overlay_get_type() {
  static const GType type = rg::registerFilter(rg::kDescription);
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(regionoverlay, "regionoverlay", GST_RANK_NONE,
                            gst_region_overlay_get_type())
