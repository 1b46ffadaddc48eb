// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a user wants an element to look, kept up with its properties and the frame's size.
#pragma once

#include "core/background/background.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/result.hpp"

#include <memory>
#include <string>
#include <vector>

namespace rg {

/// What the user says: the path of a PNG, and polygons as text (core/background/interest.hpp). Both
/// may be empty.
struct InterestSettings {
  std::string mask;
  std::string areasOfInterest;
  friend bool operator==(const InterestSettings&, const InterestSettings&) = default;
};

class InterestMask {
 public:
  /// Reads file and text, where they are not those of the last call. On an error, which is told
  /// once, what was read before stays.
  [[nodiscard]] Result<bool> follow(const InterestSettings& settings);
  /// The mask for frames of a size: the same object until something changes; null = look
  /// everywhere.
  [[nodiscard]] std::shared_ptr<const Image<uint8_t>> fit(Size frame);

 private:
  [[nodiscard]] Result<bool> read(const InterestSettings& settings);

  InterestSettings settings_;  ///< As last asked for.
  std::string path_;           ///< Of the picture.
  Image<uint8_t> picture_;
  std::vector<background::InterestPolygon> polygons_;
  std::shared_ptr<const Image<uint8_t>> fitted_;
};

}  // namespace rg
