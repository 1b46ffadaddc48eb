// SPDX-License-Identifier: LGPL-2.1-or-later
// Metas that don't belong together: of other frames and sizes, copied, scaled, cropped, some of
// them missing, read by the elements that read metas only.
#include "gst/meta/result_meta.hpp"
#include "tests/fuzz/gst_target.hpp"
#include "tests/fuzz/moving_scene.hpp"
#include "tests/fuzz/read_metas.hpp"
#include "tests/fuzz/set_property.hpp"

#include <algorithm>
#include <array>

namespace rg::fuzz {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;

/// Behind mrfmerge all results are packed; stages need others.
constexpr const char* kProducers[] = {
    "regiontrack threads=1",
    "hsvsegment threads=1 ! srg threads=1 ! prmmotion threads=1 ! mrfmerge threads=1",
    ("bgremove threads=1 training-frames=2 ! hsvsegment threads=1 ! srg threads=1 ! "
     "prmmotion threads=1"),
    "hsvsegment threads=1 ! srg threads=1 ! prmmotion threads=1",
};
constexpr const char* kReaders[] = {
    "regionoverlay trails=true contours=true vectors=true graph=true grid=true",
    "regionmask source=objects",
    "regionmask source=labels",
    "regionmask source=foreground",
    "regionmask source=hue",
    "regionwrite location=/dev/null contours=true",
    "regionwrite location=/dev/null format=graph",
    "regionwrite location=/dev/null format=regions",
    "regiontext contours=true",
    "mrfmerge threads=1",
    "prmmotion threads=1",
    "srg threads=1",
    "hsvsegment threads=1 scope=foreground",
};
constexpr int kSides[] = {1, 7, 16, 33, 64, 90};
constexpr size_t kResults = 4;

/// Frames with results, of some sizes.
std::vector<BufferPtr> makeSources(Bytes& bytes) {
  std::vector<BufferPtr> sources;
  for (size_t s = 0; s < kResults; ++s) {
    const Caps caps{"GRAY8", bytes.pick(kSides), bytes.pick(kSides)};
    Chain chain(bytes.pick(kProducers), caps);
    MovingScene scene = MovingScene::from(bytes);
    for (int i = bytes.between(1, 6); i > 0; --i) {
      BufferPtr out = chain.pass(paintScene(scene, caps.info()));
      scene.advance();
      if (i == 1 && out) sources.push_back(std::move(out));
    }
  }
  return sources;
}

template <class Payload>
void borrow(GstBuffer* to, GstBuffer* from, Bytes& bytes) {
  if (bytes.flip()) return;
  if (auto result = findResult<Payload>(from)) attachResult<Payload>(to, std::move(result));
}

/// A buffer as a transforming element would hand it on.
BufferPtr transformed(GstBuffer* source, Bytes& bytes) {
  switch (bytes.between(0, 3)) {
    case 0:
      return BufferPtr(gst_buffer_copy(source));
    case 1: {
      const gsize size = gst_buffer_get_size(source);
      const gsize offset = bytes.between<gsize>(0, std::min<gsize>(size, 255));
      return BufferPtr(gst_buffer_copy_region(source, GST_BUFFER_COPY_ALL, offset,
                                              bytes.between<gsize>(0, size - offset)));
    }
    case 2:
      return BufferPtr(gst_buffer_copy_deep(source));
    default:
      return BufferPtr(gst_buffer_ref(source));
  }
}

void run(Bytes& bytes) {
  const std::vector<BufferPtr> sources = makeSources(bytes);
  if (sources.empty()) return;
  const Caps caps{"BGRx", bytes.pick(kSides), bytes.pick(kSides)};
  Chain chain(bytes.pick(kReaders), caps);
  MovingScene scene = MovingScene::from(bytes);
  for (int i = bytes.between(1, 8); i > 0; --i) {
    BufferPtr buffer = paintScene(scene, caps.info());
    scene.advance();
    borrow<background::Foreground>(buffer.get(), bytes.pick(sources).get(), bytes);
    borrow<segmentation::Labels>(buffer.get(), bytes.pick(sources).get(), bytes);
    borrow<graph::Graph>(buffer.get(), bytes.pick(sources).get(), bytes);
    borrow<motion::Motion>(buffer.get(), bytes.pick(sources).get(), bytes);
    borrow<objects::Objects>(buffer.get(), bytes.pick(sources).get(), bytes);
    if (bytes.flip()) addRandomRois(buffer.get(), bytes);
    readMetas(buffer.get());
    const BufferPtr copy = transformed(buffer.get(), bytes);
    if (copy) readMetas(copy.get());
    if (const BufferPtr out = chain.pass(std::move(buffer))) readMetas(out.get());
  }
}

}  // namespace
}  // namespace rg::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  rg::fuzz::Bytes bytes(data, size);
  rg::fuzz::run(bytes);
  return 0;
}
