// SPDX-License-Identifier: LGPL-2.1-or-later
// The ways that objects came.
#pragma once

#include "core/objects/objects.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace rg::overlay {

/// Remembers where each object was. Memory: under 1 KiB an object, however long the trail; the
/// points are as far apart in time as that takes.
class Trails {
 public:
  void clear() { trails_.clear(); }

  /// Adds the objects of one frame. Under a moving camera the trails move with the scene, each
  /// point as the ground does there.
  /// lengthNs: what is older is forgotten.
  void advance(const objects::Objects& objects, int64_t nowNs, int64_t lengthNs);

  /// Writes the object's way, oldest point first, its present place last, in 1/16 px of the frame
  /// that the result was made for.
  void copy(const objects::Object& object, std::vector<Point>& out) const;

 private:
  static constexpr size_t kCapacity = 48;
  struct Sample {
    Point position;
    int64_t ns;
  };
  struct Trail {
    std::array<Sample, kCapacity> ring;
    size_t first = 0;
    size_t count = 0;
    int64_t seenNs = 0;
  };

  void moveAll(const CameraMotion& camera);
  static void forget(Trail& trail, int64_t beforeNs);
  static void append(Trail& trail, const Sample& sample);

  std::map<uint64_t, Trail> trails_;
};

}  // namespace rg::overlay
