// SPDX-License-Identifier: LGPL-2.1-or-later
// Whose memory the tests on a GPU have: their own (own_memory.cpp), or for tests whose variables
// are given to kernels memory that host and GPU both see (registered_memory.cpp).
#pragma once

namespace rg::test {

/// Calls run() on a thread that has such memory. Where both see it, it is the thread's stack and
/// all that operator new gives meanwhile; the process ends with what run() returns, or with 1 where
/// there is none, and nothing is destroyed: what static objects hold may be the GPU's.
int callInGpuMemory(int (*run)());

}  // namespace rg::test
