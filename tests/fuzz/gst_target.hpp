// SPDX-License-Identifier: LGPL-2.1-or-later
// What targets need that use GStreamer; included once, by the target.
#pragma once

#include "tests/support/harness.hpp"

#include <gst/gst.h>

namespace rg::fuzz {

inline constexpr auto kFatalLevels =
    static_cast<GLogLevelFlags>(G_LOG_LEVEL_CRITICAL | G_LOG_FATAL_MASK);

}  // namespace rg::fuzz

/// A CRITICAL is a finding: something was called that must not be.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  gst_init(argc, argv);
  rg::testing::registerElements();
  g_log_set_always_fatal(rg::fuzz::kFatalLevels);
  return 0;
}
