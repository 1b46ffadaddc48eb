// SPDX-License-Identifier: LGPL-2.1-or-later
// A chain of elements and what may happen to it, in an order that bytes decide.
#pragma once

#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/moving_scene.hpp"
#include "tests/support/harness.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace rg::fuzz {

class ChainProgram {
 public:
  explicit ChainProgram(Bytes& bytes);

  /// Runs until the bytes or the frames that a program may have are used up.
  void run();

 private:
  void step();
  void changeCaps();
  void changeScene();
  void changeTimes();
  void changeProperty();
  void changeState();
  void offerCaps();
  void pushFrames(int count);
  void pushLyingFrame();
  void pushEvent();
  void ask();
  [[nodiscard]] bool isGoingOn() const { return framesLeft_ > 0 && pixelsLeft_ > 0; }
  void push(testing::BufferPtr buffer);
  void pullAll();
  void emptyBus();
  [[nodiscard]] GstClockTime nextTime();

  Bytes& bytes_;
  testing::Caps caps_;
  std::string formatOfCaps_;
  testing::Chain chain_;
  std::vector<GstElement*> elements_;  ///< Of the chain; those that have properties.
  MovingScene scene_;
  enum class Times : uint8_t { Running, Constant, None, Backwards, Jumping, NearTheEnd, AtRandom };
  Times times_ = Times::Running;
  uint64_t time_ = 0, step_ = 40 * GST_MSECOND;
  int framesLeft_ = 80;
  int pixelsLeft_ = 100000;  ///< One input must not take as long as a hundred others.
};

}  // namespace rg::fuzz
