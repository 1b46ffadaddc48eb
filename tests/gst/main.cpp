// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/harness.hpp"

#include <gst/gst.h>
#include <gtest/gtest.h>

#include <string_view>

namespace {

/// What newer versions of GLib say where an application sets a value that no property can have.
constexpr std::string_view kRefused = "is invalid or out of range for property";

/// A message of GLib that tells of a fault in its caller fails the test that runs.
void failOnCritical(const gchar* domain, GLogLevelFlags level, const gchar* text, gpointer) {
  g_log_default_handler(domain, level, text, nullptr);
  if ((level & G_LOG_LEVEL_CRITICAL) != 0 &&
      std::string_view(text).find(kRefused) == std::string_view::npos)
    ADD_FAILURE() << (domain ? domain : "GLib") << ": " << text;
}

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  gst_init(&argc, &argv);
  rg::testing::registerElements();
  g_log_set_default_handler(failOnCritical, nullptr);
  const int status = RUN_ALL_TESTS();
  gst_deinit();
  return status;
}
