// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/models/frame_difference.hpp"

#include <algorithm>
#include <cassert>

namespace rg::background {
namespace {

void differRow(const uint8_t* a, const uint8_t* b, int width, uint8_t* out) {
  for (int x = 0; x < width; ++x)
    out[x] = static_cast<uint8_t>(std::max(a[x], b[x]) - std::min(a[x], b[x]));
}

void raiseRow(const uint8_t* a, const uint8_t* b, int width, uint8_t* out) {
  for (int x = 0; x < width; ++x)
    out[x] = std::max(out[x], static_cast<uint8_t>(std::max(a[x], b[x]) - std::min(a[x], b[x])));
}

}  // namespace

void differ(const Picture& a, const Picture& b, const Executor& executor, Image<uint8_t>& out) {
  assert(a.size() == b.size());
  const int width = a.size().width;
  const bool isGrey = a.isGrey() || b.isGrey();
  out.resize(a.size());
  executor.forRows(a.size().height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      differRow(a.green().row(y), b.green().row(y), width, out.row(y));
      if (isGrey) continue;
      raiseRow(a.red().row(y), b.red().row(y), width, out.row(y));
      raiseRow(a.blue().row(y), b.blue().row(y), width, out.row(y));
    }
  });
}

}  // namespace rg::background
