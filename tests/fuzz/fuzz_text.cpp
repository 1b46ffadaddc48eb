// SPDX-License-Identifier: LGPL-2.1-or-later
// What users write: caps, properties as text, polygons, masks.
#include "core/background/interest.hpp"
#include "tests/fuzz/gst_target.hpp"
#include "tests/fuzz/moving_scene.hpp"
#include "tests/fuzz/set_property.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace rg::fuzz {
namespace {

using testing::Chain;

constexpr int64_t kMostPixels = 512 * 512;  // Larger frames are negotiated but not sent.

/// Sends a frame of caps that nobody may have meant seriously.
void tryCaps(Bytes& bytes) {
  constexpr const char* kChains[] = {"bgremove threads=1", "hsvsegment threads=1",
                                     "regiontrack threads=1", "regionoverlay", "regionmask"};
  Chain chain(bytes.pick(kChains));
  const std::string text = "video/x-raw," + bytes.text(200);
  // GStreamer's own parser is critical of some texts.
  g_log_set_default_handler(g_log_default_handler, nullptr);
  GstCaps* caps = gst_caps_from_string(text.c_str());
  g_log_set_default_handler(abortOnCritical, nullptr);
  if (!caps) return;
  if (gst_caps_is_fixed(caps) && gst_caps_get_size(caps) == 1) {
    GstVideoInfo info;
    const bool isVideo = gst_video_info_from_caps(&info, caps) != FALSE;
    gst_harness_set_src_caps(chain.harness(), gst_caps_ref(caps));
    const int64_t pixels = isVideo ? int64_t{info.width} * info.height : 0;
    const bool isPaintable = isVideo && pixels > 0 && pixels <= kMostPixels &&
                             info.size < 16 * kMostPixels &&
                             GST_VIDEO_INFO_FORMAT(&info) != GST_VIDEO_FORMAT_ENCODED;
    for (int i = 0; i < 2; ++i) {
      testing::BufferPtr buffer(gst_buffer_new_allocate(nullptr, isPaintable ? info.size : 64, {}));
      gst_buffer_memset(buffer.get(), 0, 90, gst_buffer_get_size(buffer.get()));
      chain.push(std::move(buffer));
    }
  }
  gst_caps_unref(caps);
}

/// Sets any property of any element to any text, as gst-launch does.
void trySetting(Bytes& bytes) {
  constexpr const char* kFactories[] = {"bgremove",      "hsvsegment", "srg",        "prmmotion",
                                        "mrfmerge",      "regionmask", "regiontext", "regionwrite",
                                        "regionoverlay", "regiontrack"};
  Chain chain(bytes.pick(kFactories));
  std::vector<GstElement*> elements;
  listElements(chain.harness()->element, elements);
  for (int i = bytes.between(1, 4); i > 0; --i) {
    GstElement* element = bytes.pick(elements);
    guint count = 0;
    GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
    const GParamSpec* spec = specs[bytes.between(0u, count - 1)];
    const bool isSafe =
        (spec->flags & G_PARAM_WRITABLE) != 0 && (spec->flags & G_PARAM_CONSTRUCT_ONLY) == 0 &&
        std::string_view(spec->name) != "location" && std::string_view(spec->name) != "threads" &&
        !g_type_is_a(spec->value_type, G_TYPE_OBJECT);
    if (isSafe) gst_util_set_object_arg(G_OBJECT(element), spec->name, randomText(bytes).c_str());
    g_free(specs);
  }
  const MovingScene scene = MovingScene::from(bytes);
  chain.push(paintScene(scene, chain.caps().info()));
}

void tryPolygons(Bytes& bytes) {
  const Size size{bytes.between(1, 200), bytes.between(1, 200)};
  const auto text = bytes.rest();
  const auto polygons =
      background::parsePolygons({reinterpret_cast<const char*>(text.data()), text.size()});
  if (!polygons) {
    if (polygons.error().message.empty()) std::abort();
    return;
  }
  Image<uint8_t> interest(size);
  interest.fill(1);
  background::drawInterest(*polygons, {}, interest);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (interest.at(x, y) != 0 && interest.at(x, y) != background::kInside) std::abort();
}

/// A file as the mask of an element that is running, and of one that starts with it.
void tryMask(Bytes& bytes) {
  static const std::string path =
      std::filesystem::temp_directory_path() / ("mask-" + std::to_string(getpid()));
  static const struct Remover {
    ~Remover() { std::filesystem::remove(path); }
  } remover;
  const auto content = bytes.rest();
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(content.data()),
             static_cast<std::streamsize>(content.size()));
  Chain chain("bgremove threads=1 name=element");
  GstElement* element = chain.element("bgremove");
  Bytes none(nullptr, 0);
  const MovingScene scene = MovingScene::from(none);
  chain.push(paintScene(scene, chain.caps().info()));
  g_object_set(element, "mask", path.c_str(), nullptr);
  chain.push(paintScene(scene, chain.caps().info()));
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_state(element, GST_STATE_PLAYING);
  gst_object_unref(element);
}

}  // namespace
}  // namespace rg::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  rg::fuzz::Bytes bytes(data, size);
  using Trial = void (*)(rg::fuzz::Bytes&);
  constexpr Trial kTrials[] = {rg::fuzz::tryCaps, rg::fuzz::trySetting, rg::fuzz::tryPolygons,
                               rg::fuzz::tryMask};
  bytes.pick(kTrials)(bytes);
  return 0;
}
