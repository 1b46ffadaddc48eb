// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/models/consensus_background.hpp"

#include "core/background/models/consensus_turns.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cstring>

namespace rg::background {
namespace {

template <class Index>
size_t at(Index i) {
  return static_cast<size_t>(i);
}

/// Copies `count` pixels of a row from column x on; beyond its ends the row goes on as it ends.
void copyRepeated(const uint8_t* row, int width, int x, int count, uint8_t* out) {
  if (x >= 0 && x + count <= width) {
    std::copy_n(row + x, count, out);
    return;
  }
  for (int i = 0; i < count; ++i) out[i] = row[std::clamp(x + i, 0, width - 1)];
}

void fillSample(const SmoothPicture& picture, int y, int sample, ConsensusBackground& model) {
  const Size size = picture.size();
  const Point offset = fillOffset(sample);
  const int from = std::clamp(y + offset.y, 0, size.height - 1);
  for (int c = 0; c < model.channels; ++c)
    for (int word = 0; word * kWordColumns < size.width; ++word)
      copyRepeated(picture.planes[at(c)].row(from), size.width, word * kWordColumns + offset.x,
                   kWordColumns, model.block({word, y}, sample, c));
}

RowsAround rowsAround(ImageView<const uint8_t> plane, int y) {
  return {plane.row(std::max(0, y - 1)), plane.row(y),
          plane.row(std::min(plane.height() - 1, y + 1)), plane.width()};
}

ModelRow modelRow(const SmoothPicture& picture, const ConsensusBackground& model, int y) {
  ModelRow row{};
  for (int c = 0; c < model.channels; ++c) row.pixels[at(c)] = picture.planes[at(c)].row(y);
  row.samples = model.samples.row(y);
  row.channels = model.channels;
  row.sampleCount = kSamples;
  row.width = picture.size().width;
  return row;
}

/// The columns of one word, `shift` columns to the right of it; 0 beyond the row's ends.
uint64_t shifted(const uint64_t* row, int word, int words, int shift) {
  if (shift < 0) return row[word] << 1 | (word > 0 ? row[word - 1] >> 63 : 0);
  if (shift > 0) return row[word] >> 1 | (word + 1 < words ? row[word + 1] << 63 : 0);
  return row[word];
}

/// The columns of a word whose byte is at least 128.
uint64_t highColumns(const uint8_t* bytes) {
  uint64_t columns = 0;
  for (int i = 0; i < kWordColumns; i += 8) {
    uint64_t eight = 0;
    for (int k = 0; k < 8; ++k) eight |= uint64_t{bytes[i + k]} << 8 * k;
    // The highest bits of the eight bytes side by side in the highest byte.
    columns |= ((eight >> 7 & 0x0101010101010101) * 0x0102040810204080 >> 56) << i;
  }
  return columns;
}

/// One frame's learning. Memory is what it costs: so all columns of a row take the same sample and
/// the same neighbour, and only every few rows have their turn.
class Learner {
 public:
  Learner(const SmoothPicture& picture, const BitMask& foreground, const ConsensusRate& rate,
          ConsensusBackground& model)
      : picture_(picture),
        foreground_(foreground),
        rate_(rate),
        turns_(turnsOf(rate.interval)),
        model_(model) {}

  void learnRow(int y) {
    if ((static_cast<uint32_t>(y) + rate_.frame) % turns_.period != 0) return;
    draw(y, 0, Which::All);
    // Restless pixels see more colours and must learn them faster.
    draw(y, 2, Which::Restless);
  }

 private:
  enum class Which { All, Restless };

  /// Once for the pixels' own colours, and once for those of a neighbour.
  void draw(int y, uint32_t round, Which which) {
    const auto [own, other, offset] = drawOf(rate_.frame, y, round);
    const bool hasOther = y + offset.y >= 0 && y + offset.y < picture_.size().height;
    if (which == Which::All) {
      fetch(y, own);
      if (hasOther) fetch(y, other);
    }
    learn(y, {}, own, which);
    if (hasOther) learn(y, offset, other, which);
  }

  /// Asks for the memory that will be written: it has not been looked at for long.
  void fetch(int y, uint64_t dice) const {
    for (int word = 0; word < foreground_.wordsPerRow(); ++word) {
      if (columnsOf(dice, word) == 0) continue;
      const uint8_t* first = model_.block({word, y}, static_cast<int>(dice % kSamples), 0);
      for (int c = 0; c < model_.channels; ++c) hwy::Prefetch(first + c * kWordColumns);
    }
  }

