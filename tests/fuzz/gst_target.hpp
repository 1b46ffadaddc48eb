// SPDX-License-Identifier: LGPL-2.1-or-later
// What targets need that use GStreamer; included once, by the target.
#pragma once

#include "tests/support/harness.hpp"

#include <gst/gst.h>

#include <cstdlib>

namespace rg::fuzz {

/// A CRITICAL is a finding: something was called that must not be. GLib's own way to end there is a
/// trap, after which libFuzzer keeps no input.
inline void abortOnCritical(const gchar* domain, GLogLevelFlags level, const gchar* text,
                            gpointer) {
  g_log_default_handler(domain, level, text, nullptr);
  if ((level & G_LOG_LEVEL_CRITICAL) != 0) std::abort();
}

}  // namespace rg::fuzz

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  gst_init(argc, argv);
  rg::testing::registerElements();
  g_log_set_default_handler(rg::fuzz::abortOnCritical, nullptr);
  return 0;
}
