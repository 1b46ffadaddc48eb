// SPDX-License-Identifier: LGPL-2.1-or-later
// What a frame costs at least, from what each launch declares: bytes over a device's bandwidth,
// integer operations over its rate, and a launch's own time, by itself or in a graph. Modelled,
// never measured.
//
// usage: kernel-model [WIDTH HEIGHT [REGIONS [SHIFT]]]     (default: 160 regions, shifts of up to
// 20)
#include "core/background/background.hpp"
#include "core/motion/shift_search.hpp"
#include "kernels/kernels.hpp"
#include "kernels/launch_queue.hpp"
#include "kernels/shim/block.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace rg {
namespace {

/// Of the data sheets: bandwidth, of which copies reach four fifths, and 64 integer lanes of each
/// multiprocessor at its boost clock; four differences of bytes take one lane an instruction.
struct Device {
  const char* name;
  double bytesPerSecond, operationsPerSecond;
};
constexpr int kMultiprocessors = 132;
constexpr Device kDevices[] = {{"H200", 4.8e12 * 0.8, kMultiprocessors * 64 * 1.98e9},
                               {"H100", 3.35e12 * 0.8, kMultiprocessors * 64 * 1.98e9}};
constexpr double kLaunchUs = 2;  ///< Between kernels of one stream, without CUDA graphs.
/// With them: what CUDA.jl's manual tells of 80 short kernels, 3.5 us of the host and 70 in all.
constexpr double kGraphUs = 3.5, kInGraphUs = 70.0 / 80;

gpu::LaunchQueue queue(nullptr);
const gpu::Stream stream{nullptr, &queue};
/// Where the host waits, or sends something: what was launched before goes to the device.
void submit() {
  gpu::submit(stream);
}

/// Device memory that nobody reads: in this mode kernels don't run.
template <class T>
ImageView<T> plane(Size size) {
  return {nullptr, size, static_cast<ptrdiff_t>(size.width) * static_cast<ptrdiff_t>(sizeof(T))};
}

struct Memory {
  Size size;
  gpu::Planes planes{
      {plane<const uint8_t>(size), plane<const uint8_t>(size), plane<const uint8_t>(size)}, 3};
  gpu::PlaneTargets targets{{plane<uint8_t>(size), plane<uint8_t>(size), plane<uint8_t>(size)}, 3};
  gpu::BitTarget bits{plane<uint64_t>({gpu::wordsOf(size.width), size.height}), size};
  gpu::background::ModelView model{
      size, 3,
      plane<uint8_t>(
          {gpu::wordsOf(size.width) * kWordColumns * background::kSamples * 3, size.height}),
      plane<uint8_t>(size), plane<uint8_t>(size)};
};

void loadFrame(Size size) {
  static const uint8_t nowhere = 0;
  const auto stride = static_cast<int64_t>(size.width);
  const PlaneMemory planes[] = {{&nowhere, UINT64_MAX, stride}, {&nowhere, UINT64_MAX, stride + 1}};
  const Result<Frame> frame = Frame::make({PixelFormat::Nv12, size}, planes);
  const ImageView<uint8_t> to = plane<uint8_t>(size);
  gpu::loadPlanes(*frame, {to, to, to, to}, stream);
}

/// Cleaning of a mask, as method hybrid does it from its third frame on.
void launchCleaning(const Memory& m) {
  const auto pixels = static_cast<uint32_t>(m.size.area());
  const auto keepWhole = [&] {
    gpu::background::keepSupported(m.bits, m.bits, 4, {}, stream);
    gpu::background::fillHoles(m.bits, pixels / 50, {}, stream);
  };
  gpu::background::keepMajority(m.bits, 3, 115, m.bits, stream);
  gpu::background::dropSwaying(m.planes, m.model, {5, 20}, {m.bits, {}, nullptr}, m.bits, stream);
  keepWhole();
  gpu::fillUnedged(m.planes.planes[0], kMostGapStep, mostGapPx(m.size), {m.bits, m.bits, {}, {}},
                   m.bits, stream);
  gpu::background::growFaint(m.planes, m.model, m.bits, {m.bits, m.bits, m.bits}, m.bits, stream);
  keepWhole();
  gpu::thicken(m.bits, 2, m.bits, stream);
  gpu::background::paintModelAt(m.bits, m.model, m.targets, stream);
  using rg::background::BorderLayer;
  for (const BorderLayer layer : {BorderLayer::DrawnIn, BorderLayer::Blurred})
    gpu::background::trimBorder({m.planes, m.planes.planes[0], m.model, m.planes, {5, 20}}, layer,
                                m.bits, m.bits, stream);
  gpu::background::dropSmallParts(m.bits, 8, {}, stream);
}

/// What stands still, in a frame in which nothing is asked whether it was displaced.
void launchGhosts(const Memory& m) {
  const gpu::background::StillView still{m.targets, plane<uint16_t>(m.size), m.bits,
                                         plane<uint8_t>(m.size)};
  gpu::background::followStill(m.planes, m.model, {5, 20}, m.bits, UINT16_MAX, still, stream);
  gpu::background::findGhosts(m.planes, m.model, m.bits, still, 12, {m.bits, {}, nullptr}, m.bits,
                              stream);
  gpu::background::addAged(m.bits, still, 32000, m.bits, stream);
  gpu::background::replaceWhere(m.bits, m.planes, m.model, stream);
  gpu::remove(m.bits, m.bits, stream);
}

/// Method hybrid in a scene of which not much differs from its model.
void launchBackground(const Memory& m) {
  uint32_t differing = 0;
  gpu::background::smoothAndJudge(m.planes, m.model, {5, 20}, {m.targets, {m.bits, m.bits, m.bits}},
                                  stream);
  gpu::countSet(m.bits, &differing, stream);
  submit();
  launchCleaning(m);
  launchGhosts(m);
  const background::ColourPlanes planes{m.planes.planes[0], m.planes.planes[1], m.planes.planes[2]};
  gpu::background::findShadows(planes, planes, m.bits, m.bits, stream);
  gpu::background::keepMajority(m.bits, 1, 128, m.bits, stream);
  gpu::keepOnly(m.bits, m.bits, stream);
  gpu::background::keepCastShadows(m.bits, m.bits, {}, stream);
  gpu::thicken(m.bits, 2, m.bits, stream);
  gpu::background::learn(m.planes, {m.bits, m.bits, m.bits, m.bits, m.bits}, {1, 16, false},
                         m.model, stream);
  gpu::background::paintForeground(m.bits, m.bits, {}, m.targets.planes[0], stream);
  submit();
}

/// Three planes of one size that nobody reads.
template <class T>
gpu::PlanesOf<T> planesOfThree(Size size) {
  return {{plane<T>(size), plane<T>(size), plane<T>(size)}, 3};
}

/// Method paper, with things in a tenth of the frame.
void launchPaper(const Memory& m) {
  const gpu::background::GaussianView model{
      planesOfThree<uint16_t>(m.size), planesOfThree<uint16_t>(m.size), {}, {}};
  const ImageView<uint8_t> mask = m.targets.planes[0];
  gpu::background::testGaussian(m.planes, model, 40, {mask, mask}, stream);
  gpu::background::keepBoth(mask, mask, mask, stream);
  gpu::background::differ(m.planes, m.planes, mask, stream);
  gpu::countLevels(mask, nullptr, stream);
  gpu::differenceThreshold(nullptr, 12, nullptr, stream);
  gpu::background::keepAbove(nullptr, mask, stream);
  gpu::packEqual(mask, 255, m.bits, stream);
  gpu::findComponents(m.bits, true, Connectivity::Eight, {}, stream);
  gpu::background::LineList lines;
  constexpr int kThings = 10;
  for (int i = 0; i < kThings; ++i) lines.add({0, 0, m.size.width / 10, m.size.height / 10});
  gpu::background::fillLines(mask,
                             {nullptr, nullptr, static_cast<int>(lines.strips.size()), nullptr,
                              lines.reaches, static_cast<double>(m.size.area()) / 10},
                             mask, stream);
  gpu::background::joinFound({mask, mask, mask}, mask, mask, stream);
  gpu::background::paintMean(model, m.targets, stream);
  gpu::packEqual(mask, 255, m.bits, stream);
  const background::ColourPlanes planes{m.planes.planes[0], m.planes.planes[1], m.planes.planes[2]};
  gpu::background::findShadows(planes, planes, m.bits, m.bits, stream);
  gpu::paint(m.bits, background::kShadowPixel, mask, stream);
  gpu::background::updateGaussian(m.planes, mask, {{8, 1}, {8, 4}, 1}, model, stream);
}

/// Method frame-difference: a 16th of the rows is scanned.
void launchDifference(const Memory& m) {
  constexpr background::ScannedRows kScanned{0, 16};
  const Size rows{m.size.width, m.size.height / kScanned.step};
  const auto few = planesOfThree<uint8_t>(rows);
  const Size grid{(m.size.width + background::kCellPx - 1) / background::kCellPx,
                  (m.size.height + background::kCellPx - 1) / background::kCellPx};
  const auto cells = plane<uint8_t>(grid);
  const ImageView<uint8_t> mask = m.targets.planes[0];
  gpu::background::measureChange(few, few, few.planes[0], stream);
  gpu::background::countScene(few.planes[0], few.planes[1], few.planes[2], 12, nullptr, stream);
  gpu::countLevels(few.planes[0], nullptr, stream);
  gpu::background::searchCells(
      {m.planes, m.planes, m.planes, m.planes.planes[0], cells, 12, 24, kScanned}, mask, nullptr,
      stream);
  gpu::background::keepDenseInCells(mask, cells, m.bits, stream);
  gpu::background::fillHoles(m.bits, background::mostHolePx(m.size), {}, stream);
  gpu::background::dropSmallParts(m.bits, background::leastThingPx(m.size), {}, stream);
  gpu::paint(m.bits, background::kForegroundPixel, mask, stream);
  gpu::background::learnScene(m.planes, kScanned, cells, {m.targets, mask}, stream);
}

/// Segmentation of the whole frame: of cells, then of pixels at borders.
void launchSegmentation(const Memory& m) {
  constexpr int kSide = 8;
  const segmentation::RunLimits runs{UINT32_MAX / 2, 64};
  const segmentation::RegionDivision::Limits limits{static_cast<uint32_t>(m.size.area() / 1200),
                                                    1024};
  const Size grid{(m.size.width + kSide - 1) / kSide, (m.size.height + kSide - 1) / kSide};
  const gpu::Planes cells = planesOfThree<const uint8_t>(grid);
  const auto bytes = plane<uint8_t>(grid);
  const auto none = ImageView<const uint8_t>{};
  segmentation::HueBand band;
  gpu::segmentation::findFrameBand(m.planes, nullptr, &band, stream);
  gpu::segmentation::smoothColours(m.planes, m.targets, stream);
  gpu::segmentation::averageCells(m.planes, none, kSide,
                                  {planesOfThree<uint8_t>(grid), bytes, bytes, bytes}, stream);
  gpu::segmentation::linkColours(cells, none, {12, true, {}}, &band,
                                 {bytes, bytes, plane<int16_t>(grid)}, stream);
  const gpu::segmentation::GroupsView groups{};
  gpu::segmentation::groupLinked(bytes, none, runs, kSide, groups, stream);
  gpu::segmentation::divideRegions({cells, bytes, kSide}, groups, limits, {}, plane<uint16_t>(grid),
                                   stream);
  gpu::segmentation::refineBorders(
      {cells, none, bytes, plane<uint16_t>(grid), m.planes, none, kSide}, nullptr,
      plane<uint16_t>(m.size), stream);
  gpu::segmentation::groupLabelled(plane<uint16_t>(m.size), none, groups, stream);
  gpu::segmentation::divideAgain(nullptr, groups, limits, {}, plane<uint16_t>(m.size), stream);
}

void launchGraph(const Memory& m) {
  constexpr uint32_t kMostLabels = 1024;
  gpu::graph::GraphView graph{};
  graph.mostLabels = kMostLabels;
  gpu::graph::buildGraph({plane<uint16_t>(m.size), nullptr, m.planes}, Connectivity::Four, graph,
                         stream);
}

/// Regions that are matched, and by shifts of up to how many pixels.
struct Search {
  int regions = 160, shiftPx = 20;
};

/// The regions are matched with as many pixels as are enough.
void launchSearch(const Memory& m, const Search& search) {
  const motion::ShiftRange range{search.shiftPx, search.shiftPx + 1};
  const int reach = range.reach + 1;
  const Size padded{m.size.width + 2 * reach + motion::PaddedLuma::kSlack,
                    m.size.height + 2 * reach};
  const gpu::motion::PaddedView luma{m.size, reach, plane<uint8_t>(padded)};
  const gpu::motion::BoxesView boxes{plane<uint16_t>(padded)};
  const gpu::motion::MatchedRegions regions{nullptr, nullptr, search.regions};
  gpu::motion::findStill(regions, m.planes.planes[0], m.planes.planes[0], nullptr, stream);
  gpu::motion::padLuma(m.planes.planes[0], luma, stream);
  gpu::motion::sumBoxes(luma, boxes, stream);
  gpu::motion::searchShifts(regions, {m.planes.planes[0], luma, boxes}, range,
                            {nullptr, nullptr, search.regions}, nullptr, stream);
  gpu::motion::estimateMotion(regions, nullptr, nullptr, nullptr, stream);
  submit();
  gpu::motion::padSmooth(m.planes.planes[0], luma, stream);
  gpu::motion::padSmooth(m.planes.planes[0], luma, stream);
  gpu::motion::padLuma(m.planes.planes[0], luma, stream);
  const gpu::motion::SeenPlanes seen{{m.planes.planes[0], luma}, {m.planes.planes[0], luma}};
  const gpu::motion::RefinedRegions refined{regions, nullptr, nullptr};
  gpu::motion::fitAlone(refined, seen, {}, stream);
  submit();
  gpu::motion::findConsensus({}, {}, nullptr, search.regions, stream);
  gpu::motion::fitTogether(refined, seen, nullptr, nullptr, stream);
}

/// Method literal: all pixels of the frame, each region some rows of it.
void launchLiteral(const Memory& m, const Search& search) {
  const motion::ShiftRange range{search.shiftPx, search.shiftPx + 1};
  const Size padded{m.size.width + 2 * range.reach + motion::PaddedLuma::kSlack,
                    m.size.height + 2 * range.reach};
  const gpu::motion::PaddedView luma{m.size, range.reach, plane<uint8_t>(padded)};
  std::vector<Run> runs;
  std::vector<uint32_t> starts{0};
  for (int i = 0; i < search.regions; ++i) {
    const int end = (i + 1) * m.size.height / search.regions;
    for (int y = i * m.size.height / search.regions; y < end; ++y)
      runs.push_back(runOf(y, 0, m.size.width));
    starts.push_back(static_cast<uint32_t>(runs.size()));
  }
  gpu::motion::LiteralList list;
  list.build(runs, starts);
  gpu::motion::padLuma(m.planes.planes[0], luma, stream);
  gpu::motion::matchAllPixels({nullptr, nullptr, list}, m.planes.planes[0], luma, range,
                              {nullptr, search.regions, nullptr}, nullptr, stream);
}

/// Before a moving camera: two rounds with the frame before and with an older one, of which the
/// second knows of movers; evidence; the pixels of a few objects.
void launchObjects(const Memory& m, const Search& search) {
  constexpr int kEarlier = 2, kRounds = 2, kObjects = 16;
  const ImageView<const uint8_t> luma = m.planes.planes[0];
  const auto labels = plane<const uint16_t>(m.size);
  for (int frame = 0; frame < kEarlier; ++frame) {
    gpu::warpByCamera(luma, CameraMotion(Point{5, 3}), m.targets.planes[0], nullptr, stream);
    for (int round = 0; round < kRounds; ++round) {
      gpu::objects::compareRegions({labels, luma, luma, nullptr},
                                   {nullptr, search.regions, 1, round > 0}, {}, stream);
      submit();
    }
  }
  const auto gains = plane<int16_t>(objects::evidenceGridOf(m.size));
  gpu::objects::carryEvidence({labels, luma, luma, nullptr, search.regions, gains, 256},
                              {gains, nullptr, nullptr}, stream);
  submit();
  gpu::objects::addEvidence(labels, nullptr, gains, gains, stream);
  submit();
  gpu::objects::findObjectPixels({labels, nullptr, nullptr, 1, m.size.width, m.planes},
                                 {plane<uint16_t>(m.size), nullptr, nullptr, kObjects}, stream);
}

/// What a stage has launched, and how.
struct Stage {
  const char* name;
  std::vector<gpu::Launch> launches;
  gpu::LaunchQueue::Counts counts;  ///< Of its last frame.

