// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/search_area.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace rg::detection {
namespace {

bool touch(const Box& a, const Box& b) {
  return !intersect(inflate(a, 1), b).isEmpty();
}

/// What two united boxes touch is united with them too, however many there are.
void addTo(std::vector<Box>& areas, Box box) {
  for (size_t i = 0; i < areas.size();) {
    if (!touch(areas[i], box)) {
      ++i;
      continue;
    }
    box = unite(areas[i], box);
    areas[i] = areas.back();
    areas.pop_back();
    i = 0;
  }
  areas.push_back(box);
}

}  // namespace

Box areaAround(const Box& object, double margin) {
  return inflate(object, static_cast<int>(std::lround(object.height * margin)));
}

void uniteAreas(std::span<const Box> boxes, Size frame, std::vector<Box>& areas) {
  areas.clear();
  const bool isTooMany = boxes.size() > kMostAreas;
  for (const Box& box : boxes) {
    const Box cut = intersect(box, boundsOf(frame));
    if (cut.isEmpty()) continue;
    if (isTooMany && !areas.empty())
      areas.front() = unite(areas.front(), cut);
    else
      addTo(areas, cut);
  }
  std::sort(areas.begin(), areas.end(),
            [](const Box& a, const Box& b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); });
}

}  // namespace rg::detection
