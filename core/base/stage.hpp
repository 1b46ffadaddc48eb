// SPDX-License-Identifier: LGPL-2.1-or-later
// What the five stages have in common: where they run, what a frame's time is, when they forget.
#pragma once

#include "core/base/memory/device.hpp"
#include "core/base/memory/executor.hpp"

#include <cstdint>
#include <memory>

namespace rg {

struct Context {
  std::shared_ptr<const Executor> cpu;
  std::shared_ptr<Device> device;  ///< None: the stage runs on the CPU.
};

/// How far a result can be relied on.
enum class Status : uint8_t {
  Ok,
  Training,  ///< The background model is still being learnt.
  Skipped,   ///< Nothing was computed for this frame; the result is empty.
};

/// When a frame was taken.
struct FrameTime {
  int64_t ns = 0;
  bool isKnown = false;  ///< False: neither PTS nor framerate; frames are taken to be 40 ms apart.
};

/// What happened to the stream, and so what must be forgotten (design rule 5). After an exception
/// from its process() a stage is as after reset(Reset::Stream); after an error it is as before.
enum class Reset : uint8_t {
  Stream,  ///< New size, format or stream: drop model and previous frame, end tracks.
  Flush,   ///< Seek or time running backwards: keep the model, drop the previous frame, end tracks.
  Gap,     ///< Frames are missing: keep the model, drop the previous frame, predict tracks.
};

}  // namespace rg
