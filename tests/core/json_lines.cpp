// SPDX-License-Identifier: LGPL-2.1-or-later
// Prints what the JSON writers make of results that use every field and every word that they know:
// with the argument "graph" region graphs, otherwise objects. test_schema.py holds the lines
// against the published schemas.
#include "core/text/graph.hpp"
#include "core/text/json.hpp"

#include <cstdint>
#include <iostream>
#include <limits>

namespace rg {
namespace {

objects::Object makeObject(uint64_t id, objects::ObjectState state) {
  objects::Object object;
  object.id = id;
  object.state = state;
  object.box = {static_cast<int>(id) * 7 - 20, -3, 12, 30};
  object.areaPx = static_cast<uint32_t>(id) * 11;
  object.centroidX = 161;
  object.centroidY = -8;
  object.speedX = -4000;
  object.speedY = 1;
  object.hasSpeed = id % 2 == 0;
  object.ageFrames = 1;
  object.colour = {0, 128, 255};
  for (uint64_t parent = 1; parent < id; ++parent) object.parents.push_back(parent);
  object.contour = {{-8, -3}, {3, -3}, {3, 26}};
  return object;
}

objects::Objects makeObjects() {
  objects::Objects objects;
  objects.size = {320, 240};
  objects.status = Status::Ok;
  objects.cameraDx = -5;
  uint64_t id = 0;
  for (const auto state :
       {objects::ObjectState::New, objects::ObjectState::Tracked, objects::ObjectState::Stopped,
        objects::ObjectState::Occluded, objects::ObjectState::Lost})
    objects.objects.push_back(makeObject(++id, state));
  objects.events = {{objects::EventKind::ObjectNew, {1}},
                    {objects::EventKind::ObjectEnd, {5}},
                    {objects::EventKind::Merge, {2, 3}},
                    {objects::EventKind::Split, {3, 4}},
                    {objects::EventKind::SceneChanged, {}}};
  return objects;
}

/// A camera that zooms and rolls.
objects::Objects makeZoom() {
  constexpr int64_t kOne = CameraMotion::kOne;
  objects::Objects objects = makeObjects();
  objects.camera = {{kOne - 7'000'000, 11'000'000, 3 * kOne, -11'000'000, kOne - 7'000'000,
                     -kOne / 3, 10'000, -20'000, kOne},
                    {160, 120}};
  return objects;
}

/// Numbers as far out as their types go.
objects::Objects makeExtremes() {
  objects::Objects objects = makeObjects();
  objects::Object& object = objects.objects[1];
  object.id = std::numeric_limits<uint64_t>::max();
  object.box = {-1'000'000, 1'000'000, 1'000'000, 0};
  object.areaPx = std::numeric_limits<uint32_t>::max();
  object.centroidX = std::numeric_limits<int32_t>::max();
  object.centroidY = std::numeric_limits<int32_t>::min();
  object.speedX = std::numeric_limits<int32_t>::min();
  object.hasSpeed = true;
  return objects;
}

const text::Origin kOrigin{"gate \"3\"\n\\ caf\u00e9", {{"site", "north"}, {"a.b-c_1", "\t"}}};
const text::Origin kTagged{{}, {{"site", ""}}};

constexpr auto kLatest = std::numeric_limits<uint64_t>::max();

/// Three regions: 1 and 2 are merged, 3 moves otherwise.
objects::Objects makeGraph(uint32_t areaPx, int32_t motion, int64_t energy) {
  auto graph = std::make_shared<graph::Graph>();
  graph->regions = {{areaPx, {0, 0, 12, 30}, 1500, 3900, {1, 2, 255}},
                    {areaPx, {12, 0, 1, 1}, 3100, 0, {}},
                    {areaPx, {20, 20, 300, 220}, 43000, 33000, {9, 9, 9}}};
  const auto label = segmentation::RegionLabel::ofNumber;
  graph->arcs = {{label(1), label(2), 1, 255}, {label(2), label(3), areaPx, areaPx}};
  auto regions = std::make_shared<motion::Motion>();
  regions->graph = graph;
  regions->regions = {
      {0, 0, 0, 0}, {motion, -motion, 0, 128}, {-motion, 5, 0, motion::kFullReliability}};
  objects::Objects objects;
  objects.size = {320, 240};
  objects.status = Status::Ok;
  objects.motion = regions;
  const auto group = objects::GroupIndex::ofIndex;
  objects.regionGroup = {group(0), group(0), group(1)};
  objects.regionObject = {7, 7, 0};
  objects.regionExpected = {7, 0, 0};
  objects.arcs = {{0, 256, 256, energy}, {energy, energy / 3, 256, 0}};
  return objects;
}

/// The third region is ground.
objects::Objects makeGrounded(int64_t energy) {
  objects::Objects objects = makeGraph(100, 20, 700);
  objects.groundGroup = objects::GroupIndex::ofIndex(1);
  objects.ground = {{energy, 0}, {-energy, 256}, {-energy, energy}};
  return objects;
}

void printGraphs() {
  std::string out;
  text::appendGraph(out, {}, {1, {1, 1}, {}, {}});
  text::appendGraph(out, makeGraph(100, 20, 700), {2, {320, 240}, 40'000'000, {}});
  text::appendGraph(out, makeGraph(100, 20, 700), {3, {640, 360}, 0, 1'763'722'800'000'000'001});
  text::appendGraph(out, makeGraph(1u << 28, 1024, int64_t{1} << 46),
                    {kLatest, {16384, 16384}, kLatest, kLatest});
  text::appendGraph(out, makeGrounded(700), {4, {320, 240}, 0, {}, &kOrigin});
  text::appendGraph(out, {}, {4, {320, 240}, 0, {}, &kTagged});
  text::appendGraph(out, makeGrounded(int64_t{1} << 46), {5, {320, 240}, 0, {}});
  std::cout << out;
}

void printObjects() {
  using text::Contours;
  std::string out;
  text::appendJson(out, {}, {1, {1, 1}, {}, {}}, Contours::Omit);
  objects::Objects objects = makeObjects();
  for (const auto status : {Status::Ok, Status::Training, Status::Skipped}) {
    objects.status = status;
    text::appendJson(out, objects, {2, {320, 240}, 40'000'000, {}}, Contours::Omit);
    text::appendJson(out, objects, {3, {640, 360}, 0, 1'763'722'800'000'000'001}, Contours::Write);
  }
  text::appendJson(out, objects, {4, {320, 240}, 0, {}, &kOrigin}, Contours::Omit);
  text::appendJson(out, {}, {5, {320, 240}, 0, {}, &kTagged}, Contours::Omit);
  text::appendJson(out, makeZoom(), {6, {320, 240}, 0, {}}, Contours::Omit);
  text::appendJson(out, makeZoom(), {7, {640, 360}, 0, {}, &kTagged}, Contours::Omit);
  text::appendJson(out, makeExtremes(), {kLatest, {16384, 16384}, kLatest, kLatest},
                   Contours::Write);
  std::cout << out;
}

}  // namespace
}  // namespace rg

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "graph")
    rg::printGraphs();
  else
    rg::printObjects();
}
