// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/benchmarks/options.hpp"

#include "tests/benchmarks/scene.hpp"

#include <charconv>
#include <iostream>
#include <optional>
#include <string_view>

namespace rg::bench {
namespace {

constexpr int kMaxSide = 16384;

/// The whole text as a number from `least` to `most`.
std::optional<int> number(std::string_view text, int least, int most) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool isGood = error == std::errc{} && end == text.data() + text.size();
  return isGood && value >= least && value <= most ? std::optional(value) : std::nullopt;
}

bool setSize(Size& size, std::string_view text) {
  const size_t cross = text.find('x');
  if (cross == std::string_view::npos) return false;
  const auto width = number(text.substr(0, cross), 1, kMaxSide);
  const auto height = number(text.substr(cross + 1), 1, kMaxSide);
  if (width && height) size = {*width, *height};
  return width && height;
}

struct NumberOption {
  std::string_view name;
  int Options::*field;
  int least, most;
};
constexpr NumberOption kNumbers[] = {
    {"--regions", &Options::regions, 1, 65535},      {"--similarity", &Options::similarity, 0, 254},
    {"--shift", &Options::shiftPx, 1, 64},           {"--threads", &Options::threads, 0, 1024},
    {"--frames", &Options::frames, 1, 1000000},      {"--warm-up", &Options::warmUp, 0, 1000000},
    {"--min-area", &Options::minAreaPx, 0, 1000000}, {"--device", &Options::device, 0, 255},
    {"--streams", &Options::streams, 1, 1024}};

bool isKnown(std::string_view name) {
  for (const NumberOption& option : kNumbers)
    if (option.name == name) return true;
  return name == "--input" || name == "--size" || name == "--scene" || name == "--scope" ||
         name == "--connectivity" || name == "--backend";
}

bool setScene(Options& options, std::string_view value) {
  options.pattern.clear();
  for (const std::string& name : patternNames())
    if (name == value) options.pattern = name;
  if (value == "clip") options.scene = SceneKind::Clip;
  if (value == "synthetic") options.scene = SceneKind::Synthetic;
  return !options.pattern.empty() || value == "clip" || value == "synthetic";
}

/// The field that an option without a value sets, or null.
bool Options::*flagOf(std::string_view name) {
  if (name == "--table") return &Options::asksTable;
  if (name == "--worst") return &Options::asksWorst;
  if (name == "--extreme") return &Options::asksExtreme;
  if (name == "--cpu") return &Options::asksCpu;
  if (name == "--literal") return &Options::isLiteral;
  if (name == "--help" || name == "-h") return &Options::asksHelp;
  return nullptr;
}

bool setScope(Options& options, std::string_view value) {
  options.scope =
      value == "foreground" ? segmentation::Scope::Foreground : segmentation::Scope::Frame;
  return value == "foreground" || value == "frame";
}

bool setConnectivity(Options& options, std::string_view value) {
  options.connectivity = value == "8" ? 8 : 4;
  return value == "4" || value == "8";
}

bool setBackend(Options& options, std::string_view value) {
  options.backend = value;
  return value == "cpu" || value == "cuda";
}

bool set(Options& options, std::string_view name, std::string_view value) {
  if (name == "--input") options.input = value;
  if (name == "--input") return !value.empty();
  if (name == "--size") return setSize(options.size, value);
  if (name == "--scene") return setScene(options, value);
  if (name == "--scope") return setScope(options, value);
  if (name == "--connectivity") return setConnectivity(options, value);
  if (name == "--backend") return setBackend(options, value);
  for (const NumberOption& option : kNumbers) {
    if (option.name != name) continue;
    const auto parsed = number(value, option.least, option.most);
    if (parsed) options.*option.field = *parsed;
    return parsed.has_value();
  }
  return false;
}

void setExtreme(Options& options) {
  options.regions = 65535;
  options.minAreaPx = 1;
  options.similarity = 0;
  options.connectivity = 8;
  options.shiftPx = 64;
}

}  // namespace

