// SPDX-License-Identifier: LGPL-2.1-or-later
// What a frame costs at least, from what each launch declares: bytes over a device's bandwidth,
// integer operations over its rate, and a launch's own time. Modelled, never measured.
//
// usage: kernel-model [WIDTH HEIGHT [REGIONS [SHIFT]]]     (default: 160 regions, shifts of up to
// 20)
#include "core/background/background.hpp"
#include "core/motion/shift_search.hpp"
#include "kernels/kernels.hpp"
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
  gpu::loadPlanes(*frame, {to, to, to, to}, nullptr);
}

/// Cleaning of a mask, as method hybrid does it from its third frame on.
void launchCleaning(const Memory& m) {
  const auto pixels = static_cast<uint32_t>(m.size.area());
  const auto keepWhole = [&] {
    gpu::background::keepSupported(m.bits, m.bits, 4, {}, nullptr);
    gpu::background::fillHoles(m.bits, pixels / 50, {}, nullptr);
  };
  gpu::background::keepMajority(m.bits, 3, 115, m.bits, nullptr);
  gpu::background::dropSwaying(m.planes, m.model, {5, 20}, {m.bits, m.bits, {}, nullptr}, m.bits,
                               nullptr);
  keepWhole();
  gpu::fillUnedged(m.planes.planes[0], kMostGapStep, mostGapPx(m.size), {m.bits, m.bits, {}, {}},
                   m.bits, nullptr);
  gpu::background::growFaint(m.planes, m.model, m.bits, {m.bits, m.bits, m.bits}, m.bits, nullptr);
  keepWhole();
  gpu::background::trimBorder({m.planes, m.planes.planes[0]}, m.model, {5, 20}, m.bits, m.bits,
                              nullptr);
  gpu::background::dropSmallParts(m.bits, 8, {}, nullptr);
}

/// What stands still, in a frame in which nothing is asked whether it was displaced.
void launchGhosts(const Memory& m) {
  const gpu::background::StillView still{m.targets, plane<uint16_t>(m.size), m.bits,
                                         plane<uint8_t>(m.size)};
  gpu::background::followStill(m.planes, m.model, {5, 20}, m.bits, UINT16_MAX, still, nullptr);
  gpu::background::findGhosts(m.planes, m.model, m.bits, still, 12, {m.bits, {}, nullptr}, m.bits,
                              nullptr);
  gpu::background::addAged(m.bits, still, 32000, m.bits, nullptr);
  gpu::background::replaceWhere(m.bits, m.planes, m.model, nullptr);
  gpu::remove(m.bits, m.bits, nullptr);
}