  void learn(int y, Point offset, uint64_t dice, Which which) {
    for (int word = 0; word < foreground_.wordsPerRow(); ++word) {
      uint64_t columns = columnsOf(dice, word);
      if (columns == 0) continue;
      if (which == Which::Restless) columns &= restlessColumns(word, y);
      remember(columns & teachers(word, y, offset), {word, y}, offset, dice % kSamples);
    }
  }

  [[nodiscard]] uint64_t columnsOf(uint64_t seed, int word) const {
    const uint64_t dice = diceOf(seed, word);
    uint64_t columns = 0;
    for (int i = 0; i < 64; i += 16)
      columns |= isDrawn(dice, i, turns_.limit) ? uint64_t{0xFFFF} << i : 0;
    return columns;
  }

  uint64_t restlessColumns(int word, int y) const {
    return highColumns(model_.unrest.row(y) + word * kWordColumns);
  }

  /// Where pixel and neighbour are background; what is outside teaches nothing.
  uint64_t teachers(int word, int y, Point offset) const {
    const int width = picture_.size().width, begin = word * kWordColumns;
    uint64_t columns = foreground_.columnsOf(word) & ~foreground_.row(y)[word];
    columns &= ~shifted(foreground_.row(y + offset.y), word, foreground_.wordsPerRow(), offset.x);
    if (offset.x < 0 && begin == 0) columns &= ~uint64_t{1};
    if (offset.x > 0 && begin + kWordColumns >= width)
      columns &= ~(uint64_t{1} << (width - 1 - begin));
    return columns;
  }

  void remember(uint64_t columns, Point word, Point offset, uint64_t sample) {
    const int begin = word.x * kWordColumns;
    for (int c = 0; c < model_.channels; ++c) {
      const uint8_t* from = picture_.planes[at(c)].row(word.y + offset.y) + begin + offset.x;
      uint8_t* to = model_.block(word, static_cast<int>(sample), c);
      for (int i = 0; i < kWordColumns; i += 16) {
        const uint64_t some = columns >> i & 0xFFFF;
        if (some == 0xFFFF)
          std::memcpy(to + i, from + i, 16);
        else
          forSetBits(some, i, [&](int x) { to[x] = from[x]; });
      }
    }
  }

