// SPDX-License-Identifier: LGPL-2.1-or-later
// The written formats, read again: whatever a result holds, a line is JSON or has its columns.
#include "core/text/graph.hpp"
#include "core/text/json.hpp"
#include "core/text/mot.hpp"
#include "core/text/regions.hpp"
#include "tests/fuzz/bytes.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

namespace rg::fuzz {
namespace {

Box randomBox(Bytes& bytes) {
  return {bytes.take<int16_t>(), bytes.take<int16_t>(), bytes.take<uint16_t>(),
          bytes.take<uint16_t>()};
}

objects::Object randomObject(uint64_t id, Bytes& bytes) {
  objects::Object object;
  object.id = id;
  object.state = static_cast<objects::ObjectState>(bytes.between(0, 4));
  object.box = randomBox(bytes);
  object.areaPx = bytes.take<uint32_t>();
  object.centroidX = bytes.take<int32_t>();
  object.centroidY = bytes.take<int32_t>();
  object.colour = {bytes.take(), bytes.take(), bytes.take()};
  object.hasSpeed = bytes.flip();
  object.speedX = bytes.take<int32_t>();
  object.speedY = bytes.take<int32_t>();
  object.ageFrames = bytes.take<uint32_t>();
  for (int i = bytes.between(0, 3); i > 0; --i) object.parents.push_back(bytes.take<uint64_t>());
  for (int i = bytes.between(0, 4); i > 0; --i)
    object.contour.push_back({bytes.take<int16_t>(), bytes.take<int16_t>()});
  return object;
}

std::shared_ptr<const graph::Graph> randomGraph(Size size, Bytes& bytes) {
  auto graph = std::make_shared<graph::Graph>();
  graph->size = size;
  graph->status = Status::Ok;
  for (int i = bytes.between(0, 6); i > 0; --i)
    graph->regions.push_back({bytes.take<uint32_t>() % 65536,
                              randomBox(bytes),
                              bytes.take<int32_t>() / 256,
                              bytes.take<int32_t>() / 256,
                              {bytes.take(), bytes.take(), bytes.take()}});
  for (size_t b = 1; b < graph->regions.size(); ++b)
    graph->arcs.push_back({segmentation::RegionLabel::ofIndex(b - 1),
                           segmentation::RegionLabel::ofIndex(b), bytes.between(1u, UINT32_MAX),
                           bytes.take<uint32_t>()});
  return graph;
}

/// One that films, or whatever nine numbers are.
CameraMotion randomCamera(Bytes& bytes) {
  CameraMotion::Matrix matrix = CameraMotion().matrix();
  const bool isReal = bytes.flip();
  for (int64_t& number : matrix)
    number = isReal ? number + bytes.take<int32_t>() / 64 : bytes.take<int64_t>();
  if (bytes.flip()) matrix.back() = CameraMotion::kOne;
  const Point origin = isReal ? Point{bytes.take<uint8_t>(), bytes.take<uint8_t>()}
                              : Point{bytes.take<int32_t>(), bytes.take<int32_t>()};
  return {matrix, origin};
}

objects::Objects randomObjects(Bytes& bytes) {
  objects::Objects objects;
  objects.size = {bytes.between(1, 4096), bytes.between(1, 4096)};
  objects.status = static_cast<Status>(bytes.between(0, 2));
  auto motion = std::make_shared<motion::Motion>();
  motion->size = objects.size;
  motion->graph = randomGraph(objects.size, bytes);
  motion->status = Status::Ok;
  for (size_t i = 0; i < motion->graph->regions.size(); ++i) {
    motion->regions.push_back({bytes.take<int16_t>(), bytes.take<int16_t>(), bytes.take<uint64_t>(),
                               bytes.between<uint16_t>(0, 256)});
    objects.regionObject.push_back(bytes.take<uint64_t>());
    objects.regionExpected.push_back(bytes.take<uint64_t>());
    objects.regionGroup.push_back(objects::GroupIndex::ofIndex(bytes.between(0u, 3u)));
  }
  for (size_t i = 0; i < motion->graph->arcs.size(); ++i) {
    objects::ArcEnergy energy;
    energy.motion = bytes.take<int32_t>();
    energy.border = bytes.take<int32_t>();
    energy.arc = bytes.take<int32_t>();
    energy.prediction = bytes.take<int32_t>();
    objects.arcs.push_back(energy);
  }
  objects.motion = std::move(motion);
  uint64_t id = 0;
  for (int i = bytes.between(0, 5); i > 0; --i)
    objects.objects.push_back(randomObject(id += bytes.take<uint32_t>() + uint64_t{1}, bytes));
  for (int i = bytes.between(0, 4); i > 0; --i)
    objects.events.push_back(
        {static_cast<objects::EventKind>(bytes.between(0, 3)), {bytes.take<uint64_t>()}});
  objects.cameraDx = bytes.take<int32_t>() / 1024;
  objects.cameraDy = bytes.take<int32_t>() / 1024;
  if (bytes.flip()) objects.camera = randomCamera(bytes);
  return objects;
}

text::FrameStamp randomStamp(Bytes& bytes) {
  text::FrameStamp stamp;
  stamp.number = bytes.take<uint64_t>();
  stamp.size = {bytes.between(1, 16384), bytes.between(1, 16384)};
  if (bytes.flip()) stamp.ptsNs = bytes.take<uint64_t>();
  if (bytes.flip()) stamp.utcNs = bytes.take<uint64_t>();
  return stamp;
}

void demandJson(const std::string& line, const char* what) {
  if (nlohmann::json::accept(line)) return;
  std::fprintf(stderr, "no JSON, %s: %s\n", what, line.c_str());
  std::abort();
}

void demandCamera(const std::string& line) {
  const auto camera = nlohmann::json::parse(line)["camera"];
  const bool isUniform = !camera.contains("matrix");
  if (isUniform || (camera["matrix"].size() == 9 && camera["matrix"][8] == 1.0)) return;
  std::fprintf(stderr, "no camera: %s\n", line.c_str());
  std::abort();
}

void demandColumns(const std::string& lines, long columns) {
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);)
    if (std::count(line.begin(), line.end(), ',') + 1 != columns) {
      std::fprintf(stderr, "not %ld columns: %s\n", columns, line.c_str());
      std::abort();
    }
}

}  // namespace
}  // namespace rg::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rg;
  fuzz::Bytes bytes(data, size);
  const objects::Objects objects = fuzz::randomObjects(bytes);
  const text::FrameStamp stamp = fuzz::randomStamp(bytes);
  std::string json, graph, mot, regions;
  text::appendJson(json, objects, stamp, text::Contours::Write);
  text::appendGraph(graph, objects, stamp);
  text::appendMot(mot, objects, stamp);
  text::appendRegions(regions, {objects.motion->graph.get(), objects.motion.get(), &objects},
                      stamp);
  fuzz::demandJson(json, "objects");
  fuzz::demandCamera(json);
  fuzz::demandJson(graph, "graph");
  fuzz::demandColumns(mot, 10);
  fuzz::demandColumns(regions, 13);
  return 0;
}
