// SPDX-License-Identifier: LGPL-2.1-or-later
// Parsed once for a whole target. Sources still name what they use: -Db_pch=false checks it.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
