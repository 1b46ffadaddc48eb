// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/consensus_background.hpp"

#include "core/pixel.hpp"

#include <algorithm>
#include <cstring>

namespace rg {
namespace {

constexpr int kBlock = 256;  ///< Columns at a time, so that distances stay in the first cache.

template <class Index>
size_t at(Index i) {
  return static_cast<size_t>(i);
}

int sampleRow(int channels, int y, int sample, int channel) {
  return (y * kSamples + sample) * channels + channel;
}

void smoothRow(ImageView<const uint8_t> in, int y, uint8_t* out) {
  const uint8_t* above = in.row(std::max(0, y - 1));
  const uint8_t* here = in.row(y);
  const uint8_t* below = in.row(std::min(in.height() - 1, y + 1));
  std::array<uint16_t, kBlock + 2> sums;
  for (int begin = 0; begin < in.width(); begin += kBlock) {
    const int count = std::min(kBlock, in.width() - begin);
    const auto sum = [&](int x) {
      x = std::clamp(x, 0, in.width() - 1);
      return static_cast<uint16_t>(above[x] + 2 * here[x] + below[x]);
    };
    sums[0] = sum(begin - 1);
    for (int i = 0; i < count; ++i) {
      const int x = begin + i;
      sums[at(i + 1)] = static_cast<uint16_t>(above[x] + 2 * here[x] + below[x]);
    }
    sums[at(count + 1)] = sum(begin + count);
    for (size_t i = 0; i < at(count); ++i)
      out[at(begin) + i] = static_cast<uint8_t>((sums[i] + 2 * sums[i + 1] + sums[i + 2] + 8) >> 4);
  }
}

constexpr uint8_t apart(uint8_t a, uint8_t b) {
  return static_cast<uint8_t>(std::max(a, b) - std::min(a, b));
}

struct BlockDistances {
  std::array<uint8_t, kBlock> nearest, second, distance;
};

void addSample(const uint8_t* const* pixels, const uint8_t* const* samples, int channels,
               size_t count, BlockDistances& block) {
  for (size_t i = 0; i < count; ++i) block.distance[i] = apart(pixels[0][i], samples[0][i]);
  for (int c = 1; c < channels; ++c)
    for (size_t i = 0; i < count; ++i)
      block.distance[i] = std::max(block.distance[i], apart(pixels[c][i], samples[c][i]));
  for (size_t i = 0; i < count; ++i) {
    const uint8_t d = block.distance[i];
    block.second[i] = std::min(block.second[i], std::max(block.nearest[i], d));
    block.nearest[i] = std::min(block.nearest[i], d);
  }
}

void measureBlock(const SmoothPicture& picture, const ConsensusBackground& model, int y, int x,
                  Distances& out) {
  const size_t count = at(std::min(kBlock, picture.size().width - x));
  BlockDistances block;
  block.nearest.fill(255);
  block.second.fill(255);
  std::array<const uint8_t*, 3> pixels{}, samples{};
  for (int c = 0; c < model.channels; ++c) pixels[at(c)] = picture.planes[at(c)].row(y) + x;
  for (int k = 0; k < kSamples; ++k) {
    for (int c = 0; c < model.channels; ++c)
      samples[at(c)] = model.samples.row(sampleRow(model.channels, y, k, c)) + x;
    addSample(pixels.data(), samples.data(), model.channels, count, block);
  }
  std::copy_n(block.nearest.begin(), count, out.nearest.row(y) + x);
  std::copy_n(block.second.begin(), count, out.second.row(y) + x);
}

constexpr std::array<Point, 8> kNeighbours{
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

/// Picks one of the eight neighbours; at the frame's border it may be the pixel itself.
Point neighbour(Point p, uint32_t choice, Size size) {
  const Point offset = kNeighbours[choice % 8];
  return {std::clamp(p.x + offset.x, 0, size.width - 1),
          std::clamp(p.y + offset.y, 0, size.height - 1)};
}

/// The first two samples of a row are the picture itself, the others its eight neighbours in turn.
void fillSample(const SmoothPicture& picture, int y, int sample, ConsensusBackground& model) {
  const Size size = picture.size();
  const Point offset = sample < 2 ? Point{} : kNeighbours[at((sample - 2) % 8)];
  const int from = std::clamp(y + offset.y, 0, size.height - 1);
  for (int c = 0; c < model.channels; ++c) {
    const uint8_t* in = picture.planes[at(c)].row(from);
    uint8_t* out = model.samples.row(sampleRow(model.channels, y, sample, c));
    const int begin = offset.x < 0 ? 1 : 0, end = size.width - (offset.x > 0 ? 1 : 0);
    out[0] = in[0];
    out[size.width - 1] = in[size.width - 1];
    if (end > begin) std::copy(in + begin + offset.x, in + end + offset.x, out + begin);
  }
}

void remember(const SmoothPicture& picture, Point from, Point to, uint32_t sample,
              ConsensusBackground& model) {
  for (int c = 0; c < model.channels; ++c)
    model.samples.row(sampleRow(model.channels, to.y, static_cast<int>(sample), c))[to.x] =
        picture.planes[at(c)].row(from.y)[from.x];
}

void learnRow(const SmoothPicture& picture, const Verdicts& verdicts, const ConsensusRate& rate,
              int y, ConsensusBackground& model) {
  const Size size = picture.size();
  const uint8_t* foreground = verdicts.foreground.row(y);
  const uint32_t limit = 65536u / static_cast<uint32_t>(rate.interval);
  for (int x = 0; x < size.width; ++x) {
    if (foreground[x] != 0) continue;
    const uint32_t hash = mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), rate.frame);
    // Restless pixels see more colours and must learn them faster.
    const uint32_t chance = limit << (model.unrest.row(y)[x] >> 7);
    if ((hash & 0xFFFF) < chance) remember(picture, {x, y}, {x, y}, (hash >> 16) % kSamples, model);
    const uint32_t other = std::rotl(hash, 11) * 0x2C1B3C6Du;
    if ((other & 0xFFFF) < chance) {
      const Point from = neighbour({x, y}, other >> 16, size);
      if (verdicts.foreground.at(from.x, from.y) == 0)
        remember(picture, from, {x, y}, (other >> 20) % kSamples, model);
    }
  }
}

void followRow(const Verdicts& verdicts, const Distances& distances, bool isFirst, int y,
               ConsensusBackground& model) {
  const uint8_t *foreground = verdicts.foreground.row(y), *raw = verdicts.raw.row(y);
  const uint8_t* before = verdicts.previousRaw.row(y);
  const uint8_t* nearest = distances.nearest.row(y);
  uint8_t *noise = model.noise.row(y), *unrest = model.unrest.row(y);
  for (int x = 0; x < verdicts.foreground.width(); ++x) {
    if (foreground[x] != 0) continue;
    const int seen = std::min(nearest[x], uint8_t{31}) * 8;
    noise[x] =
        static_cast<uint8_t>(noise[x] + ((seen - noise[x] + (seen > noise[x] ? 31 : 0)) >> 5));
    const int flip = !isFirst && raw[x] != before[x] ? 16 : -1;
    unrest[x] = static_cast<uint8_t>(std::clamp(unrest[x] + flip, 0, 255));
  }
}

}  // namespace

