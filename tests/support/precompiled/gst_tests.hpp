// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/precompiled/elements.hpp"

#include <gmock/gmock.h>
#include <gst/check/gstharness.h>
#include <gtest/gtest.h>