  /// Kernels, clears and copies.
  [[nodiscard]] uint64_t commands() const { return counts.single + counts.inGraph; }
  [[nodiscard]] double launchesUs() const { return kLaunchUs * static_cast<double>(commands()); }
  [[nodiscard]] double graphsUs() const {
    return kGraphUs * static_cast<double>(counts.launched) +
           kInGraphUs * static_cast<double>(counts.inGraph) +
           kLaunchUs * static_cast<double>(counts.single);
  }
};

/// A frame of one stage of which there have been several: what has come before is a graph.
template <class Frame>
Stage launchStage(const char* name, const Frame& frame) {
  gpu::LaunchQueue::Counts before;
  for (int i = 0; i < 3; ++i) {
    before = queue.counts();
    gpu::shim::begin({gpu::shim::Order::Natural, 1, gpu::shim::Mode::Record});
    frame();
    submit();
  }
  const gpu::LaunchQueue::Counts after = queue.counts();
  return {name,
          gpu::shim::launches(),
          {after.single - before.single, after.inGraph - before.inGraph, after.made - before.made,
           after.updated - before.updated, after.launched - before.launched}};
}

/// A frame's way through the pipeline: method hybrid, segmentation, graph, the search for motion,
/// objects.
std::vector<Stage> launchFrame(Size size, const Search& search) {
  const Memory m{size};
  return {launchStage("load", [&] { loadFrame(size); }),
          launchStage("bgremove", [&] { launchBackground(m); }),
          launchStage("hsvsegment", [&] { launchSegmentation(m); }),
          launchStage("srg", [&] { launchGraph(m); }),
          launchStage("prmmotion", [&] { launchSearch(m, search); }),
          launchStage("mrfmerge", [&] { launchObjects(m, search); })};
}

/// The stages' other methods, the same way.
std::vector<Stage> launchOthers(Size size, const Search& search) {
  const Memory m{size};
  return {launchStage("bgremove method=paper", [&] { launchPaper(m); }),
          launchStage("bgremove method=frame-difference", [&] { launchDifference(m); }),
          launchStage("prmmotion method=literal", [&] { launchLiteral(m, search); })};
}

/// Fewer blocks than multiprocessors have no more than their share of bandwidth and rate.
double microseconds(const gpu::Launch& launch, const Device& device) {
  const gpu::Extent& grid = launch.grid;
  const double blocks = double{1} * grid.x * grid.y * grid.z;
  const double share = std::min(1.0, blocks / kMultiprocessors);
  return 1e6 / share *
         std::max(launch.work.bytes / device.bytesPerSecond,
                  launch.work.operations / device.operationsPerSecond);
}

/// The launches of one kernel in a frame.
struct Row {
  gpu::Launch launch;
  int count = 0;
  double us[2] = {};
};

void addRows(const Stage& stage, std::vector<Row>& rows) {
  for (const gpu::Launch& launch : stage.launches) {
    const auto isSame = [&](const Row& row) {
      return std::string_view(row.launch.name) == launch.name;
    };
    auto row = std::find_if(rows.begin(), rows.end(), isSame);
    if (row == rows.end()) row = rows.insert(rows.end(), {launch});
    ++row->count;
    for (int i = 0; i < 2; ++i) row->us[i] += microseconds(launch, kDevices[i]);
  }
}

void print(Size size, const std::vector<Stage>& stages) {
  std::printf("modelled, not measured: %dx%d, NV12\n", size.width, size.height);
  std::printf("%-16s %8s %12s %6s %8s %9s %8s %8s\n", "kernel", "launches", "grid", "block", "MB",
              "Mop", "H200 us", "H100 us");
  double sums[2] = {}, launchesUs = 0, graphsUs = 0;
  std::vector<Row> rows;
  for (const Stage& stage : stages) {
    addRows(stage, rows);
    launchesUs += stage.launchesUs();
    graphsUs += stage.graphsUs();
  }
  for (const Row& row : rows) {
    const gpu::Launch& launch = row.launch;
    for (int i = 0; i < 2; ++i) sums[i] += row.us[i];
    const std::string grid = std::to_string(launch.grid.x) + "x" + std::to_string(launch.grid.y) +
                             "x" + std::to_string(launch.grid.z);
    std::printf("%-16s %8d %12s %6u %8.2f %9.2f %8.2f %8.2f\n", launch.name, row.count,
                grid.c_str(), launch.block.x * launch.block.y * launch.block.z,
                row.count * launch.work.bytes / 1e6, row.count * launch.work.operations / 1e6,
                row.us[0], row.us[1]);
  }
  for (int i = 0; i < 2; ++i)
    std::printf("%s: %.1f us of work a frame, %.0f us of launches one by one, %.0f as graphs\n",
                kDevices[i].name, sums[i], launchesUs, graphsUs);
}

void printStages(const std::vector<Stage>& stages) {
  for (const Stage& stage : stages) {
    double us[2] = {};
    for (const gpu::Launch& launch : stage.launches)
      for (int d = 0; d < 2; ++d) us[d] += microseconds(launch, kDevices[d]);
    std::printf(
        "stage %s: %.2f us of work on an H200, %.2f on an H100; %d launches, of which %d graphs "
        "do %d: %.0f us instead of %.0f\n",
        stage.name, us[0], us[1], static_cast<int>(stage.commands()),
        static_cast<int>(stage.counts.launched), static_cast<int>(stage.counts.inGraph),
        stage.graphsUs(), stage.launchesUs());
  }
}

}  // namespace
}  // namespace rg

int main(int count, char** arguments) {
  std::vector<rg::Size> sizes{{640, 480}, {1920, 1080}, {3840, 2160}};
  rg::Search search;
  if (count > 2) sizes = {{std::atoi(arguments[1]), std::atoi(arguments[2])}};
  if (count > 3) search.regions = std::atoi(arguments[3]);
  if (count > 4) search.shiftPx = std::atoi(arguments[4]);
  if (search.regions < 1 || search.shiftPx < 1 || search.shiftPx >= rg::motion::kMostReach - 1)
    return 1;
  for (const rg::Size size : sizes) {
    if (size.isEmpty()) return 1;
    const auto stages = rg::launchFrame(size, search);
    rg::print(size, stages);
    rg::printStages(stages);
    rg::printStages(rg::launchOthers(size, search));
  }
}
