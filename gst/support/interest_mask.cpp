// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/interest_mask.hpp"

#include "gst/support/regular_file.hpp"

#include <png.h>
#include <utility>

namespace rg {
namespace {

constexpr int64_t kMostPixels = int64_t{8192} * 4320;  // As many as a frame may have.
constexpr int64_t kMostMiB = 256;  // Such a picture in four channels of 16 bits.

/// libpng's simplified reader; frees what it holds on every way out.
struct PngReader {
  png_image image{};
  PngReader() { image.version = PNG_IMAGE_VERSION; }
  ~PngReader() { png_image_free(&image); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
};

Error unreadable(const std::string& path, const std::string& why) {
  return {"The mask " + path + " can't be read (" + why +
          "): give the path of a PNG picture in a regular file, white where to look, or an empty "
          "path for none"};
}

/// Levels of grey; transparent pixels are black.
Result<bool> readPng(const std::string& path, Image<uint8_t>& to) {
  const Result<File> file = openRegular(path, kMostMiB);
  if (!file) return unreadable(path, file.error().message);
  PngReader reader;
  if (!png_image_begin_read_from_stdio(&reader.image, file->get()))
    return unreadable(path, reader.image.message);
  if (int64_t{reader.image.width} * int64_t{reader.image.height} > kMostPixels)
    return unreadable(path, "it has more than 35 million pixels");
  reader.image.format = PNG_FORMAT_GRAY;
  Image<uint8_t> picture(
      {static_cast<int>(reader.image.width), static_cast<int>(reader.image.height)});
  const png_color black{};
  const auto stride = static_cast<png_int_32>(picture.view().strideBytes);
  if (!png_image_finish_read(&reader.image, &black, picture.row(0), stride, nullptr))
    return unreadable(path, reader.image.message);
  to = std::move(picture);
  return true;
}

}  // namespace

Result<bool> InterestMask::follow(const InterestSettings& settings) {
  if (settings == settings_) return true;
  auto hasRead = read(settings);
  settings_ = settings;  // Last: what an exception kept from being read is read again.
  return hasRead;
}

Result<bool> InterestMask::read(const InterestSettings& settings) {
  auto polygons = background::parsePolygons(settings.areasOfInterest);
  if (!polygons) return Error{"areas-of-interest: " + polygons.error().message};
  if (settings.mask != path_) {
    Image<uint8_t> picture;
    if (!settings.mask.empty())
      if (auto read = readPng(settings.mask, picture); !read) return read.error();
    picture_ = std::move(picture);
    path_ = settings.mask;
  }
  polygons_ = *std::move(polygons);
  fitted_.reset();
  return true;
}

std::shared_ptr<const Image<uint8_t>> InterestMask::fit(Size frame) {
  if (polygons_.empty() && picture_.size().isEmpty()) return nullptr;
  if (fitted_ && fitted_->size() == frame) return fitted_;
  auto interest = std::make_shared<Image<uint8_t>>(frame);
  background::drawInterest(polygons_, picture_, *interest);
  fitted_ = std::move(interest);
  return fitted_;
}

}  // namespace rg
