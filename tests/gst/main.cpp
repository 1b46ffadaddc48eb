// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/harness.hpp"

#include <gst/gst.h>
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  gst_init(&argc, &argv);
  rg::testing::registerElements();
  const int status = RUN_ALL_TESTS();
  gst_deinit();
  return status;
}
