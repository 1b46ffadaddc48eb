// SPDX-License-Identifier: LGPL-2.1-or-later
// Pictures and label maps made in memory for the tests of stages 2 to 4.
#pragma once

#include "core/graph/graph.hpp"
#include "core/segmentation/segmentation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace rg::scenes {

struct Rgb {
  uint8_t red = 0, green = 0, blue = 0;
};

inline Context contextWith(int threads) {
  return {std::make_shared<const Executor>(threads), nullptr};
}

inline std::shared_ptr<const Picture> load(PixelFormat format, Size size,
                                           const std::vector<uint8_t>& pixels) {
  const int stride = planeBytes(format, size, 0).width;
  const PlaneMemory plane{pixels.data(), pixels.size(), stride};
  const auto frame = Frame::make({format, size}, std::array{plane});
  EXPECT_TRUE(frame);
  auto picture = std::make_shared<Picture>();
  picture->load(*frame, Executor(1));
  return picture;
}

/// Each pixel as `colourAt(x, y)` says.
inline std::shared_ptr<const Picture> paint(Size size,
                                            const std::function<Rgb(int, int)>& colourAt) {
  std::vector<uint8_t> pixels;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Rgb colour = colourAt(x, y);
      pixels.insert(pixels.end(), {colour.red, colour.green, colour.blue});
    }
  return load(PixelFormat::Rgb, size, pixels);
}

inline std::shared_ptr<const Picture> paintGrey(Size size,
                                                const std::function<int(int, int)>& levelAt) {
  std::vector<uint8_t> pixels;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) pixels.push_back(static_cast<uint8_t>(levelAt(x, y)));
  return load(PixelFormat::Gray8, size, pixels);
}

/// Independent values 0 … 255.
inline std::shared_ptr<const Picture> greyNoise(Size size, unsigned seed) {
  std::mt19937 random(seed);
  return paintGrey(size, [&](int, int) { return static_cast<int>(random() % 256); });
}

inline std::shared_ptr<const Picture> colourNoise(Size size, unsigned seed) {
  std::mt19937 random(seed);
  return paint(size, [&](int, int) {
    const auto bits = random();
    return Rgb{static_cast<uint8_t>(bits), static_cast<uint8_t>(bits >> 8),
               static_cast<uint8_t>(bits >> 16)};
  });
}

/// A label map as hsvsegment would publish it; the labels used must be 1 … count.
inline std::shared_ptr<const segmentation::Labels> label(
    std::shared_ptr<const Picture> picture, uint32_t count,
    const std::function<int(int, int)>& labelAt) {
  auto labels = std::make_shared<segmentation::Labels>();
  labels->size = picture->size();
  labels->status = Status::Ok;
  labels->picture = std::move(picture);
  labels->count = count;
  labels->ids.resize(labels->size);
  for (int y = 0; y < labels->size.height; ++y)
    for (int x = 0; x < labels->size.width; ++x)
      labels->ids.at(x, y) = static_cast<uint16_t>(labelAt(x, y));
  return labels;
}

inline bool areEqual(const Image<uint16_t>& a, const Image<uint16_t>& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.height(); ++y)
    if (std::memcmp(a.row(y), b.row(y), static_cast<size_t>(a.width()) * 2) != 0) return false;
  return true;
}

}  // namespace rg::scenes
