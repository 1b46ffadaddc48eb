// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/benchmarks/scene.hpp"

#include <charconv>
#include <fstream>
#include <sstream>

namespace rg::bench {
namespace {

constexpr int kMaxSide = 16384;

int numberOf(const std::string& text) {
  int value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

bool isReadable(const std::string& colourSpace) {
  return colourSpace == "mono" || colourSpace == "420" || colourSpace == "420jpeg" ||
         colourSpace == "420mpeg2" || colourSpace == "420paldv";
}

/// What the words of the file's first line say: W768 H576 C420jpeg XCOLORRANGE=FULL.
Result<FrameLayout> parseHeader(const std::string& line) {
  std::istringstream words(line);
  std::string word;
  words >> word;
  if (word != "YUV4MPEG2") return Error{"not a YUV4MPEG2 file"};
  FrameLayout layout;
  layout.format = PixelFormat::I420;
  while (words >> word) {
    const std::string value = word.substr(1);
    if (word[0] == 'W') layout.size.width = numberOf(value);
    if (word[0] == 'H') layout.size.height = numberOf(value);
    if (word[0] == 'C' && value == "mono") layout.format = PixelFormat::Gray8;
    if (word[0] == 'C' && !isReadable(value))
      return Error{"colour space " + value + " is not 8-bit 4:2:0 or mono"};
    if (word == "XCOLORRANGE=FULL") layout.range = YuvRange::Full;
  }
  if (layout.size.isEmpty() || layout.size.width > kMaxSide || layout.size.height > kMaxSide)
    return Error{"no usable size in its header"};
  return layout;
}

class Y4mFile final : public FrameSource {
 public:
  Y4mFile(std::ifstream file, const FrameLayout& layout)
      : file_(std::move(file)), firstFrame_(file_.tellg()), layout_(layout) {}

  Result<bool> next(RawFrame& frame) override {
    frame.layout = layout_;
    size_t bytes = 0;
    for (int i = 0; i < planeCount(layout_.format); ++i)
      bytes += static_cast<size_t>(planeBytes(layout_.format, layout_.size, i).area());
    frame.bytes.resize(bytes);
    if (read(frame.bytes)) return true;
    file_.clear();
    file_.seekg(firstFrame_);
    if (read(frame.bytes)) return true;
    return Error{"no complete frame in the file"};
  }
  std::string describe() const override { return "file"; }

 private:
  bool read(std::vector<uint8_t>& bytes) {
    std::string line;
    if (!std::getline(file_, line) || !line.starts_with("FRAME")) return false;
    file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file_.gcount() == static_cast<std::streamsize>(bytes.size());
  }

  std::ifstream file_;
  std::streampos firstFrame_;
  FrameLayout layout_;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> openY4m(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string header;
  if (!file || !std::getline(file, header)) return Error{path + " can't be read"};
  const auto layout = parseHeader(header);
  if (!layout) return Error{path + ": " + layout.error().message};
  std::unique_ptr<FrameSource> source = std::make_unique<Y4mFile>(std::move(file), *layout);
  return source;
}

}  // namespace rg::bench
