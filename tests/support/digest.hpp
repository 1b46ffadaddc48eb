// SPDX-License-Identifier: LGPL-2.1-or-later
// All that readers see of a result as one number.
#pragma once

#include "core/objects/objects.hpp"
#include "core/text/graph.hpp"
#include "core/text/json.hpp"

#include <cstdint>
#include <string_view>
#include <type_traits>

namespace rg::testing {

class Digest {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) value_ = (value_ ^ static_cast<uint8_t>(byte)) * 1099511628211u;
  }
  template <class Number>
  requires(std::is_arithmetic_v<Number> || std::is_enum_v<Number>) void add(Number number) {
    add({reinterpret_cast<const char*>(&number), sizeof number});
  }
  template <class Pixel>
  void add(const ResultPlane<Pixel>& pixels) {
    Image<Pixel> scratch;
    const ImageView<const Pixel> plane = pixels.unpacked(scratch);
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) add(plane.at(x, y));
  }
  [[nodiscard]] uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 14695981039346656037u;
};

inline uint64_t digestOf(const background::Foreground& result) {
  Digest digest;
  digest.add(result.status);
  digest.add(result.mask);
  digest.add(result.scene.event);
  digest.add(result.scene.foregroundPx);
  for (const Box& area : result.areas)
    for (const int side : {area.x, area.y, area.width, area.height}) digest.add(side);
  return digest.value();
}

inline uint64_t digestOf(const segmentation::Labels& result) {
  Digest digest;
  digest.add(result.status);
  digest.add(result.scope);
  digest.add(result.count);
  digest.add(result.ids);
  return digest.value();
}

inline uint64_t digestOf(const graph::Graph& result) {
  Digest digest;
  digest.add(result.status);
  for (const graph::Region& region : result.regions)
    for (const int value : {region.box.x, region.box.width, region.centroidX, region.centroidY,
                            static_cast<int>(region.areaPx), int{region.colour.red}})
      digest.add(value);
  for (const graph::Arc& arc : result.arcs)
    for (const uint32_t value :
         {uint32_t{arc.a.number()}, uint32_t{arc.b.number()}, arc.borderPx, arc.contrast})
      digest.add(value);
  for (const Run& run : result.runs.list)
    for (const uint16_t value : {run.y, run.begin, run.end}) digest.add(value);
  return digest.value();
}

inline uint64_t digestOf(const motion::Motion& result) {
  Digest digest;
  digest.add(result.status);
  for (const motion::RegionMotion& region : result.regions) {
    digest.add(region.dx);
    digest.add(region.dy);
    digest.add(region.sad);
    digest.add(region.reliability);
  }
  return digest.value();
}

inline uint64_t digestOf(const objects::Objects& result) {
  std::string text;
  const text::FrameStamp stamp{1, result.size, {}, {}};
  text::appendJson(text, result, stamp, text::Contours::Write);
  text::appendGraph(text, result, stamp);
  Digest digest;
  digest.add(text);
  digest.add(result.slots);
  for (const uint64_t id : result.regionObject) digest.add(id);
  return digest.value();
}

}  // namespace rg::testing