Result<Options> parseOptions(std::span<const char* const> arguments) {
  Options options;
  bool hasSize = false;
  for (size_t i = 0; i < arguments.size(); ++i) {
    const std::string name = arguments[i];
    if (bool Options::*flag = flagOf(name)) {
      options.*flag = true;
      if (options.asksHelp) return options;
      continue;
    }
    if (!isKnown(name)) return Error{"unknown option: " + name};
    if (++i == arguments.size()) return Error{name + " needs a value"};
    if (!set(options, name, arguments[i]))
      return Error{name + " can't be " + std::string(arguments[i])};
    hasSize = hasSize || name == "--size";
  }
  if (hasSize && !options.input.empty()) return Error{"--size is for scenes"};
  if (options.asksExtreme) setExtreme(options);
  if (options.asksTable && (hasSize || !options.input.empty()))
    return Error{"--table has its own sizes"};
  if (options.streams > 0 && (options.asksTable || options.asksWorst))
    return Error{"--streams is for one scene"};
  return options;
}

std::string usage(const std::string& program) {
  return "usage: " + program +
         " [--input FILE | --size WxH | --table] [--scene NAME] [--worst] [--cpu]\n"
         "       [--scope frame | foreground] [--regions N] [--min-area N] [--similarity N]\n"
         "       [--connectivity 4 | 8] [--shift R] [--extreme] [--threads T] [--frames N]\n"
         "       [--warm-up N] [--literal] [--backend cpu | cuda] [--device N] [--streams N]\n"
         "  --input    frames to measure on: .y4m, or what OpenCV reads (default: a scene)\n"
         "  --size     of the scene (default 640x480)\n"
         "  --table    all sizes and numbers of regions that the paper has times of\n"
         "  --scene    clip: real frames with noise, of the clip that the demo uses (looked for "
         "in\n"
         "             $REGIONGRAPH_CLIP, the cache folder and the package opencv-doc);\n"
         "             synthetic: tiles and bodies (default: the clip where there is one);\n"
         "             flat, checkerboard, noise, comb, spiral, dots, pan, 60-objects: frames made "
         "to\n"
         "             be expensive\n"
         "  --worst    these against typical frames (clip and synthetic, unless one is chosen),\n"
         "             stage by stage and in sum\n"
         "  --cpu      the processor's time instead of the wall's\n"
         "  --scope    foreground: only what bgremove leaves is segmented (default: frame)\n"
         "  --regions  in the synthetic scene, and at most in the segmentation (default 160)\n"
         "  --min-area least pixels of a region (default 0: by the frame's size)\n"
         "  --literal  bgremove, prmmotion and mrfmerge as the paper says them, regions by HSV\n"
         "  --backend  cuda: what can be done on a GPU is done there (bench only)\n"
         "  --device   which GPU (default 0)\n"
         "  --streams  so many pipelines at once, with a thread each: frames a second (bench "
         "only)\n"
         "  --shift    largest motion searched, in pixels (default 20)\n"
         "  --similarity    largest step between neighbours in a region (default 2)\n"
         "  --connectivity  of the graph (default 4)\n"
         "  --extreme  what costs most: --regions 65535 --min-area 1 --similarity 0 "
         "--connectivity 8\n"
         "             --shift 64\n"
         "  --threads  0 = all cores (default 0)\n"
         "  --frames   measured after a warm-up (default 50)\n"
         "  --warm-up  frames before those (default 60)\n";
}

int runProgram(std::span<char* const> arguments, int (*run)(const Options&)) {
  const std::string path = arguments[0], program = path.substr(path.rfind('/') + 1);
  const auto options = parseOptions(arguments.subspan(1));
  if (!options) {
    std::cerr << program << ": " << options.error().message << '\n' << usage(program);
    return 2;
  }
  if (options->asksHelp) {
    std::cout << usage(program);
    return 0;
  }
  return run(*options);
}

}  // namespace rg::bench
