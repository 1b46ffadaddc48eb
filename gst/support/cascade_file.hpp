// SPDX-License-Identifier: LGPL-2.1-or-later
// Cascades from OpenCV's XML files (its format since 2.4, package opencv-data).
#pragma once

#include "core/base/result.hpp"
#include "core/detection/detection.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace rg {

/// A cascade that the detector takes. The error names the file, the reason and the remedy.
[[nodiscard]] Result<std::shared_ptr<const detection::Cascade>> readCascade(
    const std::string& path);

/// The same from what such a file holds; the error is the reason alone.
[[nodiscard]] Result<std::shared_ptr<const detection::Cascade>> parseCascade(std::string_view xml);

}  // namespace rg
