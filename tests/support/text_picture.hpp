// SPDX-License-Identifier: LGPL-2.1-or-later
// Masks drawn as text, and pictures with known contents, for tests.
#pragma once

#include "core/base/bit_mask.hpp"
#include "core/base/frame.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace rg::test {

/// '.' is 0, everything else 255. All lines have the same length.
inline Image<uint8_t> drawMask(const std::vector<std::string>& lines) {
  Image<uint8_t> mask({static_cast<int>(lines.at(0).size()), static_cast<int>(lines.size())});
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      mask.at(x, y) = lines[static_cast<size_t>(y)][static_cast<size_t>(x)] == '.' ? 0 : 255;
  return mask;
}

inline BitMask drawBits(const std::vector<std::string>& lines) {
  BitMask mask;
  packEqual(drawMask(lines), 255, mask);
  return mask;
}

/// The reverse, with 's' for values between.
inline std::vector<std::string> textOf(ImageView<const uint8_t> mask) {
  std::vector<std::string> lines;
  for (int y = 0; y < mask.height(); ++y) {
    std::string line;
    for (int x = 0; x < mask.width(); ++x) {
      const uint8_t value = mask.at(x, y);
      line += value == 0 ? '.' : value == 255 ? '#' : 's';
    }
    lines.push_back(line);
  }
  return lines;
}

inline std::vector<std::string> textOf(const BitMask& mask) {
  Image<uint8_t> bytes(mask.size());
  bytes.fill(0);
  paint(mask, 255, bytes);
  return textOf(bytes);
}

struct Rgb {
  uint8_t red = 0, green = 0, blue = 0;
};

/// A colour picture from a function of (x, y).
template <class ColourOf>
std::shared_ptr<const Picture> makePicture(Size size, const ColourOf& colourOf) {
  std::vector<uint8_t> pixels(static_cast<size_t>(3 * size.area()));
  size_t next = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Rgb colour = colourOf(x, y);
      for (const uint8_t level : {colour.red, colour.green, colour.blue}) pixels[next++] = level;
    }
  const PlaneMemory plane{pixels.data(), pixels.size(), 3 * size.width};
  const auto frame = Frame::make({PixelFormat::Rgb, size}, std::array{plane});
  auto picture = std::make_shared<Picture>();
  picture->load(*frame, Executor(1));
  return picture;
}

/// A grey picture from a function of (x, y).
template <class LevelOf>
std::shared_ptr<const Picture> makeGreyPicture(Size size, const LevelOf& levelOf) {
  std::vector<uint8_t> pixels;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) pixels.push_back(static_cast<uint8_t>(levelOf(x, y)));
  const PlaneMemory plane{pixels.data(), pixels.size(), size.width};
  const auto frame = Frame::make({PixelFormat::Gray8, size}, std::array{plane});
  auto picture = std::make_shared<Picture>();
  picture->load(*frame, Executor(1));
  return picture;
}

}  // namespace rg::test
