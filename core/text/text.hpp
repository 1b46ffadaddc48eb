// SPDX-License-Identifier: LGPL-2.1-or-later
// Results as text: a line a frame, of bytes that depend on nothing but the results.
#pragma once

#include "core/text/graph.hpp"
#include "core/text/json.hpp"
#include "core/text/line.hpp"
#include "core/text/mot.hpp"
#include "core/text/names.hpp"
#include "core/text/origin.hpp"
#include "core/text/regions.hpp"
