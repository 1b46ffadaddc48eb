// SPDX-License-Identifier: LGPL-2.1-or-later
// What happens to objects, told on the bus.
#pragma once

#include "core/base/geometry.hpp"
#include "core/objects/objects.hpp"
#include "gst/support/contact_calm.hpp"
#include "gst/support/timed_message.hpp"

#include <gst/base/gstbasetransform.h>

#include <cstdint>
#include <map>
#include <set>
#include <vector>

namespace rg {

/// Posts element messages in the name of an element; see mrfmerge for their names and fields.
class ObjectMessages {
 public:
  ObjectMessages(GstBaseTransform* element, GstDebugCategory* category)
      : element_(element), category_(category) {}

  /// Tells the events of one frame, with boxes in a frame of that size.
  void tell(const objects::Objects& objects, Size frame, const FrameMoment& moment);
  /// Tells the end of every object that was told to exist, as of the last frame.
  void endAll();

 private:
  struct Seen {
    Box box;
    objects::ObjectState state = objects::ObjectState::New;
    uint64_t frame = 0;
  };

  void see(const objects::Objects& objects, Size frame);
  void tellEvent(const objects::Event& event);
  void post(GstStructure* fields) const;
  void tellObject(const char* name, uint64_t id) const;
  void tellContact(const Contact& contact) const;
  void tellCamera(const objects::Objects& objects, Size frame);
  [[nodiscard]] std::optional<int64_t> timeNs() const;

  GstBaseTransform* const element_;
  GstDebugCategory* const category_;
  FrameMoment moment_;
  std::set<uint64_t> alive_;
  std::map<uint64_t, Seen> seen_;  ///< What is alive, or in this frame.
  uint64_t frames_ = 0;
  ContactCalm contacts_;
  bool isCameraMoving_ = false;
};

}  // namespace rg
