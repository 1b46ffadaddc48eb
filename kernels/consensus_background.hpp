// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/models/consensus_background.hpp (paper, section 2.2.1).
#pragma once

#include "core/background/models/consensus_background.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

/// rg::background::ConsensusBackground in device memory, laid out alike: a word of 64 columns holds
/// its samples, a sample its channels.
struct ModelView {
  Size size;
  int channels = 0;  ///< 1 or 3.
  ImageView<uint8_t> samples, noise, unrest;

  [[nodiscard]] constexpr uint8_t* sample(Point p, int sample, int channel) const {
    const int word = p.x / kWordColumns;
    const int block = (word * rg::background::kSamples + sample) * channels + channel;
    return samples.row(p.y) + ptrdiff_t{kWordColumns} * block + p.x % kWordColumns;
  }
};

/// What rg::background::judge says of each pixel.
struct VerdictTargets {
  BitTarget raw, strong, faint;
};

/// The masks that a frame is learnt with, as in rg::background::LearntFrame.
struct LearntFrame {
  BitView foreground, near, raw, previousNear, previousRaw;
};

void smooth(const Planes& picture, const PlaneTargets& out, Stream stream);
void fillFrom(const Planes& picture, const ModelView& model, Stream stream);
void judge(const Planes& picture, const ModelView& model,
           const rg::background::Tolerance& tolerance, const VerdictTargets& out, Stream stream);
/// smooth and judge in one launch, so that the smoothed picture is written only.
struct JudgedPicture {
  PlaneTargets picture;
  VerdictTargets verdicts;
};
void smoothAndJudge(const Planes& picture, const ModelView& model,
                    const rg::background::Tolerance& tolerance, const JudgedPicture& out,
                    Stream stream);
void learn(const Planes& picture, const LearntFrame& seen,
           const rg::background::ConsensusRate& rate, const ModelView& model, Stream stream);
void replaceWhere(const BitView& places, const Planes& picture, const ModelView& model,
                  Stream stream);
void paintModel(const ModelView& model, const PlaneTargets& out, Stream stream);
/// Only in the words of 64 columns that hold a place.
void paintModelAt(const BitView& places, const ModelView& model, const PlaneTargets& out,
                  Stream stream);

}  // namespace rg::gpu::background