void smooth(const Picture& picture, const Executor& executor, SmoothPicture& out) {
  const std::array planes{picture.green(), picture.red(), picture.blue()};
  out.channels = picture.isGrey() ? 1 : 3;
  for (int c = 0; c < out.channels; ++c) out.planes[at(c)].resize(picture.size());
  executor.forRows(picture.size().height, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int c = 0; c < out.channels; ++c) smoothRow(planes[at(c)], y, out.planes[at(c)].row(y));
  });
}

ImageView<const uint8_t> ConsensusBackground::plane(int sample, int channel) const {
  const ptrdiff_t step = samples.view().strideBytes * kSamples * channels;
  return {samples.row(sampleRow(channels, 0, sample, channel)), noise.size(), step};
}

void prepare(Size size, int channels, ConsensusBackground& model) {
  model.samples.resize({size.width, size.height * kSamples * channels});
  model.noise.resize(size);
  model.unrest.resize(size);
}

void fillFrom(const SmoothPicture& picture, const Executor& executor, ConsensusBackground& model) {
  const Size size = picture.size();
  model.channels = picture.channels;
  executor.forRows(size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      std::fill_n(model.noise.row(y), size.width, uint8_t{8});
      std::fill_n(model.unrest.row(y), size.width, uint8_t{0});
      for (int k = 0; k < kSamples; ++k) fillSample(picture, y, k, model);
    }
  });
}

void measure(const SmoothPicture& picture, const ConsensusBackground& model,
             const Executor& executor, Distances& out) {
  out.nearest.resize(picture.size());
  out.second.resize(picture.size());
  executor.forRows(picture.size().height, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int x = 0; x < picture.size().width; x += kBlock)
        measureBlock(picture, model, y, x, out);
  });
}

void findRadii(const SmoothPicture& picture, const ConsensusBackground& model,
               const Tolerance& tolerance, const Executor& executor, Image<uint8_t>& radii) {
  radii.resize(model.noise.size());
  executor.forRows(radii.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const uint8_t *noise = model.noise.row(y), *unrest = model.unrest.row(y);
      const uint8_t* brightness = picture.planes[0].row(y);
      uint8_t* out = radii.row(y);
      for (int x = 0; x < radii.width(); ++x) {
        const int usual = tolerance.least + (brightness[x] * tolerance.brightness >> 8);
        // Noise is in eighths: twice its mean.
        out[x] = static_cast<uint8_t>(std::min(255, usual + (noise[x] >> 2) + (unrest[x] >> 4)));
      }
    }
  });
}

void learn(const SmoothPicture& picture, const Verdicts& verdicts, const Distances& distances,
           const ConsensusRate& rate, const Executor& executor, ConsensusBackground& model) {
  executor.forRows(picture.size().height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      followRow(verdicts, distances, rate.isFirst, y, model);
      learnRow(picture, verdicts, rate, y, model);
    }
  });
}

void replaceWhere(ImageView<const uint8_t> places, const SmoothPicture& picture,
                  const Executor& executor, ConsensusBackground& model) {
  executor.forRows(picture.size().height, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int x = 0; x < picture.size().width; ++x) {
        if (places.row(y)[x] == 0) continue;
        for (uint32_t k = 0; k < kSamples; ++k) remember(picture, {x, y}, {x, y}, k, model);
      }
  });
}

void paintModel(const ConsensusBackground& model, const Executor& executor,
                std::array<Image<uint8_t>, 3>& planes) {
  constexpr int kShown = 4;
  const Size size = model.noise.size();
  for (int c = 0; c < model.channels; ++c) planes[at(c)].resize(size);
  executor.forRows(size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int c = 0; c < model.channels; ++c) {
        std::array<const uint8_t*, kShown> rows{};
        for (int k = 0; k < kShown; ++k)
          rows[at(k)] = model.samples.row(sampleRow(model.channels, y, k * kSamples / kShown, c));
        uint8_t* out = planes[at(c)].row(y);
        for (int x = 0; x < size.width; ++x)
          out[x] =
              static_cast<uint8_t>((rows[0][x] + rows[1][x] + rows[2][x] + rows[3][x] + 2) >> 2);
      }
  });
}

}  // namespace rg
