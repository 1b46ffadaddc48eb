// SPDX-License-Identifier: LGPL-2.1-or-later
// Pictures in which something moves, and regions whose motion is looked for, as kernels have them.
#pragma once

#include "core/motion/matched_blocks.hpp"
#include "core/motion/padded_luma.hpp"
#include "core/motion/shift_search.hpp"
#include "kernels/shift_search.hpp"
#include "tests/kernels/parity.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace rg::test {

struct DeviceLuma {
  Plane<uint8_t> rows;
  gpu::motion::PaddedView view;
  DeviceLuma(const motion::PaddedLuma& like, Size size)
      : rows(like.rows().size), view{size, like.reach(), rows} {}
};

/// Regions with parts of all kinds of gaps, in all corners of the picture.
struct Regions {
  std::vector<motion::MatchedPart> parts;
  std::vector<uint32_t> starts{0};

  explicit Regions(Size size) {
    for (uint16_t label = 1; label <= 5; ++label) {
      for (int strip = 0; strip * motion::kPartHeight < size.height; ++strip)
        for (int column = 0; column * motion::kPartWidth < size.width; ++column)
          if (hashOf(column, strip, label) % 3 == 0) add(size, {column, strip}, label);
      if (parts.size() > starts.back()) starts.push_back(static_cast<uint32_t>(parts.size()));
    }
  }
  void add(Size size, Point at, uint16_t label) {
    const uint32_t hash = hashOf(at.x, at.y, 90u + label);
    uint64_t blocks = hash % 3 == 0   ? ~uint64_t{0}
                      : hash % 3 == 1 ? uint64_t{1} << hash % 64
                                      : uint64_t{hash} << 32 | hashOf(at.x, at.y, label);
    const int rows = size.height - at.y * motion::kPartHeight;
    if (rows < motion::kPartHeight) blocks &= (uint64_t{1} << (2 * rows)) - 1;
    if ((at.x + 1) * motion::kPartWidth > size.width) blocks &= 0x5555555555555555;
    if (at.x * motion::kPartWidth + motion::kBlockWidth > size.width || blocks == 0) return;
    parts.push_back({blocks, static_cast<uint16_t>(at.x), static_cast<uint16_t>(at.y),
                     segmentation::RegionLabel::ofNumber(label)});
  }
  [[nodiscard]] int count() const { return static_cast<int>(starts.size()) - 1; }
  [[nodiscard]] gpu::motion::MatchedRegions view() const {
    return {parts.data(), starts.data(), count()};
  }
  [[nodiscard]] std::vector<uint8_t> unchanged(const Image<uint8_t>& now,
                                               const Image<uint8_t>& before) const {
    std::vector<uint8_t> still;
    for (int i = 0; i < count(); ++i)
      still.push_back(motion::isUnchanged(of(i), now, before) ? 1 : 0);
    return still;
  }
  [[nodiscard]] std::span<const motion::MatchedPart> of(int region) const {
    const auto i = static_cast<size_t>(region);
    return std::span(parts).subspan(starts[i], starts[i + 1] - starts[i]);
  }
};

/// The picture before, and what moved a little since then, but for the upper half of it.
struct MovedPicture {
  Image<uint8_t> before, now;
  MovedPicture(Size size, int fill, Point by) : before(filled(size, fill)), now(size) {
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        now.at(x, y) =
            y < size.height / 2
                ? before.at(x, y)
                : static_cast<uint8_t>(levelAt(fill, x - by.x, y - by.y) + (x * y % 7 == 0));
  }
};

template <class Check>
void forMoved(const Check& check, Point by = {-2, -1}) {
  for (const Size size : {Size{4, 1}, Size{13, 9}, Size{47, 40}, Size{64, 65}})
    for (int fill = 0; fill < kFills && !::testing::Test::HasFailure(); ++fill) {
      SCOPED_TRACE(std::to_string(size.width) + ", fill " + std::to_string(fill));
      check(MovedPicture(size, fill, by), Regions(size));
    }
}

}  // namespace rg::test
