// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/scene_scale.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace rg::objects {
namespace {

constexpr int kLineBits = 16;
constexpr size_t kLeastPerBand = 3;  // Before a band's median counts.

/// The value below which half of the weight lies; the list is sorted by value here.
template <size_t n>
int64_t weightedMedian(std::array<std::pair<int64_t, int64_t>, n>& list, size_t count) {
  const auto end = list.begin() + static_cast<std::ptrdiff_t>(count);
  std::sort(list.begin(), end);
  int64_t total = 0, sum = 0;
  for (auto it = list.begin(); it != end; ++it) total += it->second;
  for (auto it = list.begin(); it != end; ++it) {
    sum += it->second;
    if (2 * sum >= total) return it->first;
  }
  return 0;
}

}  // namespace

void SceneScale::reset(Size frame, const Numbers::Sizes& numbers) {
  numbers_ = numbers;
  frame_ = frame;
  for (Band& band : bands_) band.seen = 0;
  height_ = width_ = {};
  isKnown_ = isUniform_ = false;
}

void SceneScale::learn(uint64_t id, int footPx, Extent size) {
  if (frame_.height <= 0 || size.height <= 0) return;
  const int row = std::clamp(footPx, 0, frame_.height - 1);
  Band& band = bands_[static_cast<size_t>(int64_t{row} * kBands / frame_.height)];
  band.samples[band.seen % kSamples] = {id, row, size.width, size.height};
  // Counts on past the ring's size, but never back to "few".
  if (++band.seen == 1u << 30) band.seen = kSamples;
  refit();
}

/// Median slope between the medians of two bands, then the median offset (Theil and Sen): a third
/// of the samples may be anything.
SceneScale::Line SceneScale::fit(int32_t Sample::*value) const {
  struct Median {
    int64_t foot, value, weight;
  };
  std::array<Median, kBands> medians;
  size_t count = 0;
  std::array<std::pair<int64_t, int64_t>, kSamples> list;
  for (const Band& band : bands_) {
    std::array<std::pair<int64_t, int64_t>, kSamples> feet;
    size_t n = 0;
    for (size_t i = 0; i < static_cast<size_t>(band.count()); ++i) {
      const Sample& sample = band.samples[i];
      if (sample.*value == 0) continue;
      // By height: a body in two pieces counts no more than a whole one.
      feet[n] = {sample.foot, sample.height};
      list[n++] = {sample.*value, sample.height};
    }
    if (n < kLeastPerBand) continue;
    medians[count++] = {weightedMedian(feet, n), weightedMedian(list, n), static_cast<int64_t>(n)};
  }
  std::array<std::pair<int64_t, int64_t>, kBands * kBands / 2> slopes;
  size_t pairs = 0;
  for (size_t i = 0; i < count; ++i)
    for (size_t j = i + 1; j < count; ++j) {
      const int64_t rows = medians[j].foot - medians[i].foot;
      if (rows * 2 * kBands < frame_.height) continue;  // Too near to tell a slope.
      slopes[pairs++] = {((medians[j].value - medians[i].value) << kLineBits) / rows,
                         rows * std::min(medians[i].weight, medians[j].weight)};
    }
  Line line;
  // With the camera above its objects nothing grows with distance.
  if (pairs > 0) line.slope = std::max<int64_t>(0, weightedMedian(slopes, pairs));
  std::array<std::pair<int64_t, int64_t>, kBands> offsets;
  for (size_t i = 0; i < count; ++i)
    offsets[i] = {(medians[i].value << kLineBits) - line.slope * medians[i].foot,
                  medians[i].weight};
  line.offset = weightedMedian(offsets, count);
  return line;
}

int64_t SceneScale::valueAt(const Line& line, int footPx) const {
  const int band = frame_.height / kBands;
  const int row = std::clamp(footPx, lowFoot_ - 2 * band, highFoot_ + 2 * band);
  return std::max<int64_t>(16, (line.offset + line.slope * row) >> kLineBits);
}

Extent SceneScale::at(int footPx) const {
  if (!isKnown_) return {};
  return {static_cast<int32_t>(valueAt(width_, footPx)),
          static_cast<int32_t>(valueAt(height_, footPx))};
}

void SceneScale::refit() {
  int samples = 0, usable = 0;
  lowFoot_ = frame_.height;
  highFoot_ = 0;
  for (const Band& band : bands_) {
    samples += band.count();
    int wide = 0;
    for (int i = 0; i < band.count(); ++i) wide += band.samples[static_cast<size_t>(i)].width > 0;
    if (wide < static_cast<int>(kLeastPerBand)) continue;
    ++usable;
    for (int i = 0; i < band.count(); ++i) {
      lowFoot_ = std::min(lowFoot_, band.samples[static_cast<size_t>(i)].foot);
      highFoot_ = std::max(highFoot_, band.samples[static_cast<size_t>(i)].foot);
    }
  }
  isKnown_ = usable > 0 && samples >= numbers_.leastSamples.whole();
  if (!isKnown_) return;
  height_ = fit(&Sample::height);
  width_ = fit(&Sample::width);
  isUniform_ = areMostAlike();
}

bool SceneScale::isAsExpected(const Sample& sample) const {
  const int64_t height = valueAt(height_, sample.foot), width = valueAt(width_, sample.foot);
  const Number wide = numbers_.alikeWidth;
  return std::abs(sample.height - height) <= numbers_.alikeHeight * height &&
         (sample.width == 0 || (sample.width <= wide * width && width <= wide * sample.width));
}

/// By samples and by things: one thing that walks up and down is always like itself.
bool SceneScale::areMostAlike() const {
  struct Thing {
    uint64_t id = 0;
    int samples = 0, unlike = 0;
  };
  std::array<Thing, kBands * kSamples> things;
  size_t count = 0;
  int samples = 0, unlike = 0;
  for (const Band& band : bands_)
    for (int i = 0; i < band.count(); ++i) {
      const Sample& sample = band.samples[static_cast<size_t>(i)];
      const auto end = things.begin() + static_cast<std::ptrdiff_t>(count);
      const auto known =
          std::find_if(things.begin(), end, [&](const Thing& t) { return t.id == sample.id; });
      if (known == end) things[count++].id = sample.id;
      const bool isUnlike = !isAsExpected(sample);
      ++known->samples;
      known->unlike += isUnlike;
      ++samples;
      unlike += isUnlike;
    }
  const auto end = things.begin() + static_cast<std::ptrdiff_t>(count);
  const auto unlikeThings =
      std::count_if(things.begin(), end, [](const Thing& t) { return 2 * t.unlike > t.samples; });
  const auto all = static_cast<int64_t>(count);
  return all >= numbers_.leastThings.whole() && unlike <= numbers_.mostUnlike * samples &&
         unlikeThings <= numbers_.mostUnlike * all;
}

}  // namespace rg::objects
