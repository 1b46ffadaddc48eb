// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames to measure on: a scene, or a file.
#pragma once

#include "core/base/frame.hpp"
#include "core/base/result.hpp"
#include "tests/benchmarks/options.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace rg::bench {

/// A frame with its memory: packed BGR from the synthetic scene, I420 or grey from a file.
struct RawFrame {
  FrameLayout layout;
  std::vector<uint8_t> bytes;  ///< The planes one after the other, rows without padding.

  [[nodiscard]] Frame view() const;
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// Overwrites `frame` with the next one. A file starts again after its last frame.
  [[nodiscard]] virtual Result<bool> next(RawFrame& frame) = 0;
  /// What is measured on, for the reader of the times.
  [[nodiscard]] virtual std::string describe() const = 0;
};

/// The synthetic scene: three quarters of the regions are tiles of a still background, the others
/// bodies of two colours that cross it at constant speeds of up to half of shiftPx per frame.
/// Every pixel has noise of up to two grey levels. The same frames on every machine.
[[nodiscard]] std::unique_ptr<FrameSource> makeScene(const Options& options);

/// YUV4MPEG2 with 4:2:0 or mono planes of 8 bits.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> openY4m(const std::string& path);

/// The clip that the demo uses, or nothing where it is not there.
[[nodiscard]] std::string findClip();

/// Real frames without scaling: the middle of the clip's frames, or for larger sizes the frames
/// continued by their mirror images. Every channel of every pixel has Gaussian noise of sigma 3 of
/// its own, anew in each frame, so that nothing stands still.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> openClip(const std::string& path, Size size);

/// The frames of a video as they are, in packed BGR.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> openVideo(const std::string& path);

/// Frames made to be expensive, moving or with noise of their own.
[[nodiscard]] std::vector<std::string> patternNames();
/// One of them; null for another name.
[[nodiscard]] std::unique_ptr<FrameSource> makePattern(const std::string& name, Size size);

/// As the options say. Where there is no clip, says so on stderr.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> openSource(const Options& options);

}  // namespace rg::bench
