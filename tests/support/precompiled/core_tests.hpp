// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/precompiled/standard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
