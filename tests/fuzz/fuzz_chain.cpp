// SPDX-License-Identifier: LGPL-2.1-or-later
// Whole chains of elements: caps, frames with lying metas, events, times, properties and states in
// any order, with things in view.
#include "tests/fuzz/chain_program.hpp"
#include "tests/fuzz/cost.hpp"
#include "tests/fuzz/gst_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  rg::fuzz::Bytes bytes(data, size);
  rg::fuzz::ChainProgram(bytes).run();
  rg::fuzz::keepIfDear(data, size);
  return 0;
}
