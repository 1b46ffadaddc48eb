// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/camera/frame_shift.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace rg::motion {
namespace {

constexpr int kColumns = 64;  // Of a small picture, at most.
constexpr int kReachShare = 4;

/// Of shift (dx, dy), in 1/256 grey levels.
uint32_t meanDifference(ImageView<const uint8_t> now, ImageView<const uint8_t> before, int dx,
                        int dy) {
  const int first = std::max(0, dx), last = std::min(now.width(), now.width() + dx);
  const int top = std::max(0, dy), bottom = std::min(now.height(), now.height() + dy);
  uint64_t sum = 0;
  for (int y = top; y < bottom; ++y) {
    const uint8_t *a = now.row(y), *b = before.row(y - dy) - dx;
    uint32_t row = 0;
    for (int x = first; x < last; ++x) row += static_cast<uint32_t>(absDiff(a[x], b[x]));
    sum += row;
  }
  return static_cast<uint32_t>(256 * sum / static_cast<uint64_t>((last - first) * (bottom - top)));
}

}  // namespace

void shrink(ImageView<const uint8_t> luma, int side, const Executor& executor, Image<uint8_t>& to) {
  to.resize({luma.width() / side, luma.height() / side});
  const auto pixels = static_cast<uint32_t>(side * side);
  executor.forRows(to.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < to.width(); ++x) {
        uint32_t sum = pixels / 2;
        for (int row = 0; row < side; ++row) {
          const uint8_t* from = luma.row(y * side + row) + x * side;
          for (int i = 0; i < side; ++i) sum += from[i];
        }
        to.row(y)[x] = static_cast<uint8_t>(sum / pixels);
      }
  });
}

Point FrameShift::find(const std::shared_ptr<const Picture>& current,
                       const std::shared_ptr<const Picture>& previous, const Executor& executor) {
  const Size size = current->size();
  const int side = (size.width + kColumns - 1) / kColumns;
  if (size.height < side) return {};
  std::swap(now_, before_);
  if (nowOf_ != previous) shrink(previous->luma(), side, executor, before_);
  shrink(current->luma(), side, executor, now_);
  nowOf_ = current;
  const int reachX = now_.width() / kReachShare, reachY = now_.height() / kReachShare;
  best_.assign(static_cast<size_t>(2 * reachY + 1), {});
  executor.forEach(2 * reachY + 1, [&](int i) {
    Match& best = best_[static_cast<size_t>(i)];
    for (int k = 0; k <= 2 * reachX; ++k) {
      const int dx = (k + 1) / 2 * (k % 2 == 0 ? 1 : -1);  // The shortest first.
      const uint32_t mean = meanDifference(now_, before_, dx, i - reachY);
      if (mean < best.mean) best = {mean, dx};
    }
  });
  const auto key = [&](int dy) {
    const Match& match = best_[static_cast<size_t>(dy + reachY)];
    return std::tuple(match.mean, match.dx * match.dx + dy * dy, dy, match.dx);
  };
  auto best = key(-reachY);
  for (int dy = 1 - reachY; dy <= reachY; ++dy) best = std::min(best, key(dy));
  const uint32_t still = meanDifference(now_, before_, 0, 0);
  if (4 * uint64_t{std::get<0>(best)} > 3 * uint64_t{still}) return {};
  return {std::get<3>(best) * side, std::get<2>(best) * side};
}

}  // namespace rg::motion
