// SPDX-License-Identifier: LGPL-2.1-or-later
// All operations, and what core has for them.
#pragma once

#include "core/background/mask_cleaning.hpp"
#include "core/background/models/frame_difference.hpp"
#include "kernels/bit_mask.hpp"
#include "kernels/cast_shadows.hpp"
#include "kernels/changed_pixels.hpp"
#include "kernels/colour_cells.hpp"
#include "kernels/components.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/gaussian_background.hpp"
#include "kernels/histogram.hpp"
#include "kernels/hues.hpp"
#include "kernels/mask_cleaning.hpp"
#include "kernels/operations.hpp"
#include "kernels/picture.hpp"
#include "kernels/shadow.hpp"
#include "kernels/shift_search.hpp"
#include "kernels/thresholds.hpp"
