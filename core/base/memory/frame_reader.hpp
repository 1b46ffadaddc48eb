// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames that lie in a device's memory, as a decoder on it leaves them.
#pragma once

#include "core/base/frame.hpp"
#include "core/base/picture.hpp"

namespace rg {

/// A device that reads them, if it is one (core/base/memory/device.hpp).
class FrameReader {
 public:
  virtual ~FrameReader() = default;
  /// Picture::load() of a frame whose planes are the device's. The picture is on the host then,
  /// too: what befalls the device costs no frame. Throws DeviceError; the picture may be loaded
  /// anew.
  virtual void load(const Frame& there, Picture& picture) = 0;
};

}  // namespace rg
