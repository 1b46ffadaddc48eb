// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/block_reduce.hpp"
#include "kernels/model_pixels.hpp"
#include "kernels/scene_watch.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::LitPoints;
using rg::background::PointGrid;
using rg::background::ShiftedSums;
using rg::background::VividPoints;

/// Calls visit(point) for a thread's share of a grid that a block walks.
template <class Visit>
__device__ void forPoints(const PointGrid& grid, const Visit& visit) {
  for (int i = static_cast<int>(threadIdx.x); i < grid.count(); i += kReduceThreads)
    visit(grid.point(i));
}

__global__ void countLitPoints(const __grid_constant__ Planes picture, PointGrid grid, int level,
                               LitPoints* out) {
  RG_SHARED(uint32_t, values, kReduceWarps);
  LitPoints own;
  forPoints(grid, [&](Point p) {
    int most = 0;
    for (int c = 0; c < picture.channels; ++c)
      most = std::max(most, +picture.planes[c].at(p.x, p.y));
    own.add(most, level);
  });
  const LitPoints all{reduceBlock(own.all, values, Total{}),
                      reduceBlock(own.bright, values, Total{}),
                      reduceBlock(own.lit, values, Total{}), reduceBlock(own.dim, values, Total{})};
  if (threadIdx.x == 0) *out = all;
}

__global__ void countVividPoints(const __grid_constant__ Planes picture,
                                 const __grid_constant__ ModelView model, PointGrid grid,
                                 VividPoints* out) {
  RG_SHARED(uint32_t, values, kReduceWarps);
  VividPoints own;
  forPoints(grid, [&](Point p) {
    const auto now = [&](int c) { return +picture.planes[c].at(p.x, p.y); };
    const auto before = [&](int c) { return +*model.sample(p, 0, c); };
    ++own.all;
    own.now += rg::background::isVivid(now(0), now(1), now(2));
    own.before += rg::background::isVivid(before(0), before(1), before(2));
  });
  const VividPoints all{reduceBlock(own.all, values, Total{}),
                        reduceBlock(own.now, values, Total{}),
                        reduceBlock(own.before, values, Total{})};
  if (threadIdx.x == 0) *out = all;
}

/// A block for each shift, and one for none.
__global__ void sumOffPoints(const __grid_constant__ Planes picture,
                             const __grid_constant__ ModelView model, PointGrid grid, Point centre,
                             ShiftedSums* out) {
  RG_SHARED(uint32_t, values, kReduceWarps);
  const bool isMoved = blockIdx.x < ShiftedSums::kShifts;
  const Point by = ShiftedSums::shift(static_cast<int>(blockIdx.x));
  const Point shift = isMoved ? Point{centre.x + by.x, centre.y + by.y} : Point{};
  uint32_t own = 0;
  forPoints(grid, [&](Point p) {
    const int now = picture.planes[0].at(p.x - shift.x, p.y - shift.y);
    const int off = absDiff(now, modelledLevel(model, p, 0));
    constexpr int kMost = ShiftedSums::kMostOff;
    own += static_cast<uint32_t>(off < kMost ? off : kMost);
  });
  own = reduceBlock(own, values, Total{});
  if (threadIdx.x == 0) (isMoved ? out->off[blockIdx.x] : out->unmoved) = own;
}

/// A block for each field.
__global__ void countInFields(BitView raw, int* full) {
  RG_SHARED(uint32_t, values, kReduceWarps);
  const auto i = static_cast<int>(blockIdx.x);
  const Box field = rg::background::fieldOf(raw.size, i % rg::background::kFieldsAlong,
                                            i / rg::background::kFieldsAlong);
  const int first = field.x / kWordColumns, words = wordsOf(field.right()) - first;
  uint32_t own = 0;
  for (int k = static_cast<int>(threadIdx.x); k < words * field.height; k += kReduceThreads) {
    const int word = first + k % words;
    uint64_t bits = raw.words.at(word, field.y + k / words) & columnsOf(field.right(), word);
    if (word == first) bits &= ~uint64_t{0} << field.x % kWordColumns;
    own += static_cast<uint32_t>(__popcll(bits));
  }
  own = reduceBlock(own, values, Total{});
  if (threadIdx.x == 0 && rg::background::isFull(field, own)) atomicAdd(full, 1);
}

__global__ void shiftPixels(Point shift, const __grid_constant__ Planes picture,
                            const __grid_constant__ PlaneTargets out) {
  const Point p = pixelOfThread();
  const Size size = picture.size();
  if (!isWithin(p, size)) return;
  out.planes[blockIdx.z].at(p.x, p.y) = picture.planes[blockIdx.z].at(
      std::clamp(p.x - shift.x, 0, size.width - 1), std::clamp(p.y - shift.y, 0, size.height - 1));
}

/// Blocks that walk a grid, each of them all of it.
Launch overPoints(const char* name, const PointGrid& grid, unsigned blocks, double bytes) {
  const double points = static_cast<double>(grid.count()) * blocks;
  return {name, {blocks, 1, 1}, {kReduceThreads, 1, 1}, {bytes * points, 8 * points}};
}

}  // namespace

void countLit(const Planes& picture, int level, LitPoints* points, Stream stream) {
  const PointGrid grid = PointGrid::over(picture.size(), 0);
  start(overPoints("countLit", grid, 1, 3), stream, countLitPoints, picture, grid, level, points);
}

void countVivid(const Planes& picture, const ModelView& model, VividPoints* points, Stream stream) {
  const PointGrid grid = PointGrid::over(picture.size(), 0);
  start(overPoints("countVivid", grid, 1, 6), stream, countVividPoints, picture, model, grid,
        points);
}

void sumShifted(const Planes& picture, const ModelView& model, Point centre, ShiftedSums* sums,
                Stream stream) {
  const PointGrid grid =
      PointGrid::over(picture.size(), rg::background::mostShiftPx(picture.size()));
  start(overPoints("sumShifted", grid, ShiftedSums::kShifts + 1, 5), stream, sumOffPoints, picture,
        model, grid, centre, sums);
}

void countFullFields(const BitView& raw, int* full, Stream stream) {
  constexpr unsigned kFields = rg::background::kFieldsAlong * rg::background::kFieldsAlong;
  const auto words = static_cast<double>(raw.words.size.area());
  clear(full, sizeof *full, stream);
  start({"countFullFields", {kFields, 1, 1}, {kReduceThreads, 1, 1}, {8 * words, 4 * words}},
        stream, countInFields, raw, full);
}

void shiftPicture(Point shift, const Planes& picture, const PlaneTargets& out, Stream stream) {
  const double bytes = static_cast<double>(picture.size().area()) * picture.channels;
  start(launchOver("shiftPicture", picture.size(), static_cast<unsigned>(picture.channels),
                   {2 * bytes, 4 * bytes}),
        stream, shiftPixels, shift, picture, out);
}

}  // namespace rg::gpu::background
