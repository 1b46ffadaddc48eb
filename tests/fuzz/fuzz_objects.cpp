// SPDX-License-Identifier: LGPL-2.1-or-later
// The object stage: regions, motions, sizes and settings in any order, as the stages before it
// would never send them.
#include "tests/fuzz/cost.hpp"
#include "tests/fuzz/object_program.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  rg::fuzz::Bytes bytes(data, size);
  rg::fuzz::ObjectProgram(bytes).run();
  rg::fuzz::keepIfDear(data, size);
  return 0;
}
