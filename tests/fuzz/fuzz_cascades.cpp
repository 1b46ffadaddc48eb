// SPDX-License-Identifier: LGPL-2.1-or-later
// Cascades as files hold them: what is accepted can be searched with.
#include "core/detection/detection.hpp"
#include "gst/support/cascade_file.hpp"

#include <array>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rg;
  constexpr Size kFrame{60, 50};
  const auto cascade = parseCascade({reinterpret_cast<const char*>(data), size});
  if (!cascade) return 0;
  Image<uint8_t> luma(kFrame);
  for (int y = 0; y < kFrame.height; ++y)
    for (int x = 0; x < kFrame.width; ++x) luma.at(x, y) = static_cast<uint8_t>(x * y * 7);
  const auto stage = detection::makeStage({std::make_shared<const Executor>(1), nullptr});
  const std::array areas{boundsOf(kFrame)};
  if (!stage->process(luma, areas, *cascade, {1.3})) std::abort();
  return 0;
}
