// SPDX-License-Identifier: LGPL-2.1-or-later
// A background model of several modes: each pixel remembers colours that it had, and a colour that
// at least two of them resemble is background.
//
// Determinism: integers; what is remembered and when follows from a hash of place and frame, so
// that any order of pixels gives the same bits. A pixel writes its own model only: it takes a
// neighbour's colour by itself, never gives its own away. The same bits on every SIMD target.
#pragma once

#include "core/base/bit_mask.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"
#include "core/simd/background/consensus_rows.hpp"

#include <array>
#include <cstdint>

namespace rg::background {

inline constexpr int kSamples = 16;  ///< Remembered colours per pixel.

/// The picture smoothed by 3x3 (1 2 1): green, red, blue; a grey one has the first plane only.
struct SmoothPicture {
  std::array<Image<uint8_t>, 3> planes;
  int channels = 0;
  [[nodiscard]] Size size() const { return planes[0].size(); }
};
void smooth(const Picture& picture, const Executor& executor, SmoothPicture& out);

struct ConsensusBackground {
  /// A row holds its words one after the other, a word its samples, a sample its channels, a
  /// channel 64 columns: what is looked at together lies together.
  Image<uint8_t> samples;
  Image<uint8_t> noise;   ///< Mean distance to the nearest sample, 1/8 grey level.
  Image<uint8_t> unrest;  ///< How often the verdict flips; 0 … 255.
  int channels = 0;       ///< 0: empty.

  /// The 64 columns of a word (x: word of the row) in a channel of a sample.
  [[nodiscard]] uint8_t* block(Point word, int sample, int channel) {
    return samples.row(word.y) + offset(word.x, sample, channel);
  }
  [[nodiscard]] const uint8_t* block(Point word, int sample, int channel) const {
    return samples.row(word.y) + offset(word.x, sample, channel);
  }
  [[nodiscard]] uint8_t& sample(Point p, int sample, int channel) {
    return block({p.x / kWordColumns, p.y}, sample, channel)[p.x % kWordColumns];
  }
  [[nodiscard]] uint8_t sample(Point p, int sample, int channel) const {
    return block({p.x / kWordColumns, p.y}, sample, channel)[p.x % kWordColumns];
  }

 private:
  [[nodiscard]] ptrdiff_t offset(int word, int sample, int channel) const {
    return ((ptrdiff_t{word} * kSamples + sample) * channels + channel) * kWordColumns;
  }
};

inline constexpr int kMeant = 4;  ///< Samples that stand for all.

/// What a few samples of a channel show together; sampleAt(sample).
template <class SampleAt>
[[nodiscard]] constexpr int modelledLevel(const SampleAt& sampleAt) {
  int sum = 0;
  for (int k = 0; k < kMeant; ++k) sum += sampleAt(k * kSamples / kMeant);
  return sum / kMeant;
}

void prepare(Size size, int channels, ConsensusBackground& model);
/// Starts from one picture: each pixel's samples are colours from its neighbourhood.
void fillFrom(const SmoothPicture& picture, const Executor& executor, ConsensusBackground& model);

/// How far a pixel may be off in any case: sensors are noisier where it is bright.
struct Tolerance {
  int least = 8;       ///< Grey levels, 0 … 255.
  int brightness = 0;  ///< Of 256: share of the pixel's brightness that is added. 0 … 255.
};

/// The distance of a pixel from a sample is its largest difference of a channel. Its radius is the
/// tolerance and what noise and unrest add.
struct Verdicts {
  BitMask raw;     ///< Fewer than two samples are within the radius.
  BitMask strong;  ///< Fewer than two are within 2.5 times the radius.
  BitMask faint;   ///< Fewer than two are within 7/8 of the radius.
};
void judge(const SmoothPicture& picture, const ConsensusBackground& model,
           const Tolerance& tolerance, const Executor& executor, Verdicts& out);

/// The radii of a row's pixels.
[[nodiscard]] RadiusRow radiusRow(const ConsensusBackground& model, const Tolerance& tolerance,
                                  int y);

/// Both at once: the rows are judged while they are in the cache.
struct JudgedPicture {
  SmoothPicture& picture;
  Verdicts& verdicts;
};
void smoothAndJudge(const Picture& picture, const ConsensusBackground& model,
                    const Tolerance& tolerance, const Executor& executor, const JudgedPicture& out);

/// How a frame is learnt.
struct ConsensusRate {
  uint32_t frame = 0;  ///< Seeds the hash.
  int interval = 16;  ///< A background pixel remembers its colour every so many frames. 1 … 4096.
  bool isFirst = false;     ///< In the first frames unrest is not counted.
  uint32_t calmPeriod = 8;  ///< Frames from a row's turn to calm down to its next one. 1 … 4096.
};
/// The cleaned foreground, also with what is beside it, the verdicts before cleaning, and the last
/// two of the frame before.
struct LearntFrame {
  const BitMask &foreground, &near, &raw, &previousNear, &previousRaw;
};
/// Learns pixels that are no foreground; noise only away from it, for beside it are its blurred
/// edges. A row remembers in every 8th frame, 16 columns at once, so
/// that a pixel does as often as the interval says. Noise follows the distance to the nearest of
/// all samples in every 16th frame of a row. A verdict that flips raises unrest, half as much
/// where `previousNear` says that a thing may have left.
void learn(const SmoothPicture& picture, const LearntFrame& seen, const ConsensusRate& rate,
           const Executor& executor, ConsensusBackground& model);

/// Forgets what was where `places` is set and remembers the picture instead.
void replaceWhere(const BitMask& places, const SmoothPicture& picture, const Executor& executor,
                  ConsensusBackground& model);

/// The model as a picture: modelledLevel of each pixel.
void paintModel(const ConsensusBackground& model, const Executor& executor,
                std::array<Image<uint8_t>, 3>& planes);
/// The same, but only where `places` is set and close to it.
void paintModelAt(const BitMask& places, const ConsensusBackground& model, const Executor& executor,
                  std::array<Image<uint8_t>, 3>& planes);

}  // namespace rg::background
