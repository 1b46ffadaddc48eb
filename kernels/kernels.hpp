// SPDX-License-Identifier: LGPL-2.1-or-later
// All operations, and what core has for them.
#pragma once

#include "kernels/consensus_background.hpp"
#include "kernels/histogram.hpp"
#include "kernels/operations.hpp"
#include "kernels/picture.hpp"
