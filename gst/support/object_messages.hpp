// SPDX-License-Identifier: LGPL-2.1-or-later
// What happens to objects, told on the bus.
#pragma once

#include "core/objects/objects.hpp"

#include <gst/base/gstbasetransform.h>

#include <cstdint>
#include <set>

namespace rg {

/// Posts element messages in the name of an element; see mrfmerge for their names and fields.
class ObjectMessages {
 public:
  ObjectMessages(GstBaseTransform* element, GstDebugCategory* category)
      : element_(element), category_(category) {}

  /// Tells the events of one frame.
  void tell(const objects::Objects& objects, GstClockTime pts);
  /// Tells the end of every object that was told to exist, as of the last frame.
  void endAll();

 private:
  void post(GstStructure* fields) const;
  void tellObject(const char* name, uint64_t id) const;
  void tellGroup(const char* name, const objects::Event& event) const;
  void tellCamera(const objects::Objects& objects);

  GstBaseTransform* const element_;
  GstDebugCategory* const category_;
  GstClockTime pts_ = GST_CLOCK_TIME_NONE;
  std::set<uint64_t> alive_;
  bool isCameraMoving_ = false;
};

}  // namespace rg
