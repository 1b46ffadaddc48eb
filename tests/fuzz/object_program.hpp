// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames of regions and motions, made directly, for the object stage.
#pragma once

#include "core/objects/objects.hpp"
#include "tests/fuzz/bytes.hpp"

#include <memory>

namespace rg::fuzz {

class ObjectProgram {
 public:
  explicit ObjectProgram(Bytes& bytes);
  /// Runs until the bytes or the frames that a program may have are used up.
  void run();

 private:
  enum class Pattern : uint8_t { Things, Blocks, Stripes, Pixels, Nothing };

  void startScene();
  void changeParams();
  [[nodiscard]] uint32_t rawLabelAt(int x, int y) const;
  [[nodiscard]] std::shared_ptr<const segmentation::Labels> makeLabels();
  [[nodiscard]] std::shared_ptr<const motion::Motion> makeMotion(
      std::shared_ptr<const graph::Graph> graph);
  void processFrame();

  struct Thing {
    int32_t x = 0, y = 0, dx = 0, dy = 0, width = 1, height = 1;  ///< Pixels, and a frame.
    uint8_t parts = 1, level = 200;
  };

  Bytes& bytes_;
  Context context_;
  std::unique_ptr<graph::Stage> graphs_;
  std::unique_ptr<objects::Stage> objects_;
  objects::Params params_;
  segmentation::Scope scope_ = segmentation::Scope::Frame;
  Connectivity connectivity_ = Connectivity::Four;
  Pattern pattern_ = Pattern::Things;
  Size size_{64, 48};
  std::vector<Thing> things_;
  int block_ = 8;
  uint32_t seed_ = 0;
  int frame_ = 0;
  int64_t timeNs_ = 0;
};

}  // namespace rg::fuzz