/// Method hybrid in a scene of which not much differs from its model.
void launchBackground(const Memory& m) {
  uint32_t differing = 0;
  gpu::background::smoothAndJudge(m.planes, m.model, {5, 20}, {m.targets, {m.bits, m.bits, m.bits}},
                                  nullptr);
  gpu::countSet(m.bits, &differing, nullptr);
  launchCleaning(m);
  launchGhosts(m);
  gpu::thicken(m.bits, 2, m.bits, nullptr);
  gpu::background::learn(m.planes, {m.bits, m.bits, m.bits, m.bits, m.bits}, {1, 16, false},
                         m.model, nullptr);
  gpu::background::paintModelAt(m.bits, m.model, m.targets, nullptr);
  const background::ColourPlanes planes{m.planes.planes[0], m.planes.planes[1], m.planes.planes[2]};
  gpu::background::findShadows(planes, planes, m.bits, m.bits, nullptr);
  gpu::background::keepMajority(m.bits, 1, 128, m.bits, nullptr);
  gpu::keepOnly(m.bits, m.bits, nullptr);
  gpu::background::keepCastShadows(m.bits, m.bits, {}, nullptr);
  gpu::background::paintForeground(m.bits, m.bits, {}, m.targets.planes[0], nullptr);
  gpu::packEqual(m.planes.planes[0], background::kForegroundPixel, m.bits, nullptr);
  gpu::findComponents(m.bits, true, Connectivity::Eight, {}, nullptr);
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
  gpu::background::testGaussian(m.planes, model, 40, {mask, mask}, nullptr);
  gpu::background::keepBoth(mask, mask, mask, nullptr);
  gpu::background::differ(m.planes, m.planes, mask, nullptr);
  gpu::countLevels(mask, nullptr, nullptr);
  gpu::differenceThreshold(nullptr, 12, nullptr, nullptr);
  gpu::background::keepAbove(nullptr, mask, nullptr);
  gpu::packEqual(mask, 255, m.bits, nullptr);
  gpu::findComponents(m.bits, true, Connectivity::Eight, {}, nullptr);
  gpu::background::LineList lines;
  constexpr int kThings = 10;
  for (int i = 0; i < kThings; ++i) lines.add({0, 0, m.size.width / 10, m.size.height / 10});
  gpu::background::fillLines(mask,
                             {nullptr, nullptr, static_cast<int>(lines.strips.size()), nullptr,
                              lines.reaches, static_cast<double>(m.size.area()) / 10},
                             mask, nullptr);
  gpu::background::joinFound({mask, mask, mask}, mask, mask, nullptr);
  gpu::background::paintMean(model, m.targets, nullptr);
  gpu::packEqual(mask, 255, m.bits, nullptr);
  const background::ColourPlanes planes{m.planes.planes[0], m.planes.planes[1], m.planes.planes[2]};
  gpu::background::findShadows(planes, planes, m.bits, m.bits, nullptr);
  gpu::paint(m.bits, background::kShadowPixel, mask, nullptr);
  gpu::background::updateGaussian(m.planes, mask, {{8, 1}, {8, 4}, 1}, model, nullptr);
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
  gpu::background::measureChange(few, few, few.planes[0], nullptr);
  gpu::background::countScene(few.planes[0], few.planes[1], few.planes[2], 12, nullptr, nullptr);
  gpu::countLevels(few.planes[0], nullptr, nullptr);
  gpu::background::searchCells(
      {m.planes, m.planes, m.planes, m.planes.planes[0], cells, 12, 24, kScanned}, mask, nullptr,
      nullptr);
  gpu::background::keepDenseInCells(mask, cells, m.bits, nullptr);
  gpu::background::fillHoles(m.bits, background::mostHolePx(m.size), {}, nullptr);
  gpu::background::dropSmallParts(m.bits, background::leastThingPx(m.size), {}, nullptr);
  gpu::paint(m.bits, background::kForegroundPixel, mask, nullptr);
  gpu::background::learnScene(m.planes, kScanned, cells, {m.targets, mask}, nullptr);
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
  gpu::segmentation::findFrameBand(m.planes, nullptr, &band, nullptr);
  gpu::segmentation::smoothColours(m.planes, m.targets, nullptr);
  gpu::segmentation::averageCells(m.planes, none, kSide,
                                  {planesOfThree<uint8_t>(grid), bytes, bytes, bytes}, nullptr);
  gpu::segmentation::linkColours(cells, none, {12, true, {}}, &band,
                                 {bytes, bytes, plane<int16_t>(grid)}, nullptr);
  const gpu::segmentation::GroupsView groups{};
  gpu::segmentation::groupLinked(bytes, none, runs, kSide, groups, nullptr);
  gpu::segmentation::divideRegions({cells, bytes, kSide}, groups, limits, {}, plane<uint16_t>(grid),
                                   nullptr);
  gpu::segmentation::refineBorders(
      {cells, none, bytes, plane<uint16_t>(grid), m.planes, none, kSide}, nullptr,
      plane<uint16_t>(m.size), nullptr);
  gpu::segmentation::groupLabelled(plane<uint16_t>(m.size), none, groups, nullptr);
  gpu::segmentation::divideAgain(nullptr, groups, limits, {}, plane<uint16_t>(m.size), nullptr);
}

void launchGraph(const Memory& m) {
  constexpr uint32_t kMostLabels = 1024;
  gpu::graph::GraphView graph{};
  graph.mostLabels = kMostLabels;
  gpu::graph::buildGraph({plane<uint16_t>(m.size), nullptr, m.planes}, Connectivity::Four, graph,
                         nullptr);
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
  gpu::motion::findStill(regions, m.planes.planes[0], m.planes.planes[0], nullptr, nullptr);
  gpu::motion::padLuma(m.planes.planes[0], luma, nullptr);
  gpu::motion::sumBoxes(luma, boxes, nullptr);
  gpu::motion::searchShifts(regions, {m.planes.planes[0], luma, boxes}, range,
                            {nullptr, nullptr, search.regions}, nullptr, nullptr);
  gpu::motion::estimateMotion(regions, nullptr, nullptr, nullptr, nullptr);
  gpu::motion::padSmooth(m.planes.planes[0], luma, nullptr);
  gpu::motion::padSmooth(m.planes.planes[0], luma, nullptr);
  gpu::motion::padLuma(m.planes.planes[0], luma, nullptr);
  const gpu::motion::SeenPlanes seen{{m.planes.planes[0], luma}, {m.planes.planes[0], luma}};
  const gpu::motion::RefinedRegions refined{regions, nullptr, nullptr};
  gpu::motion::fitAlone(refined, seen, {}, nullptr);
  gpu::motion::findConsensus({}, {}, nullptr, search.regions, nullptr);
  gpu::motion::fitTogether(refined, seen, nullptr, nullptr, nullptr);
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
  gpu::motion::padLuma(m.planes.planes[0], luma, nullptr);
  gpu::motion::matchAllPixels({nullptr, nullptr, list}, m.planes.planes[0], luma, range,
                              {nullptr, search.regions, nullptr}, nullptr, nullptr);
}