  const SmoothPicture& picture_;
  const BitMask& foreground_;
  const ConsensusRate& rate_;
  LearningTurns turns_;
  ConsensusBackground& model_;
};

void raiseUnrest(const LearntFrame& seen, int y, ConsensusBackground& model) {
  uint8_t* unrest = model.unrest.row(y);
  for (int word = 0; word < seen.raw.wordsPerRow(); ++word) {
    const uint64_t flips = seen.raw.row(y)[word] ^ seen.previousRaw.row(y)[word];
    forSetBits(flips & ~seen.foreground.row(y)[word], word * kWordColumns,
               [&](int x) { unrest[x] = raisedUnrest(unrest[x], seen.previousNear.at(x, y)); });
  }
}

void calmUnrest(const BitMask& foreground, int y, ConsensusBackground& model) {
  for (int word = 0; word < foreground.wordsPerRow(); ++word) {
    uint8_t* unrest = model.unrest.row(y) + word * kWordColumns;
    const auto calm = [&](int x) { unrest[x] = calmedUnrest(unrest[x]); };
    const uint64_t kept = foreground.row(y)[word];
    if (kept == 0)
      for (int x = 0; x < kWordColumns; ++x) calm(x);
    else
      forSetBits(~kept, 0, calm);
  }
}

void paintWord(const ConsensusBackground& model, Point word,
               std::array<Image<uint8_t>, 3>& planes) {
  for (int c = 0; c < model.channels; ++c) {
    const uint8_t* first = model.block(word, 0, c);
    const ptrdiff_t step = model.block(word, kSamples / kMeant, c) - first;
    simd::meanOfFour(first, step, planes[at(c)].row(word.y) + word.x * kWordColumns);
  }
}

void resize(const Picture& picture, SmoothPicture& out) {
  out.channels = picture.isGrey() ? 1 : 3;
  for (int c = 0; c < out.channels; ++c) out.planes[at(c)].resize(picture.size());
}

void resize(Size size, Verdicts& out) {
  out.raw.resize(size);
  out.strong.resize(size);
  out.faint.resize(size);
}

void smoothRow(const Picture& picture, int y, SmoothPicture& out) {
  const std::array planes{picture.green(), picture.red(), picture.blue()};
  for (int c = 0; c < out.channels; ++c)
    simd::smoothRow(rowsAround(planes[at(c)], y), out.planes[at(c)].row(y));
}

void judgeRow(const SmoothPicture& picture, const ConsensusBackground& model,
              const Tolerance& tolerance, int y, Verdicts& out) {
  simd::judgeRow(modelRow(picture, model, y), radiusRow(model, tolerance, y),
                 {out.raw.row(y), out.strong.row(y), out.faint.row(y)});
}

}  // namespace

void smooth(const Picture& picture, const Executor& executor, SmoothPicture& out) {
  resize(picture, out);
  executor.forRows(picture.size().height, [&](int first, int last) {
    for (int y = first; y < last; ++y) smoothRow(picture, y, out);
  });
}

RadiusRow radiusRow(const ConsensusBackground& model, const Tolerance& tolerance, int y) {
  return {model.noise.row(y), model.unrest.row(y), static_cast<uint8_t>(tolerance.least),
          static_cast<uint8_t>(tolerance.brightness)};
}

void prepare(Size size, int channels, ConsensusBackground& model) {
  const int words = (size.width + kWordColumns - 1) / kWordColumns;
  model.samples.resize({words * kWordColumns * kSamples * channels, size.height});
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

void judge(const SmoothPicture& picture, const ConsensusBackground& model,
           const Tolerance& tolerance, const Executor& executor, Verdicts& out) {
  resize(picture.size(), out);
  executor.forRows(picture.size().height, [&](int first, int last) {
    for (int y = first; y < last; ++y) judgeRow(picture, model, tolerance, y, out);
  });
}

void smoothAndJudge(const Picture& picture, const ConsensusBackground& model,
                    const Tolerance& tolerance, const Executor& executor,
                    const JudgedPicture& out) {
  resize(picture, out.picture);
  resize(picture.size(), out.verdicts);
  executor.forRows(picture.size().height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      smoothRow(picture, y, out.picture);
      judgeRow(out.picture, model, tolerance, y, out.verdicts);
    }
  });
}

void learn(const SmoothPicture& picture, const LearntFrame& seen, const ConsensusRate& rate,
           const Executor& executor, ConsensusBackground& model) {
  const uint32_t noisePeriod = rate.isFirst ? kFirstNoisePeriod : kNoisePeriod;
  executor.forRows(picture.size().height, [&](int first, int last) {
    Learner learner(picture, seen.foreground, rate, model);
    for (int y = first; y < last; ++y) {
      const uint32_t turn = static_cast<uint32_t>(y) + rate.frame;
      const ModelRow row = modelRow(picture, model, y);
      if (turn % noisePeriod == 0)
        simd::followNoiseRow(row, {model.noise.row(y), seen.near.row(y)});
      if (!rate.isFirst) raiseUnrest(seen, y, model);
      if (turn % rate.calmPeriod == 0) calmUnrest(seen.foreground, y, model);
      learner.learnRow(y);
    }
  });
}

void replaceWhere(const BitMask& places, const SmoothPicture& picture, const Executor& executor,
                  ConsensusBackground& model) {
  executor.forRows(picture.size().height, [&](int first, int last) {
    forSetPixels(places, first, last, [&](int x, int y) {
      for (int k = 0; k < kSamples; ++k)
        for (int c = 0; c < model.channels; ++c)
          model.sample({x, y}, k, c) = picture.planes[at(c)].row(y)[x];
    });
  });
}

void paintModel(const ConsensusBackground& model, const Executor& executor,
                std::array<Image<uint8_t>, 3>& planes) {
  const Size size = model.noise.size();
  for (int c = 0; c < model.channels; ++c) planes[at(c)].resize(size);
  executor.forRows(size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int word = 0; word * kWordColumns < size.width; ++word)
        paintWord(model, {word, y}, planes);
  });
}

void paintModelAt(const BitMask& places, const ConsensusBackground& model, const Executor& executor,
                  std::array<Image<uint8_t>, 3>& planes) {
  for (int c = 0; c < model.channels; ++c) planes[at(c)].resize(places.size());
  executor.forRows(places.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int word = 0; word < places.wordsPerRow(); ++word)
        if (places.row(y)[word] != 0) paintWord(model, {word, y}, planes);
  });
}

}  // namespace rg::background
