// SPDX-License-Identifier: LGPL-2.1-or-later
// A background model of several modes: each pixel remembers colours that it had, and a colour that
// at least two of them resemble is background.
//
// Determinism: integers; what is remembered and when follows from a hash of place and frame, so
// that any order of pixels gives the same bits. A pixel writes its own model only: it takes a
// neighbour's colour by itself, never gives its own away.
#pragma once

#include "core/executor.hpp"
#include "core/image.hpp"
#include "core/picture.hpp"

#include <array>
#include <cstdint>

namespace rg {

inline constexpr int kSamples = 16;  ///< Remembered colours per pixel.

/// The picture smoothed by 3x3 (1 2 1): green, red, blue; a grey one has the first plane only.
struct SmoothPicture {
  std::array<Image<uint8_t>, 3> planes;
  int channels = 0;
  [[nodiscard]] Size size() const { return planes[0].size(); }
};
void smooth(const Picture& picture, const Executor& executor, SmoothPicture& out);

struct ConsensusBackground {
  /// Row (y · kSamples + k) · channels + c holds channel c of sample k of row y.
  Image<uint8_t> samples;
  Image<uint8_t> noise;   ///< Mean distance to the nearest sample, 1/8 grey level.
  Image<uint8_t> unrest;  ///< How often the verdict flips; 0 … 255.
  int channels = 0;       ///< 0: empty.

  [[nodiscard]] ImageView<const uint8_t> plane(int sample, int channel) const;
};

void prepare(Size size, int channels, ConsensusBackground& model);
/// Starts from one picture: each pixel's samples are colours from its neighbourhood.
void fillFrom(const SmoothPicture& picture, const Executor& executor, ConsensusBackground& model);

/// Distances (largest difference of a channel) to the nearest and the second nearest sample.
struct Distances {
  Image<uint8_t> nearest, second;
};
void measure(const SmoothPicture& picture, const ConsensusBackground& model,
             const Executor& executor, Distances& out);

/// How far a pixel may be off in any case: sensors are noisier where it is bright.
struct Tolerance {
  int least = 8;       ///< Grey levels.
  int brightness = 0;  ///< Of 256: share of the pixel's brightness that is added.
};
/// The distance beyond which a pixel is foreground: the tolerance and what noise and unrest add.
void findRadii(const SmoothPicture& picture, const ConsensusBackground& model,
               const Tolerance& tolerance, const Executor& executor, Image<uint8_t>& radii);

/// How a frame is learnt.
struct ConsensusRate {
  uint32_t frame = 0;  ///< Seeds the hash.
  int interval = 16;  ///< A background pixel remembers its colour every so many frames. 1 … 4096.
  bool isFirst = false;  ///< In the first frames unrest is not counted.
};
/// Learns pixels where `foreground` is 0. `raw` and `previousRaw` are the verdicts before cleaning.
struct Verdicts {
  ImageView<const uint8_t> foreground, raw, previousRaw;
};
void learn(const SmoothPicture& picture, const Verdicts& verdicts, const Distances& distances,
           const ConsensusRate& rate, const Executor& executor, ConsensusBackground& model);

/// Forgets what was where `places` is set and remembers the picture instead.
void replaceWhere(ImageView<const uint8_t> places, const SmoothPicture& picture,
                  const Executor& executor, ConsensusBackground& model);

/// The model as a picture: the mean of a few remembered colours.
void paintModel(const ConsensusBackground& model, const Executor& executor,
                std::array<Image<uint8_t>, 3>& planes);

}  // namespace rg
