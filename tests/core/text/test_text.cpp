// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/graph.hpp"
#include "core/text/json.hpp"
#include "core/text/line.hpp"
#include "core/text/mot.hpp"
#include "core/text/names.hpp"
#include "core/text/regions.hpp"

#include <gtest/gtest.h>

#include <locale>
#include <string>

namespace rg::text {
namespace {

std::string fixed(int64_t numerator, int64_t denominator, int decimals) {
  std::string out;
  appendFixed(out, numerator, denominator, decimals);
  return out;
}

std::string utc(uint64_t ns) {
  std::string out;
  appendUtc(out, ns);
  return out;
}

TEST(Fixed, RoundsHalvesAwayFromZero) {
  EXPECT_EQ(fixed(1, 16, 2), "0.06");
  EXPECT_EQ(fixed(5, 16, 2), "0.31");
  EXPECT_EQ(fixed(1, 8, 2), "0.13");
  EXPECT_EQ(fixed(-1, 8, 2), "-0.13");
  EXPECT_EQ(fixed(-33, 16, 4), "-2.0625");
}

TEST(Fixed, KeepsZerosBehindThePoint) {
  EXPECT_EQ(fixed(16, 16, 2), "1.00");
  EXPECT_EQ(fixed(1, 1000, 3), "0.001");
  EXPECT_EQ(fixed(100'001, 100'000, 5), "1.00001");
}

TEST(Fixed, ZeroHasNoSign) {
  EXPECT_EQ(fixed(-1, 1000, 2), "0.00");
  EXPECT_EQ(fixed(0, 16, 1), "0.0");
}

TEST(Utc, WritesEveryDigit) {
  EXPECT_EQ(utc(0), "1970-01-01T00:00:00.000000000Z");
  EXPECT_EQ(utc(1'709'164'800'000'000'007), "2024-02-29T00:00:00.000000007Z");
  EXPECT_EQ(utc(UINT64_MAX), "2554-07-21T23:34:33.709551615Z");
}

objects::Objects twoObjects() {
  objects::Objects objects;
  objects.size = {320, 240};
  objects.status = Status::Ok;
  objects.cameraDx = -8;
  objects::Object walking;
  walking.id = 3;
  walking.state = objects::ObjectState::Tracked;
  walking.box = {-2, 10, 20, 40};
  walking.areaPx = 500;
  walking.centroidX = 8 * 16 + 4;
  walking.centroidY = 30 * 16;
  walking.speedX = 25 * 16 + 8;
  walking.speedY = -1;
  walking.hasSpeed = true;
  walking.ageFrames = 12;
  walking.colour = {255, 16, 7};
  walking.parents = {1, 2};
  walking.contour = {{0, 10}, {17, 10}, {17, 49}};
  objects::Object hidden;
  hidden.id = 4;
  hidden.state = objects::ObjectState::Occluded;
  hidden.box = {100, 100, 10, 10};
  hidden.centroidX = 105 * 16;
  hidden.centroidY = 105 * 16;
  hidden.ageFrames = 2;
  objects.objects = {walking, hidden};
  return objects;
}

std::string json(const objects::Objects& objects, const FrameStamp& stamp,
                 Contours contours = Contours::Omit) {
  std::string out;
  appendJson(out, objects, stamp, contours);
  return out;
}

TEST(Json, WritesAFrameInOneLine) {
  objects::Objects objects = twoObjects();
  objects.events = {{objects::EventKind::ObjectNew, {4}}, {objects::EventKind::Split, {3, 4}}};
  EXPECT_EQ(json(objects, {7, {320, 240}, 240'000'000, {}}),
            R"({"schema":"1.0","frame":7,"pts":240000000,"status":"ok",)"
            R"("resolution":{"width":320,"height":240},"camera":{"x":-0.50,"y":0.00},"objects":[)"
            R"({"id":3,"state":"tracked","x":-2,"y":10,"w":20,"h":40,)"
            R"("centroid":{"x":8.25,"y":30.00},"area":500,"velocity":{"x":25.50,"y":-0.06},)"
            R"("age":12,"colour":"#ff1007","parents":[1,2]},)"
            R"({"id":4,"state":"occluded","x":100,"y":100,"w":10,"h":10,)"
            R"("centroid":{"x":105.00,"y":105.00},"area":0,"velocity":null,)"
            R"("age":2,"colour":"#000000","parents":[]}],)"
            R"("events":[{"type":"object-new","ids":[4]},{"type":"split","ids":[3,4]}]})"
            "\n");
}

TEST(Json, AnEmptyFrameStillHasItsLine) {
  EXPECT_EQ(json({}, {1, {16, 9}, {}, {}}),
            R"({"schema":"1.0","frame":1,"pts":null,"status":"skipped",)"
            R"("resolution":{"width":16,"height":9},"camera":{"x":0.00,"y":0.00},)"
            R"("objects":[],"events":[]})"
            "\n");
}

TEST(Json, GivesTheTimeOfDayOnlyWhenItIsKnown) {
  EXPECT_EQ(json({}, {1, {1, 1}, 5, {}}).find("utc"), std::string::npos);
  EXPECT_NE(json({}, {1, {1, 1}, 5, 1}).find(R"("pts":5,"utc":"1970-01-01T00:00:00.000000001Z",)"),
            std::string::npos);
}

TEST(Json, TellsTheOriginWhereItIsKnown) {
  const Origin gate{"gate 3", {{"site", "north"}, {"lane", "7"}}}, tagged{"", {{"a", ""}}};
  EXPECT_EQ(json({}, {1, {16, 9}, {}, {}, &gate}).substr(0, 95),
            R"({"schema":"1.1","source":"gate 3","tags":{"site":"north","lane":"7"},)"
            R"("frame":1,"pts":null,"stat)");
  EXPECT_TRUE(json({}, {1, {16, 9}, {}, {}, &tagged})
                  .starts_with(R"({"schema":"1.1","tags":{"a":""},"frame":1,)"));
  std::string graph;
  appendGraph(graph, {}, {1, {16, 9}, {}, {}, &gate});
  EXPECT_TRUE(graph.starts_with(R"({"schema":"1.2","source":"gate 3","tags":{"site":)"));
}

TEST(Json, EscapesWhatWouldEndItsTexts) {
  const Origin origin{"a\"b\\c\n\x01\u00e9/", {}};
  EXPECT_TRUE(json({}, {1, {16, 9}, {}, {}, &origin})
                  .starts_with("{\"schema\":\"1.1\",\"source\":"
                               "\"a\\\"b\\\\c\\u000a\\u0001\u00e9/\","));
}

TEST(Tags, AreReadInTheirOrder) {
  const auto tags = parseTags(R"( site = north gate , lane=7,note="a, \"b\" \\", none=)");
  ASSERT_TRUE(tags) << tags.error().message;
  const Tags expected{{"site", "north gate"}, {"lane", "7"}, {"note", R"(a, "b" \)"}, {"none", ""}};
  EXPECT_EQ(*tags, expected);
  EXPECT_TRUE(parseTags(" ") && parseTags("")->empty());
}

TEST(Tags, ThatAreNoneSayWhere) {
  const std::pair<const char*, const char*> kWrong[] = {
      {"site", "character 5"},     {"=north", "character 1"},   {"7=a", "character 1"},
      {"a=1, a=2", "character 6"}, {"a=1,", "character 5"},     {"a=\"b", "not closed"},
      {"a=\"b\" c", "a comma"},    {"a b=1", "character 3"},    {"a=\"b\\", "not closed"},
      {",a=1", "character 1"},     {"a=1,,b=2", "character 5"}, {"\xc3\xa9=1", "character 1"}};
  for (const auto& [text, where] : kWrong) {
    const auto tags = parseTags(text);
    ASSERT_FALSE(tags) << text;
    EXPECT_NE(tags.error().message.find(where), std::string::npos) << tags.error().message;
  }
}

TEST(Json, MapsToTheSizeOfTheFrame) {
  const auto line = json(twoObjects(), {1, {640, 120}, {}, {}}, Contours::Write);
  EXPECT_NE(line.find(R"("camera":{"x":-1.00,"y":0.00})"), std::string::npos);
  EXPECT_NE(line.find(R"("x":-4,"y":5,"w":40,"h":20,"centroid":{"x":16.50,"y":15.00},"area":500,)"
                      R"("velocity":{"x":51.00,"y":-0.06})"),
            std::string::npos);
  EXPECT_NE(line.find(R"("contour":[[0,5],[34,5],[34,25]])"), std::string::npos);
}

CameraMotion zoom() {
  constexpr int64_t kOne = CameraMotion::kOne;
  return {{kOne / 2, 0, kOne * 3, 0, kOne / 2, -kOne / 4, kOne / 65536, 0, kOne}, {160, 120}};
}

TEST(Json, TellsWhereTheCameraIsMoreThanAShift) {
  objects::Objects objects = twoObjects();
  objects.camera = zoom();
  const auto line = json(objects, {1, {320, 240}, {}, {}});
  EXPECT_TRUE(line.starts_with(R"({"schema":"1.2","frame":1,)"));
  // w = 1 − 160 / 65536 at the left edge.
  EXPECT_NE(line.find(R"("camera":{"x":-0.50,"y":0.00,"matrix":[0.503671072,0.000000000,)"
                      R"(82.811551640,0.001835536,0.501223691,59.602545277,0.000015296,)"
                      R"(0.000000000,1.000000000]},"objects")"),
            std::string::npos)
      << line;
}

TEST(Json, AShiftHasNoMatrixHoweverFineAndScaled) {
  objects::Objects objects = twoObjects();
  objects.camera = {
      {CameraMotion::kOne, 0, 12345, 0, CameraMotion::kOne, 0, 0, 0, CameraMotion::kOne},
      {160, 120}};
  for (const Size size : {Size{320, 240}, {123, 457}})
    EXPECT_EQ(json(objects, {1, size, {}, {}}), json(twoObjects(), {1, size, {}, {}}));
}

TEST(Json, MapsTheCameraToTheSizeOfTheFrame) {
  objects::Objects objects = twoObjects();
  objects.camera = zoom();
  const auto line = json(objects, {1, {640, 240}, {}, {}});
  EXPECT_NE(line.find(R"("matrix":[0.503676836,0.000000000,165.871898685,0.000917775,)"
                      R"(0.501225612,59.602313749,0.000007648,0.000000000,1.000000000]})"),
            std::string::npos)
      << line;
}

TEST(Json, ACameraOfNonsenseIsWrittenAsNone) {
  objects::Objects objects = twoObjects();
  CameraMotion::Matrix matrix{};
  for (const int64_t value : {INT64_MIN, INT64_MAX, int64_t{0}}) {
    matrix.fill(value);
    objects.camera = {matrix, {INT32_MIN, INT32_MAX}};
    EXPECT_EQ(json(objects, {1, {320, 240}, {}, {}}), json(twoObjects(), {1, {320, 240}, {}, {}}));
  }
}

TEST(Json, LeavesOutWhatIsNotSure) {
  objects::Objects objects = twoObjects();
  objects.objects[0].state = objects::ObjectState::New;
  objects.objects[1].state = objects::ObjectState::Lost;
  EXPECT_NE(json(objects, {1, {320, 240}, {}, {}}).find(R"("objects":[],)"), std::string::npos);
}

TEST(Mot, WritesALineForEachListedObject) {
  objects::Objects objects = twoObjects();
  objects.objects.push_back(objects.objects[0]);
  objects.objects.back().id = 9;
  objects.objects.back().state = objects::ObjectState::Stopped;
  objects.objects.push_back(objects.objects[0]);
  objects.objects.back().state = objects::ObjectState::New;
  objects.objects.push_back(objects.objects[0]);
  objects.objects.back().state = objects::ObjectState::Lost;
  std::string out;
  appendMot(out, objects, {12, {320, 240}, {}, {}});
  EXPECT_EQ(out,
            "12,3,-2,10,20,40,1,-1,-1,-1\n"
            "12,4,100,100,10,10,1,-1,-1,-1\n"
            "12,9,-2,10,20,40,1,-1,-1,-1\n");
}

TEST(Mot, MapsToTheSizeOfTheFrame) {
  std::string out;
  appendMot(out, twoObjects(), {1, {160, 480}, {}, {}});
  EXPECT_EQ(out, "1,3,-1,20,10,80,1,-1,-1,-1\n1,4,50,200,5,20,1,-1,-1,-1\n");
}

graph::Graph twoRegions() {
  graph::Graph graph;
  graph.size = {100, 50};
  graph.status = Status::Ok;
  graph.regions = {{40, {0, 0, 10, 4}, 1152, 384, {}}, {9, {50, 40, 3, 3}, 13056, 10496, {}}};
  return graph;
}

TEST(Regions, HasTheColumnsThatReadersExpect) {
  EXPECT_EQ(kRegionsHeader, "frame,id,area,x,y,w,h,cx,cy,dx,dy,reliability,object\n");
}

TEST(Regions, WritesALineForEachLabel) {
  const graph::Graph graph = twoRegions();
  motion::Motion motion;
  motion.regions = {{24, -1, 7, 256}, {-320, 0, 0, 64}};
  objects::Objects objects;
  objects.regionObject = {0, 17};
  std::string out;
  appendRegions(out, {&graph, &motion, &objects}, {2, {100, 50}, {}, {}});
  EXPECT_EQ(out,
            "2,1,40,0,0,10,4,4.50,1.50,1.5000,-0.0625,1.0000,0\n"
            "2,2,9,50,40,3,3,51.00,41.00,-20.0000,0.0000,0.2500,17\n");
}

TEST(Regions, DoWithoutMotionAndObjects) {
  const graph::Graph graph = twoRegions();
  motion::Motion skipped;
  std::string out;
  appendRegions(out, {&graph, nullptr, nullptr}, {1, {100, 50}, {}, {}});
  std::string withEmpty;
  appendRegions(withEmpty, {&graph, &skipped, nullptr}, {1, {100, 50}, {}, {}});
  EXPECT_EQ(out,
            "1,1,40,0,0,10,4,4.50,1.50,0.0000,0.0000,0.0000,0\n"
            "1,2,9,50,40,3,3,51.00,41.00,0.0000,0.0000,0.0000,0\n");
  EXPECT_EQ(withEmpty, out);
}

TEST(Regions, MapToTheSizeOfTheFrame) {
  const graph::Graph graph = twoRegions();
  motion::Motion motion;
  motion.regions = {{24, -1, 7, 256}, {-320, 16, 0, 64}};
  std::string out;
  appendRegions(out, {&graph, &motion, nullptr}, {1, {200, 25}, {}, {}});
  EXPECT_EQ(out,
            "1,1,40,0,0,20,2,9.00,0.75,3.0000,-0.0625,1.0000,0\n"
            "1,2,9,100,20,6,2,102.00,20.50,-40.0000,0.5000,0.2500,0\n");
}

/// Writes 1234.5 as 1.234,5, as many languages do.
struct CommaForPoint : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Text, DoesNotDependOnTheLocale) {
  const FrameStamp stamp{1'234'567, {16384, 16384}, 1'234'567'890, 1};
  const std::string before = json(twoObjects(), stamp);
  const std::locale old =
      std::locale::global(std::locale(std::locale::classic(), new CommaForPoint));
  EXPECT_EQ(json(twoObjects(), stamp), before);
  std::locale::global(old);
}

TEST(Text, AWarmStringKeepsItsMemory) {
  std::string out;
  appendJson(out, twoObjects(), {1, {320, 240}, 0, 0}, Contours::Write);
  const auto capacity = out.capacity();
  const auto* memory = out.data();
  for (uint64_t frame = 2; frame < 10; ++frame) {
    out.clear();
    appendJson(out, twoObjects(), {frame, {320, 240}, 0, 0}, Contours::Write);
  }
  EXPECT_EQ(out.capacity(), capacity);
  EXPECT_EQ(out.data(), memory);
}

}  // namespace
}  // namespace rg::text