/// Before a moving camera: two rounds with the frame before and with an older one, of which the
/// second knows of movers; evidence; the pixels of a few objects.
void launchObjects(const Memory& m, const Search& search) {
  constexpr int kEarlier = 2, kRounds = 2, kObjects = 16;
  const ImageView<const uint8_t> luma = m.planes.planes[0];
  const auto labels = plane<const uint16_t>(m.size);
  for (int frame = 0; frame < kEarlier; ++frame) {
    gpu::warpByCamera(luma, CameraMotion(Point{5, 3}), m.targets.planes[0], nullptr, nullptr);
    for (int round = 0; round < kRounds; ++round)
      gpu::objects::compareRegions({labels, luma, luma, nullptr},
                                   {nullptr, search.regions, 1, round > 0}, {}, nullptr);
  }
  const auto gains = plane<int16_t>(objects::evidenceGridOf(m.size));
  gpu::objects::carryEvidence({labels, luma, luma, nullptr, search.regions, gains, 256},
                              {gains, nullptr, nullptr}, nullptr);
  gpu::objects::addEvidence(labels, nullptr, gains, gains, nullptr);
  gpu::objects::findObjectPixels({labels, nullptr, nullptr, 1, m.size.width, m.planes},
                                 {plane<uint16_t>(m.size), nullptr, nullptr, kObjects}, nullptr);
}

/// A frame's way through the pipeline: method hybrid, segmentation, graph, the search for motion,
/// objects.
/// Returns of each stage how many launches there were by its end.
std::vector<size_t> launchFrame(Size size, const Search& search) {
  const Memory m{size};
  std::vector<size_t> ends;
  const auto mark = [&] { ends.push_back(gpu::shim::launches().size()); };
  loadFrame(size);
  mark();
  launchBackground(m);
  mark();
  launchSegmentation(m);
  mark();
  launchGraph(m);
  mark();
  launchSearch(m, search);
  mark();
  launchObjects(m, search);
  mark();
  return ends;
}
constexpr const char* kStages[] = {"load", "bgremove",  "hsvsegment",
                                   "srg",  "prmmotion", "mrfmerge"};

/// The stages' other methods, the same way.
std::vector<size_t> launchOthers(Size size, const Search& search) {
  const Memory m{size};
  std::vector<size_t> ends;
  const auto mark = [&] { ends.push_back(gpu::shim::launches().size()); };
  launchPaper(m);
  mark();
  launchDifference(m);
  mark();
  launchLiteral(m, search);
  mark();
  return ends;
}
constexpr const char* kOthers[] = {"bgremove method=paper", "bgremove method=frame-difference",
                                   "prmmotion method=literal"};

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

std::vector<Row> rowsOfFrame() {
  std::vector<Row> rows;
  for (const gpu::Launch& launch : gpu::shim::launches()) {
    const auto isSame = [&](const Row& row) {
      return std::string_view(row.launch.name) == launch.name;
    };
    auto row = std::find_if(rows.begin(), rows.end(), isSame);
    if (row == rows.end()) row = rows.insert(rows.end(), {launch});
    ++row->count;
    for (int i = 0; i < 2; ++i) row->us[i] += microseconds(launch, kDevices[i]);
  }
  return rows;
}

void print(Size size) {
  std::printf("modelled, not measured: %dx%d, NV12\n", size.width, size.height);
  std::printf("%-16s %8s %12s %6s %8s %9s %8s %8s\n", "kernel", "launches", "grid", "block", "MB",
              "Mop", "H200 us", "H100 us");
  double sums[2] = {};
  for (const Row& row : rowsOfFrame()) {
    const gpu::Launch& launch = row.launch;
    for (int i = 0; i < 2; ++i) sums[i] += row.us[i];
    const std::string grid = std::to_string(launch.grid.x) + "x" + std::to_string(launch.grid.y) +
                             "x" + std::to_string(launch.grid.z);
    std::printf("%-16s %8d %12s %6u %8.2f %9.2f %8.2f %8.2f\n", launch.name, row.count,
                grid.c_str(), launch.block.x * launch.block.y * launch.block.z,
                row.count * launch.work.bytes / 1e6, row.count * launch.work.operations / 1e6,
                row.us[0], row.us[1]);
  }
  const double launches = kLaunchUs * static_cast<double>(gpu::shim::launches().size());
  for (int i = 0; i < 2; ++i)
    std::printf("%s: %.1f us of work and %.0f us of launches a frame\n", kDevices[i].name, sums[i],
                launches);
}

void printStages(const std::vector<size_t>& ends, const char* const* names) {
  size_t first = 0;
  for (size_t i = 0; i < ends.size(); ++i) {
    double us[2] = {};
    for (size_t k = first; k < ends[i]; ++k)
      for (int d = 0; d < 2; ++d) us[d] += microseconds(gpu::shim::launches()[k], kDevices[d]);
    std::printf("stage %s: %.2f us of work on an H200, %.2f on an H100, %zu launches\n", names[i],
                us[0], us[1], ends[i] - first);
    first = ends[i];
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
    rg::gpu::shim::begin({rg::gpu::shim::Order::Natural, 1, rg::gpu::shim::Mode::Record});
    const auto ends = rg::launchFrame(size, search);
    rg::print(size);
    rg::printStages(ends, rg::kStages);
    rg::gpu::shim::begin({rg::gpu::shim::Order::Natural, 1, rg::gpu::shim::Mode::Record});
    rg::printStages(rg::launchOthers(size, search), rg::kOthers);
  }
}
